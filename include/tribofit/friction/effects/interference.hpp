#pragma once

#include <cmath>
#include <numbers>

#include "tribofit/friction/effect.hpp"
#include "tribofit/friction/wave.hpp"

namespace tribofit {

/// A line of fixed frequency on the friction channel.
struct Interference {
  static constexpr std::string_view key = "interference";
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "mains hum or another line of fixed frequency rides on the friction channel",
            .equation = "reading = mu + A cos(2 pi f t + phase)",
            .source = "narrow-band pick-up",
            .experiment = "record with the disc at rest: the line stays",
            .parameters = {{.name = "A",
                            .description = "amplitude of the line",
                            .lower = 0,
                            .upper = 0.2,
                            .start = 0.003,
                            .neutral = 0,
                            .scales_with_friction = true},
                           {.name = "f",
                            .description = "frequency of the line",
                            .unit = "Hz",
                            .lower = 2,
                            .upper = 10000,
                            .start = 50,
                            .bound_scaling = BoundScaling::against_slip_time,
                            .search = ParameterSearch::steady_line,
                            .decisive = true},
                           {.name = "phase",
                            .description = "phase of the line at the first sample of the record",
                            .unit = "rad",
                            .lower = -6.3,
                            .upper = 6.3,
                            .scope = ParameterScope::record,
                            .start_grid_points = 4,
                            .periodic = true}},
            .group = EffectGroup::measurement,
            .needs_full_resolution = true,
            .sketch = {.view = SketchView::line, .values = {0.01, 50, 0}}};
  }

  template <class T>
  T add_to_reading(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::cos;
    return mu + p[0] * cos(2 * std::numbers::pi * p[1] * x.time + p[2]);
  }

  template <class T>
  void add_to_readings(const T* p, const Slip& slip, std::span<T> mu) const {
    WaveOverTime<T> wave(p[0], 2 * std::numbers::pi * p[1], p[2]);
    for (std::size_t i = 0; i < mu.size(); ++i) mu[i] = mu[i] + wave.at(slip.time[i]);
  }

  /// The level comes from a straight line through the second half of the stick, over which a line of high frequency
  /// averages out: the response of a least-squares line, at its end, to a cosine.
  template <class T>
  T filter_break_away_reading(const T* p, const Slip& slip, const T& level) const {
    using std::cos;
    using std::sin;
    const T w = 2 * std::numbers::pi * p[1];
    const T here = w * slip.break_away_time + p[2];
    const T angle = 0.5 * w * slip.stick_time;  // over the half
    if (!(scalar_part(angle) > 1e-2)) return level + p[0] * cos(here);
    // Weights (4 + 6 t/L)/L over -L < t < 0, against cos(here + w t): 4 (sine terms) + 6 (the same times t/L).
    const T before = here - angle;
    const T mean = (sin(here) - sin(before)) / angle;
    const T moment = sin(before) / angle + (cos(here) - cos(before)) / (angle * angle);
    return level + p[0] * (4.0 * mean + 6.0 * moment);
  }
};

}  // namespace tribofit
