#pragma once

#include "tribofit/friction/effects/asymmetry.hpp"
#include "tribofit/friction/effects/bristle.hpp"
#include "tribofit/friction/effects/frictional_lag.hpp"
#include "tribofit/friction/effects/rate_state.hpp"
#include "tribofit/segmentation/stroke_memory.hpp"

namespace tribofit {

/// A part of friction turns round over a distance, not at once: contacts in parallel of which each is a spring that
/// slides from some pull on (Maxwell slip elements).
///
/// With the distances at which they let go after a reversal spread as x exp(-x/d_h), the friction of them all is, after
/// strokes that were long beside d_h, mu_h (1 - 2 exp(-s/d_h)) at the distance s since the reversal: it begins where it
/// was before. After shorter strokes the same curve begins at the friction reached there (Masing's rule), and a loop
/// that is closed is forgotten. What is left of f(v) turns at once.
struct Hysteresis {
  static constexpr std::string_view key = "hysteresis";
  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement =
            "after a reversal a part of friction turns round over a distance, as soft contacts are bent the "
            "other way before they slide",
        .equation = "mu = f(v) - mu_h + g, dg/ds = (mu_h - g)/d_h after long strokes, g from -mu_h at s = 0",
        .source =
            "F. Al-Bender, V. Lampaert, J. Swevers, IEEE Trans. Autom. Control 50 (2005) 1883, "
            "doi:10.1109/TAC.2005.858676; W. D. Iwan, J. Appl. Mech. 33 (1966) 893, doi:10.1115/1.3625199",
        .experiment =
            "strokes of several lengths at two speeds: friction follows the distance since the reversal, not "
            "the time",
        .parameters = {{.name = "mu_h",
                        .description = "friction of the contacts that turn round over a distance",
                        .lower = 0,
                        .upper = 1,
                        .start = 0.05,
                        .neutral = 0,
                        .scales_with_friction = true},
                       {.name = "d_h",
                        .description = "distance since a reversal over which they turn round",
                        .unit = "mm",
                        .si = 1e-3,
                        .lower = 0.2,  // strokes of 100 mm
                        .upper = 100,
                        .start = 5,
                        .bound_scaling = BoundScaling::with_stroke,
                        .start_grid_points = 5,
                        .decisive = true}},
        .needs = {.reversal_distance = true},
        .excitation = {.both_directions = true},
        .sketch = {.view = SketchView::since_reversal, .values = {0.1, 15}},
        .pairs = {looks_like<FrictionalLag>(
                      "run the same stroke at two speeds: a hysteresis stays constant in mm, a lag in ms"),
                  looks_like<RateState>("step the speed without a reversal: contacts that are renewed answer to it, a "
                                        "hysteresis does not"),
                  looks_like<Bristle>("compare friction just before a reversal and just after it: with bristles all of "
                                      "it turns over a distance, with a hysteresis a part"),
                  looks_like<Asymmetry>("make the strokes ten times as long: friction by direction stays to their "
                                        "ends, a hysteresis does not")}};
  }

  /// Friction of the soft contacts over mu_h, along the direction of sliding: -1 to 1.
  template <class T>
  static T soft_contacts(const T& d_h, const SlidingStroke& given) {
    using std::exp;
    const SlidingStroke stroke = with_loops_closed(given);
    const auto turned = [&](double distance) { return T(2.0 * (1.0 - exp(-distance / d_h))); };
    if (stroke.earlier.empty()) return turned(stroke.gone) - 1.0;
    const bool beyond_all = stroke.earlier.size() == 1 && stroke.gone > stroke.earlier[0];
    if (beyond_all) return 0.5 * turned(2 * stroke.gone - stroke.earlier[0]);
    T at_turn = 0.5 * turned(stroke.earlier[0]);
    for (const double length : stroke.earlier.subspan(1)) at_turn = turned(length) - at_turn;
    return turned(stroke.gone) - at_turn;
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    if (!std::isfinite(x.reversal_distance)) return mu;
    return mu + x.direction * p[0] * (soft_contacts(p[1], {x.reversal_distance, x.earlier_strokes}) - 1.0);
  }
};

}  // namespace tribofit
