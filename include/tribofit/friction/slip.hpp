#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>

namespace tribofit {

/// The value of a number that may carry derivatives (a dual number with members a and v, such as a Ceres Jet).
template <class T>
double scalar_part(const T& x) {
  if constexpr (std::is_arithmetic_v<T>) {
    return x;
  } else {
    return x.a;
  }
}

/// One instant as a friction law may see it. SI.
template <class T>
struct SlidingState {
  T velocity;               ///< v_r [m/s], signed
  double direction = 1;     ///< of sliding: the sign of v_r, also at rest
  double acceleration = 0;  ///< of the block [m/s^2]
  double time = 0;          ///< from the trace's first sample [s]
  double angle = 0;         ///< of the disc [rad]
  double distance = 0;      ///< slid since the trace's first sample [m]
  /// Slid since the last reversal [m]; infinite: none is known.
  double reversal_distance = std::numeric_limits<double>::infinity();
  std::span<const double> earlier_strokes = {};                        ///< before that reversal [m], see SlidingStroke
  double stick_time = 0;                                               ///< of the stick before this slip [s]
  double load = 0;                                                     ///< normal force [N]
  double mean_load = 1;                                                ///< N0 [N]
  double temperature = 0;                                              ///< [degC]
  double mean_temperature = 0;                                         ///< T0 [degC]
  double since_break_away = std::numeric_limits<double>::quiet_NaN();  ///< [s]; NaN: no break-away was recorded
  double disc_speed = 0;                                               ///< omega [rad/s]
};

/// What is known of a slip and of the stick before it beside its samples. SI; friction signed.
struct SlipFacts {
  std::size_t record = 0;      ///< which of several records, where a model has phases of each
  bool from_stick = false;     ///< it begins with a break-away; otherwise the record (or a reversal) begins it
  double break_away_time = 0;  ///< [s], where from_stick
  double stick_time = 0;       ///< of the stick before [s]; NaN when its beginning was not recorded
  double stick_slope = 0;      ///< d mu/dt imposed by the spring before break-away [1/s]
  double direction = 1;        ///< sign of v_r
  double disc_speed = 0;       ///< omega [rad/s]; 0 where it is not known
  double lead_friction = 0;    ///< friction at the first of the lead samples, see Slip
  double tail_friction = std::numeric_limits<double>::quiet_NaN();  ///< friction read in the stick right after the
                                                                    ///< slip; NaN where there is none
  double restick_time = std::numeric_limits<double>::quiet_NaN();   ///< [s]; NaN where there is none
  double friction_low_pass = 0;     ///< time constant of a first-order low-pass that friction was read through [s]
  double earlier_restick_time = 0;  ///< when the slip before this one's stick came to rest [s]
};

/// Samples [begin, end) of a channel; nothing of a channel that is empty.
inline std::span<const double> part_of(std::span<const double> channel, std::size_t begin, std::size_t end) {
  return channel.empty() ? channel : channel.subspan(begin, end - begin);
}

/// Consecutive samples of one slip, structure of arrays, SI. Channels a trace does not have are empty.
struct Slip : SlipFacts {
  std::span<const double> time, velocity, acceleration, angle, distance, reversal_distance, load, temperature;
  std::span<const double>
      velocity_variance;  ///< of v_r within each value, where values are means [m^2/s^2]; else empty
  std::span<const double> lead_time,
      lead_velocity;  ///< of the stick just before break-away, for effects that act there
  std::span<const double> earlier_time, earlier_velocity;  ///< of the slip before that stick; empty where not recorded
  double mean_load = 1;                                    ///< N0 [N]
  double mean_temperature = 0;                             ///< T0 [degC]

  std::span<const double> earlier_strokes;  ///< as in SlidingState

  std::size_t size() const { return time.size(); }

  /// Speed |v_r| of a sample. Sensor noise near rest can turn the reading round although the slip has one direction;
  /// such a sample is at rest.
  template <class T>
  [[gnu::always_inline]] T speed(const T& v) const {
    const T forward = direction * v;
    return scalar_part(forward) > 0 ? forward : T(0.0 * forward);
  }

  /// Inlined everywhere: what a caller does not look at is then not read.
  template <class T>
  [[gnu::always_inline]] SlidingState<T> at(std::size_t i, const T& v) const {
    const auto value = [i](std::span<const double> channel, double otherwise) {
      return channel.empty() ? otherwise : channel[i];
    };
    return {T(direction * speed(v)),
            direction,
            value(acceleration, 0),
            time[i],
            value(angle, 0),
            value(distance, 0),
            value(reversal_distance, std::numeric_limits<double>::infinity()),
            earlier_strokes,
            std::isnan(stick_time) ? 0 : stick_time,
            value(load, mean_load),
            mean_load,
            value(temperature, mean_temperature),
            mean_temperature,
            from_stick ? time[i] - break_away_time : std::numeric_limits<double>::quiet_NaN(),
            disc_speed};
  }
};

}  // namespace tribofit
