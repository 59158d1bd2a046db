#pragma once

#include <cmath>

#include "tribofit/friction/effect.hpp"
#include "tribofit/friction/turn_along_slip.hpp"
#include "tribofit/friction/wave.hpp"

namespace tribofit {

/// Friction varies around the disc: two and three waves a revolution.
struct DiscPattern {
  static constexpr std::string_view key = "disc-pattern";
  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement = "friction differs around the disc (spots, transfer film), with more than one wave a revolution",
        .equation = "mu = f(v) (1 + A_2 cos(2 theta + phase_2) + A_3 cos(3 theta + phase_3))",
        .source = "Fourier terms of any pattern fixed to the disc; needs at least two revolutions",
        .experiment = "turn the disc by a quarter on its hub: the pattern turns with it",
        .parameters = {{.name = "A_2",
                        .description = "relative amplitude of two waves a revolution",
                        .lower = 0,
                        .upper = 0.3,
                        .start = 0.01,
                        .neutral = 0},
                       {.name = "phase_2",
                        .description = "their phase at the first sample of the record",
                        .unit = "rad",
                        .lower = -6.3,
                        .upper = 6.3,
                        .scope = ParameterScope::record,
                        .start_grid_points = 4,
                        .periodic = true},
                       {.name = "A_3",
                        .description = "relative amplitude of three waves a revolution",
                        .lower = 0,
                        .upper = 0.3,
                        .start = 0.005,
                        .neutral = 0},
                       {.name = "phase_3",
                        .description = "their phase at the first sample of the record",
                        .unit = "rad",
                        .lower = -6.3,
                        .upper = 6.3,
                        .scope = ParameterScope::record,
                        .start_grid_points = 4,
                        .periodic = true}},
        .needs = {.angle = true},
        .excitation = {.revolutions = 2},
        .group = EffectGroup::rig,
        .sketch = {.view = SketchView::angle, .values = {0.06, 0, 0.02, 0}}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::cos;
    return mu * (1.0 + p[0] * cos(2 * x.angle + p[1]) + p[2] * cos(3 * x.angle + p[3]));
  }
  template <class T>
  void modulate_all(const T* p, const Slip& slip, std::span<const T> /*velocity*/, std::span<T> mu) const {
    const Wave<T> two(p[0], p[1]), three(p[2], p[3]);
    TurnAlongSlip turn(slip);
    for (std::size_t i = 0; i < mu.size(); ++i) {
      const Rotation once = turn.at(i), twice = once * once;
      mu[i] = mu[i] * (1.0 + (two.at(twice) + three.at(twice * once)));
    }
  }
};

}  // namespace tribofit
