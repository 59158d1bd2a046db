#pragma once

#include "tribofit/friction/effects/contact_spin.hpp"
#include "tribofit/friction/effects/motion_effects.hpp"

namespace tribofit {

/// The LuGre model: contacts bend like bristles before and while they slide.
///
/// With F = sigma0 z the model reads dF/dt = (sigma0 |v|/f)(f sign(v) - F): friction relaxes towards its steady value
/// over the distance f/sigma0, and moves elastically while F is small. It acts in stick too: the block creeps there.
struct Bristle {
  static constexpr std::string_view key = "bristle";
  static constexpr bool acts_in_stick = true;

  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement =
            "the contacts bend like bristles before they slide, so the block creeps in stick and "
            "friction is rounded at break-away",
        .equation = "dz/dt = v_r - sigma0 |v_r| z/f(v), mu = sigma0 z + sigma1 dz/dt",
        .source =
            "C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, IEEE Trans. Autom. Control 40 "
            "(1995) 419, doi:10.1109/9.376053",
        .experiment = "reverse the disc 5 to 50 um below break-away: an elastic return is a bristle",
        .parameters = {{.name = "sigma0",
                        .description = "stiffness of the bristles: friction per unit of their deflection",
                        .unit = "1/mm",
                        .si = 1e3,
                        .lower = 10,
                        .upper = 2000,
                        .start = 100,
                        .neutral = 2000,
                        .scales_with_friction = true,
                        .bound_scaling = BoundScaling::against_slip_length,
                        .start_grid_points = 4},
                       {.name = "sigma1",
                        .description = "damping of the bristles: friction per unit of their rate of deflection",
                        .unit = "s/mm",
                        .si = 1e3,
                        .lower = 0,
                        .upper = 0.1,
                        .neutral = 0,
                        .scales_with_friction = true,
                        .bound_scaling = BoundScaling::against_top_speed}},
        .needs = {.lead = true},
        .excitation = {.changing_speed = true},
        .sketch = {.view = SketchView::creep, .values = {40, 0}},
        .pairs = {looks_like<VelocityHighPass>(VelocityHighPass::stop_the_disc),
                  looks_like<RadiusOffset>(VelocityHighPass::stop_the_disc),
                  looks_like<ContactSpin>(
                      "compare 9 mm at 8 rpm with 18 mm at 4 rpm: the sliding speed is the same, the spin is half")}};
  }

  template <class T>
  Relaxation<T> relaxation(const T* p, const SlidingState<T>& x, const T& steady) const {
    using std::abs;
    return {p[0] * abs(x.velocity) / steady, T(x.direction * steady)};
  }

  /// sigma1 dz/dt = sigma1 v (1 - F/(f sign v)), written with F = sigma0 z.
  template <class T>
  T output(const T* p, const SlidingState<T>& x, const T& steady, const T& force) const {
    return force + p[1] * x.velocity * (1.0 - x.direction * force / steady);
  }

  /// The block rings on its bristles after re-stick, and creeps more while it does: the law of creep holds from the
  /// middle of the stick on.
  static constexpr std::size_t first_part_of_creep = 3;
  /// To this part: the block rings on a little, and every stick has a mu_s of its own, near which creep grows without
  /// bound.
  static constexpr double inaccuracy_of_creep = 0.3;

  /// v_r [m/s] in stick while the spring raises friction from `mu` at `slope` [1/s]: dF/dt = sigma0 v (1 - F/mu_s).
  template <class T>
  T creep(const T* p, const T& mu_s, double mu, double slope) const {
    return slope / (p[0] * (1.0 - mu / mu_s));
  }
};

}  // namespace tribofit
