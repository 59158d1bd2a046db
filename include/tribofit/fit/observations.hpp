#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tribofit/friction/effect.hpp"
#include "tribofit/friction/slip.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// The samples over which an error is taken: those of every slip, and one break-away per cycle.
///
/// This is the definition for the whole house: rigid-stick laws are judged over the slip samples plus one break-away
/// residual per cycle (in rigid stick mu is set by the spring, not by the law). The unit of evidence is the cycle, or a
/// stretch of equal length where nothing sticks.
///
/// Samples may be means over `samples_per_value` neighbours. Each carries the variance of v_r within it, so that the
/// bare laws are averaged over it as the samples are (stribeck_shape_mean): at 80 values a slip their parameters move
/// by less than 1e-5.
struct Observations {
  struct Range {
    std::size_t begin = 0, end = 0;  ///< values of this slip
    Span samples;                    ///< the same in samples of the Motion
    std::size_t cycle = 0;           ///< unit of evidence it belongs to, from 0, in order of time
    std::size_t segment = 0;         ///< index in Segmentation::cycles
    std::size_t record = 0;          ///< which of several records
    bool from_stick = false;
    double break_away_time = 0;  ///< [s]
    double stick_time = 0;       ///< [s]; the median where its beginning was not recorded, NaN where none was
    double stick_slope = 0;      ///< d mu/dt in the stick before [1/s]
    double direction = 1;
    double disc_speed = 0;                     ///< omega [rad/s]; 0 where it is not known
    double break_away_friction = 0;            ///< |mu| at break-away; NaN when there is none
    std::size_t lead_begin = 0, lead_end = 0;  ///< of the lead channels below
    double lead_friction = 0;                  ///< signed, at the first of them
    double tail_friction = 0;                  ///< signed, in the stick right after the slip; NaN where there is none
    double restick_time = 0;                   ///< [s]; NaN where there is none
  };

  std::vector<double> time, velocity, friction;  ///< [s], [m/s], [1 or N]
  std::vector<double> velocity_variance;         ///< of v_r within each value [m^2/s^2]; empty when values are samples
  std::vector<double> weight, root_weight;       ///< samples behind each value, and its square root
  std::vector<double> acceleration, angle, distance, load, temperature;  ///< empty when not needed or absent
  std::vector<double> lead_time, lead_velocity;  ///< the last samples of each stick; empty when not needed
  std::vector<Range> slips;
  std::size_t cycles = 0;  ///< units of evidence
  std::size_t samples_per_value = 1;
  double mean_load = 1;         ///< N0 [N]
  double mean_temperature = 0;  ///< T0 [degC]
  double fastest = 0;           ///< largest |v_r| [m/s]
  double slowest = 0;           ///< least |v_r| [m/s]; 0 where a slip begins in stick
  double largest_friction = 0;  ///< largest |mu|, the scale for bounds where friction is a force

  std::size_t size() const { return time.size(); }
  /// A slip as the friction room sees it.
  Slip slip(const Range& range) const;
};

/// Builds the observations of a trace with the channels `needs` names.
/// values_per_slip: means are taken so that the median slip has about this many; 0 keeps every sample.
Observations observe(const Motion& motion, const Segmentation& segmentation, const Channels& needs = {},
                     std::size_t values_per_slip = 80);

/// The observations of several records as one; channels that not all of them have are dropped, and N0 and T0 are the
/// means of all.
Observations join(std::vector<Observations> records);

/// Block of every cycle when each record is cut into `count` contiguous blocks of about equally many cycles; block k of
/// one record belongs together with block k of the others.
std::vector<std::size_t> blocks_of(const Observations& observations, std::size_t count);

/// Block acceleration [m/s^2] at the samples of a slip: Savitzky-Golay slope (quadratic, over 1 ms, 5 to 21
/// samples) whose window stops at re-stick, where the acceleration jumps.
std::vector<double> slip_acceleration(const Motion& motion, const Span& samples);

}  // namespace tribofit
