#pragma once

#include <functional>
#include <vector>

namespace tribofit {

/// How the disc turns: speed, its rate and its integral as functions of time [s], consistent with one another.
/// Negative times are the settling before the record. Any three consistent functions will do; the makers below cover
/// the usual drives.
struct SpeedProfile {
  std::function<double(double)> speed;         ///< omega [rad/s]
  std::function<double(double)> acceleration;  ///< d omega/dt [rad/s^2]
  std::function<double(double)> angle;         ///< integral of omega from t = 0 [rad]
  bool constant = false;
};

/// omega at all times.
SpeedProfile constant_speed(double omega);

/// omega = amplitude sin(2 pi frequency t): the disc goes forth and back [rad/s, Hz].
SpeedProfile reversing_speed(double amplitude, double frequency);

/// Straight lines between (times[i], speeds[i]); the first and last speed hold outside. Throws InputError unless
/// times [s] increase and there is one speed [rad/s] for each.
SpeedProfile piecewise_linear_speed(std::vector<double> times, std::vector<double> speeds);

/// From standstill to omega [rad/s] in `duration` [s], then constant.
SpeedProfile run_up_speed(double omega, double duration);

/// `base` with a swing of the speed over the angle theta of the disc: omega (1 + A cos(n theta + phase)), theta = 0 at
/// t = 0. Throws InputError unless 0 <= amplitude < 1 and order > 0.
SpeedProfile rippled_speed(SpeedProfile base, double amplitude, double order, double phase);

/// A time in which the disc stands still.
struct Pause {
  double begin = 0, duration = 0;  ///< [s]

  bool operator==(const Pause&) const = default;
};

/// Constant speeds [rad/s] from the times given [s] on (the first holds before, too), and standstill in the pauses; the
/// speed changes along lines of kSpeedChangeTime. Throws InputError where changes follow one another faster than that.
SpeedProfile stepped_speed(std::vector<double> times, std::vector<double> speeds,
                           const std::vector<Pause>& pauses = {});
inline constexpr double kSpeedChangeTime = 0.05;  ///< [s]

/// What is imposed on the block.
struct Drive {
  SpeedProfile speed;
  double radius = 0;                               ///< friction radius r [m], > 0; v_disc = omega r
  double mean_load = 0;                            ///< N0 [N], > 0
  std::function<double(double)> load = {};         ///< N(t) [N]; empty: N0 throughout
  std::function<double(double)> temperature = {};  ///< T(t) [degC]; empty: mean_temperature throughout
  double mean_temperature = 20;                    ///< T0 [degC]
};

}  // namespace tribofit
