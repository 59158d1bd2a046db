#pragma once

#include "tribofit/friction/effects/asymmetry.hpp"
#include "tribofit/friction/effects/hysteresis.hpp"

namespace tribofit {

/// Play between the contact and what drives it or reads its friction: after a reversal a part of friction is not there
/// until the play is taken up.
struct Backlash {
  static constexpr std::string_view key = "backlash";
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement =
                "there is play in the drive or in the chain of the force sensor: after each reversal a part "
                "of friction is not felt until the play is taken up",
            .equation = "mu = f(v) (1 - loss) for s < play since a reversal",
            .source = "M. Nordin, P.-O. Gutman, Automatica 38 (2002) 1633, doi:10.1016/S0005-1098(02)00047-X",
            .experiment = "turn the drive back and forth by less than the play: friction stays low throughout",
            .parameters = {{.name = "loss",
                            .description = "share of friction that is not felt within the play",
                            .lower = 0,
                            .upper = 1,
                            .start = 0.1,
                            .neutral = 0},
                           {.name = "play",
                            .description = "distance since a reversal that the play takes",
                            .unit = "mm",
                            .si = 1e-3,
                            .lower = 0.2,  // strokes of 100 mm
                            .upper = 60,
                            .start = 5,
                            .bound_scaling = BoundScaling::with_stroke,
                            .search = ParameterSearch::distance_of_change,
                            .decisive = true}},
            .needs = {.reversal_distance = true},
            .excitation = {.both_directions = true},
            .group = EffectGroup::rig,
            .sketch = {.view = SketchView::since_reversal, .values = {0.3, 20}},
            .pairs = {looks_like<Hysteresis>("plot friction over the distance since a reversal at one speed: a play "
                                             "ends at one distance, a hysteresis fades from the first millimetre on"),
                      looks_like<Asymmetry>("make the strokes ten times as long: friction by direction stays to their "
                                            "ends, a play does not")}};
  }

  /// The play is taken up over a fiftieth of it, so that it has a derivative.
  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::tanh;
    if (!std::isfinite(x.reversal_distance)) return mu;
    constexpr double kWidth = 0.02;
    const double gone = with_loops_closed({x.reversal_distance, x.earlier_strokes}).gone;
    return mu * (1.0 - 0.5 * p[0] * (1.0 - tanh((gone / p[1] - 1.0) / kWidth)));
  }
};

}  // namespace tribofit
