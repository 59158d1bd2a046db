#pragma once

#include <cmath>
#include <numbers>

#include "tribofit/friction/effect.hpp"
#include "tribofit/friction/wave.hpp"

namespace tribofit {

/// A second mode of the rig rings down after each break-away.
struct Ringing {
  static constexpr std::string_view key = "ringing";
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "a second mode of the rig is struck by each break-away and rings down",
            .equation = "reading = mu + A exp(-zeta w s) cos(w s + phase), w = 2 pi f, s = time since break-away",
            .source = "free vibration of a damped mode, textbook",
            .experiment = "tap the rig: the mode answers at the same frequency without sliding",
            .parameters = {{.name = "A",
                            .description = "amplitude right after break-away",
                            .lower = 0,
                            .upper = 0.2,
                            .start = 0.003,
                            .neutral = 0,
                            .scales_with_friction = true},
                           {.name = "f",
                            .description = "frequency of the mode",
                            .unit = "Hz",
                            .lower = 30,
                            .upper = 2000,
                            .start = 200,
                            .bound_scaling = BoundScaling::against_slip_time,
                            .search = ParameterSearch::ringing_line,
                            .decisive = true},
                           {.name = "zeta",
                            .description = "damping ratio of the mode",
                            .lower = 0.002,
                            .upper = 0.1,
                            .start = 0.02,
                            .start_grid_points = 3},
                           {.name = "phase",
                            .description = "phase of the mode at break-away",
                            .unit = "rad",
                            .lower = -6.3,
                            .upper = 6.3,
                            .start_grid_points = 4,
                            .periodic = true}},
            .excitation = {.break_away = "to strike it"},
            .group = EffectGroup::rig,
            .needs_full_resolution = true,
            .sketch = {.view = SketchView::since_break_away, .values = {0.02, 200, 0.05, 0}}};
  }

  template <class T>
  T add_to_reading(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::cos;
    using std::exp;
    if (!(x.since_break_away >= 0)) return mu;
    const T w = 2 * std::numbers::pi * p[1];
    return mu + x.direction * p[0] * exp(-p[2] * w * x.since_break_away) * cos(w * x.since_break_away + p[3]);
  }
  template <class T>
  void add_to_readings(const T* p, const Slip& slip, std::span<T> mu) const {
    if (!slip.from_stick) return;
    const T w = 2 * std::numbers::pi * p[1];
    WaveOverTime<T> wave(slip.direction * p[0], p[2] * w, w, p[3]);
    for (std::size_t i = 0; i < mu.size(); ++i) {
      const double since = slip.time[i] - slip.break_away_time;
      if (since >= 0) mu[i] = mu[i] + wave.at(since);
    }
  }
};

}  // namespace tribofit
