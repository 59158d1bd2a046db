#pragma once

#include "tribofit/friction/effects/drift.hpp"
#include "tribofit/friction/turn_along_slip.hpp"
#include "tribofit/friction/wave.hpp"

namespace tribofit {

/// The disc presses harder once a revolution: mu (1 + A cos(theta + phase)).
struct Runout {
  static constexpr std::string_view key = "runout";
  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement = "the disc runs out of true, so the load and with it the reading swings once a revolution",
        .equation = "mu = f(v) (1 + A cos(theta + phase))",
        .source = "textbook; needs at least two revolutions",
        .experiment = "laser on the unloaded disc; at least three revolutions",
        .parameters = {{.name = "A",
                        .description = "amplitude of the swing of the load, relative to its mean",
                        .lower = 0,
                        .upper = 0.5,
                        .start = 0.01,
                        .neutral = 0},
                       {.name = "phase",
                        .description = "phase of the swing at the first sample of the record",
                        .unit = "rad",
                        .lower = -6.3,
                        .upper = 6.3,
                        .scope = ParameterScope::record,
                        .start_grid_points = 4,
                        .periodic = true}},
        .needs = {.angle = true},
        .excitation = {.revolutions = 2},
        .group = EffectGroup::rig,
        .sketch = {.view = SketchView::angle, .values = {0.08, 0}},
        .pairs = {looks_like<Drift>("record four revolutions (60 s at 4 rpm): a runout comes back, a drift goes on")}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::cos;
    return mu * (1.0 + p[0] * cos(x.angle + p[1]));
  }
  template <class T>
  void modulate_all(const T* p, const Slip& slip, std::span<const T> /*velocity*/, std::span<T> mu) const {
    const Wave<T> wave(p[0], p[1]);
    TurnAlongSlip turn(slip);
    for (std::size_t i = 0; i < mu.size(); ++i) mu[i] = mu[i] * (1.0 + wave.at(turn.at(i)));
  }
};

}  // namespace tribofit
