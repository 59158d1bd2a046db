#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/oscillator/machine.hpp"
#include "tribofit/oscillator/simulate.hpp"

namespace tribofit {

/// What a machine ends in when it is left alone.
enum class Regime {
  stick_slip,   ///< sticks and slips, each cycle like the one before
  vibration,    ///< swings without ever sticking, each swing like the one before
  sliding,      ///< steady sliding: vibration dies out
  not_settled,  ///< none of these within the time given
};
inline constexpr std::array kRegimes = {Regime::stick_slip, Regime::vibration, Regime::sliding, Regime::not_settled};
/// "stick-slip", "vibration", "sliding", "not-settled": as tables, CSV and JSON have them.
std::string_view to_string(Regime regime);

/// Settled motion and its measures, those of [C] among them. A measure that the regime does not have is NaN.
struct Settled {
  Regime regime = Regime::not_settled;
  bool sticks = false;                                             ///< the last cycles seen have a stick
  double frequency = std::numeric_limits<double>::quiet_NaN();     ///< response frequency, of the last cycles [Hz]
  double stick_time = std::numeric_limits<double>::quiet_NaN();    ///< "stick period" of [C] [s]; 0 in a vibration
  double peak_to_peak = std::numeric_limits<double>::quiet_NaN();  ///< of the displacement [m]; 0 in sliding
  double energy = std::numeric_limits<double>::quiet_NaN();        ///< before break-away, k (x2 - x1)^2/2 [C] [J]
  double peak_speed = std::numeric_limits<double>::quiet_NaN();    ///< largest |v_r| [m/s]
  double begin = 0;      ///< time at which the last whole cycle begins: a break-away or a largest displacement [s]
  double simulated = 0;  ///< simulated time [s]
  std::string seen;      ///< where not settled: what was seen, in a sentence

  bool repeats() const { return regime == Regime::stick_slip || regime == Regime::vibration; }
};

/// Where a simulation begins.
enum class StartFrom {
  stick,    ///< unloaded and carried by the disc: winds up, breaks away
  sliding,  ///< steady sliding, with a velocity a thousandth of the disc's beside it
  rest,     ///< unloaded and at rest, x = x' = 0, as [U] and [C] begin
};

struct SettleOptions {
  StartFrom start = StartFrom::stick;
  double tolerance = 1e-6;      ///< of period and peak-to-peak from cycle to cycle, relative
  double longest_cycles = 200;  ///< given up after so many stick-slip cycles
  double longest_swings = 500;  ///< and so many natural periods without a stick
  double sharpness = 0;         ///< s of the smoothed law [s/m], see smoothed.hpp; 0: the event-located law
};

/// The motion of a machine, by its own law or by the smoothed one of that sharpness [s/m] (0: its own). options.start:
/// where it begins, else unloaded and carried by the disc. Throws as simulate() and smoothed_law() do.
SimulatedMotion motion_of(const Machine& machine, const SimulationOptions& options, double sharpness = 0);

/// Simulates a machine until its motion repeats itself, and measures that.
///
/// Stick-slip is settled when period and peak-to-peak of three cycles agree (a law without memory is so from the first
/// re-stick on). Without stick, motion is settled when swings stay alike, and dies out when they shrink below a
/// twentieth of the first while steady sliding is stable: the flow of a law without memory is planar, so swings that
/// shrink once shrink always, and only a vibration smaller than that could still be hidden. What hardly swings at all
/// (strongly damped, or friction that rises with speed) slides after five times the slowest decay of a deviation.
/// Machines whose friction goes with time, angle or distance need not settle: `seen` then says what the last cycles
/// were, and the measures are their means.
/// A motion that cannot be integrated is not settled either, and `seen` is why. Throws InputError for machines that
/// cannot be. Cost: below 1 ms where it settles at once.
Settled settle(const Machine& machine, const SettleOptions& options = {});

/// Where the block begins; nothing: unloaded and carried by the disc.
std::optional<BlockStart> start_of(const Machine& machine, StartFrom start);

/// Whether a machine that begins in stick goes on sticking. A slip of two and a half natural periods in which the block
/// swings less and less, or creeps to steady sliding, does not end: where a law without memory does not return to
/// the speed of the disc in its first swing, it never does. With effects the cycles must not shrink any more, else they
/// are the end of a start at the speed of the disc. Cost: a few of its cycles.
bool keeps_sticking(const Machine& machine, double sharpness = 0);

/// Swings of the displacement [m] from turning point to turning point, over `periods` natural periods, of a block that
/// passes its place in steady sliding at `velocity` [m/s]; up to the first stick, where there is one.
struct Swings {
  std::vector<double> sizes;
  bool sticks = false;
};
Swings swings_from(const Machine& machine, double velocity, double periods);

/// The machine as its settled motion begins anew: simulates `cycles` periods (of natural ones where nothing repeats)
/// after settling, with `samples` in each.
SimulatedMotion settled_motion(const Machine& machine, const Settled& settled, std::size_t cycles, std::size_t samples,
                               const SettleOptions& options = {});

}  // namespace tribofit
