#pragma once

#include <array>
#include <string>
#include <vector>

#include "tribofit/friction/laws/all.hpp"
#include "tribofit/oscillator/machine.hpp"
#include "tribofit/study/map.hpp"
#include "tribofit/study/response.hpp"
#include "tribofit/study/settled.hpp"

// What of the studies of [U], [C] and [D] can be computed anew: the numbers that stand in data/validation, printed by
// scripts/reproduce-studies and asserted by published_studies_test.cpp. SI throughout.

namespace tribofit::studies {

// ---- [U]

/// s of [U] Fig 2, 500 s/mm [s/m].
inline constexpr double kPrintedSharpness = 5e5;

/// The decay factor [s/m] with which [U]'s machine vibrates with `frequency` [Hz] at 0.5 mm/s, by the event-located law
/// (sharpness 0) or the smoothed one.
double decay_for_frequency(double frequency, double sharpness);

/// Decay factors [s/m] between 0.01 and 10 s/mm with which [U]'s machine has a critical speed of `velocity` [m/s]:
/// steady sliding loses its stability there, or stick vanishes there on the way up.
std::vector<double> decays_losing_stability_at(double velocity);
std::vector<double> decays_losing_stick_at(double velocity);

/// Begun at rest: how it begins and what it becomes.
struct FromRest {
  double velocity = 0;              ///< [m/s]
  double growth_rate = 0;           ///< of small vibrations [1/s]
  double first_stick = 0;           ///< [s]; NaN: never
  double first_swing = 0;           ///< of the displacement, from turning point to turning point [m]
  double swing_after_a_minute = 0;  ///< [m]
  Settled settled;
};
FromRest from_rest(const Machine& machine, const SettleOptions& options = {});

/// What the two readings of the arctangent make of [U] Fig 2.
struct Readings {
  double decay = 0;                                    ///< [s/m]
  double smooth_frequency = 0, printed_frequency = 0;  ///< [Hz]
  double smooth_swing = 0, printed_swing = 0;          ///< peak-to-peak [m]
  double jump = 0;             ///< of the printed law at rest, with the sign on mu_c that friction needs [1]
  double printed_at_rest = 0;  ///< [1]
};
Readings readings_of_the_arctangent(double decay);

/// Lines of the displacement in a long record of settled motion: amplitudes at the multiples of the fundamental, and
/// the largest amplitude anywhere between them [m].
struct Lines {
  double fundamental = 0;  ///< [Hz]
  std::vector<double> amplitude = {};
  double between = 0;
};
Lines lines_of(const Machine& machine, const SettleOptions& options = {});

// ---- [C]

/// A machine for [C], which prints no values but speeds: that of [U] with c_v and sigma.
Machine creak_machine(double decay, double viscous);

/// c_v and sigma [s/m] with which a machine of [U]'s other values has both figures that [C] prints: 0.28 Hz (taken to
/// be at 0.5 mm/s) and a critical speed of 2.5 mm/s (taken to be the loss of stability).
struct CreakLaw {
  double decay = 0, viscous = 0;
};
CreakLaw law_with_both_figures_of_creak();
/// Up to which speed of the disc a machine begun at rest, as [C]'s are, comes to stick [m/s].
double last_stick_from_rest(const Machine& machine);

/// A measure over a sweep of one variable at 0.5 mm/s.
struct Swept {
  std::string variable;
  std::vector<double> values = {};  ///< [SI]
  std::vector<Settled> settled = {};
  std::vector<double> rise = {};  ///< from valley to peak of the displacement, which [C] calls the stick period too [s]
  std::vector<double> frequency_ratio = {};  ///< response over natural frequency
};
/// Those of [C]: stiffness and mass over a factor of two either way, mu_k/mu_s from 0.1 to 0.9, the decay factor over a
/// factor of two either way, the speed up to 2.4 mm/s.
std::vector<Swept> sweeps_of_creak(const Machine& machine);

enum class Trend { rises, falls, mixed };
/// Of the values that are numbers and not zero (where nothing vibrates).
Trend trend_of(const std::vector<double>& values);
/// Largest over smallest of those.
double span_of(const std::vector<double>& values);

/// One of [C]'s claims, and what the sweep says of it.
struct Claim {
  std::string statement;
  bool confirmed = false;
  std::string numbers;
};
std::vector<Claim> claims_of_creak(const Machine& machine);

/// The three maps of [C], each holding its three measures: stiffness x mass, speed x mu_k/mu_s, speed x decay factor.
struct Map {
  MapRequest request;
  std::vector<std::vector<MapCell>> rows;
};
std::vector<Map> maps_of_creak(const Machine& machine, std::size_t count);

// ---- [D]

struct PublishedRadius {
  double radius, frequency, amplitude, line;  ///< [m, Hz, m/s of v_r, no unit given]
  int events;                                 ///< in one second
};
inline constexpr std::array<PublishedRadius, 4> kPublishedRadii = {{{0.009, 3.662, 0.0565, 1.284, 3},
                                                                    {0.012, 4.272, 0.0662, 1.526, 4},
                                                                    {0.015, 4.883, 0.0839, 2.640, 5},
                                                                    {0.018, 5.493, 0.0727, 2.432, 6}}};
/// Width of the bins of [D]'s transform, 20 kHz over 32768 [Hz].
inline constexpr double kBinOfRadii = 20000.0 / 32768;

/// A rig calibrated to a frequency and the published amplitude of v_r, and what was not calibrated.
struct CalibratedRadius {
  Machine machine;
  Settled settled;
  double line = 0;                         ///< amplitude of the fundamental of v_r [m/s]
  double bin = 0;                          ///< amplitude in the published bin of [D]'s transform [m/s]
  double rms_block = 0, rms_relative = 0;  ///< of v_b and v_r [m/s]
  int least_events = 0, most_events = 0;   ///< break-aways in any one second
};
CalibratedRadius calibrated_radius(const PublishedRadius& published, Law law, double frequency);

/// Frequencies within each published bin with which the published ratios of the lines come out (the 15 mm test in the
/// middle of its bin); NaN where none does [Hz].
std::array<double, 4> frequencies_with_published_ratios(Law law);

}  // namespace tribofit::studies
