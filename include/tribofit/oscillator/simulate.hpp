#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "tribofit/friction/model.hpp"
#include "tribofit/oscillator/drive.hpp"
#include "tribofit/oscillator/rig.hpp"

namespace tribofit {

/// How break-away differs from cycle to cycle: mu_s of each cycle is mu_s + offset, offset ~ N(0, deviation^2), with
/// offset[i+1] = wander offset[i] + sqrt(1 - wander^2) deviation xi (independent for wander = 0).
struct BreakAwayScatter {
  double deviation = 0;  ///< [1], >= 0
  double wander = 0;     ///< correlation of neighbouring cycles [1], 0 <= wander < 1
};

/// A state of the block.
struct BlockStart {
  double displacement = 0, velocity = 0;  ///< [m, m/s]
};

/// Channels of a simulated motion that can be left out, for the memory they take; load, temperature and the distance
/// since a reversal are there only where something varies or needs them.
struct SimulatedChannels {
  bool displacement = true, acceleration = true;  ///< of the block
  bool disc = true;                               ///< its speed and angle
  bool distance = true;                           ///< slid
  bool relative_velocity = true;
};

struct SimulationOptions {
  double duration = 1;  ///< of the record [s], > 0
  double rate = 20000;  ///< samples per second [Hz]; 0: no samples, events only
  double settle = 0;    ///< simulated and thrown away before the record [s], see settling_time()
  BreakAwayScatter scatter = {};
  std::uint64_t seed = 1;    ///< of the scatter
  double tolerance = 1e-10;  ///< local error of the integrator, relative
  double max_step = 0;       ///< longest step [s]; 0: an eighth of the natural period
  /// Where the block begins; nothing: unloaded (x = 0) and carried by the disc. At another speed than the disc's it
  /// begins in slip, with the memories of the law as in steady sliding at its v_r.
  std::optional<BlockStart> start = {};
  SimulatedChannels channels = {};  ///< that simulate() keeps
};

/// One slip of a simulated motion, with the stick before it.
struct SimulatedSlip {
  double break_away_time = 0;      ///< [s]; negative where it began in the settling, NaN where the motion began in slip
  double restick_time = 0;         ///< v_r back to zero (stick or reversal) [s]; NaN: not within the record
  double stick_time = 0;           ///< [s]; 0 where motion only reversed
  int direction = 1;               ///< sign of v_r
  double mu_s_offset = 0;          ///< added to mu_s in this cycle (the scatter) [1]
  double break_away_friction = 0;  ///< |mu| at break-away [1]
  double peak_speed = 0;           ///< largest |v_r| [m/s]; so far, where the slip does not end within the record
  std::vector<double> earlier_strokes = {};  ///< as in SlidingState, where an effect needs them [m]
};

/// Where the block turns round, x' = 0.
struct TurningPoint {
  double time = 0, displacement = 0;  ///< [s, m]
  bool is_maximum = false;
};

/// A simulated motion on a uniform grid, SI, before any sensor. All channels have the same length, but for those that
/// were left out (SimulatedChannels), which are empty.
struct SimulatedMotion {
  double rate = 0;  ///< [Hz]
  bool settled = false;
  std::vector<double> time, displacement, velocity, acceleration;  ///< of the block [s, m, m/s, m/s^2]
  std::vector<double> relative_velocity;                           ///< v_r [m/s]; exactly 0 in rigid stick
  std::vector<double> friction;  ///< signed mu at the interface [1]; in rigid stick what the spring asks for
  std::vector<double> disc_speed, disc_angle;                      ///< [rad/s, rad]
  std::vector<double> distance;                                    ///< slid since the first sample [m]
  std::vector<double> reversal_distance;                           ///< since the last reversal, infinite before the
                                                                   ///< first [m]; empty where no effect needs it
  std::vector<double> load, temperature;                           ///< [N, degC]; empty where constant
  std::vector<std::uint8_t> sticks;                                ///< 1 in stick
  std::vector<SimulatedSlip> slips;                                ///< in order of time
  std::vector<TurningPoint> turning_points;                        ///< within the record, in order of time
  double radius = 0, mean_load = 0, mean_temperature = 0;          ///< as the drive states them
  double stated_speed = std::numeric_limits<double>::quiet_NaN();  ///< omega as the drive states it, where that is
                                                                   ///< constant [rad/s]; else NaN

  std::size_t size() const { return time.size(); }
  /// Break-aways within the record.
  std::size_t break_away_count() const;
};

/// Simulates 1-DOF stick-slip: m x'' + c x' + k x = N mu(v_r, ...), v_r = omega r - x' ([U] Eq 1, [C]).
///
/// The block starts unloaded (x = 0) and carried by the disc. In rigid stick x' = v_disc, in closed form, until
/// |k x + c v_disc + m v_disc'| exceeds N mu_s; then it slips by the law until v_r = 0, where it sticks if the spring
/// is within the static limit and reverses otherwise. Slips are integrated by Dormand-Prince 5(4) with dense output;
/// the last step of a slip ends at v_r = 0, so event times converge with the fifth order. Models that act in stick
/// (bristle) have no rigid stick: their direction reverses at v_r = 0, and a slip counts as one when it covers
/// a tenth of the static deflection N mu_s/k between two reversals; without a memory (contact-spin) it begins and ends
/// where |v_r| crosses half the speed of the disc.
///
/// Effects of the motion that the model holds are imposed on the drive (see simulate_recording.hpp): the block then
/// feels a disc that is not the one stated.
///
/// Validity: one degree of freedom, no loss of contact; the load does not depend on the motion.
/// p: parameters in SI in the order of model.parameters().
/// Throws InputError for a rig, drive or option that cannot be, and where friction is not finite.
/// Cost: about 40 us a stick-slip cycle and 0.1 us a sample.
SimulatedMotion simulate(const Rig& rig, const Drive& drive, const FrictionModel& model, std::span<const double> p,
                         const SimulationOptions& options = {});

/// Time after which a stick-slip motion started by simulate() repeats itself [s]: five times the winding-up of the
/// spring to mu_s and back, and ten natural periods. For a drive that is constant at t < 0.
double settling_time(const Rig& rig, const Drive& drive, std::span<const double> p);

}  // namespace tribofit
