#pragma once

#include <cmath>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// The disc turns under the pad: where the block rides with the disc, the pad still spins on it.
///
/// A point rho of the pad slides at v_r + omega x rho, |rho| <= R_c. Averaged over the pad, constant friction f gives
/// f g(v_r/(omega R_c)) along the track (Farkas et al. Eq 4, with complete elliptic integrals); friction that depends
/// on speed is taken at v_r/g, the mean local speed weighted as friction weighs it. That is exact to first order in the
/// fall of friction over the pad, for v_r -> 0 and for v_r -> infinity; at alpha omega R_c = 0.25 mu is 0.2 % off.
/// There is no rigid stick: below mu_s the block creeps at omega R_c g^-1(mu/mu_s).
struct ContactSpin {
  static constexpr std::string_view key = "contact-spin";
  static constexpr bool acts_in_stick = true;
  /// Spin never falls below this speed at the rim [m/s]: it keeps friction finite where the disc stands still, and
  /// lies below what a vibrometer sees.
  static constexpr double least_rim_speed = 2e-5;
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement =
                "the disc turns under the pad, so part of the contact always slides and the block creeps before "
                "break-away",
            .equation = "mu = mean over |rho| <= R_c of f(|v|) v_t/|v|, v = v_r + omega x rho",
            .source =
                "Z. Farkas, G. Bartels, T. Unger, D. E. Wolf, Phys. Rev. Lett. 90 (2003) 248302, "
                "doi:10.1103/PhysRevLett.90.248302",
            .experiment =
                "9 mm at 8 rpm against 18 mm at 4 rpm: the same sliding speed with half the spin; or a smaller pad",
            .parameters = {{.name = "R_c",
                            .description = "radius of the contact",
                            .unit = "mm",
                            .si = 1e-3,
                            .lower = 0,
                            .upper = 10,
                            .start = 2,
                            .neutral = 0,
                            .start_grid_points = 5}},
            .needs = {.lead = true, .plateau = true},
            .excitation = {.break_away = "before which the block could creep"},
            .creeps_like_sag = true,
            .sketch = {.view = SketchView::creep, .values = {4}}};
  }

  template <class T>
  static T rim_speed(const T* p, double disc_speed) {
    using std::sqrt;
    const T rim = disc_speed * p[0];
    return sqrt(rim * rim + least_rim_speed * least_rim_speed);
  }

  /// Readings of a slip below this speed are noise about rest [m/s]: taken as they are, a contact that hardly spins
  /// would lose all its friction in them. Five least rim speeds where nothing spins, which leaves 99.5 % of friction,
  /// and soon nothing where the spin itself can be read.
  template <class T>
  static T slowest_reading(const T& rim) {
    return 5 * least_rim_speed * least_rim_speed * least_rim_speed / (rim * rim);
  }

  /// g(u)/min(u, 1) as a function of x = min(u, 1/u)^2: the power series of Farkas' integrals, which is the same on
  /// both sides of u = 1, with its tail gathered in two terms that give value 8/(3 pi) and slope at u = 1 (error below
  /// 2e-4).
  template <class T>
  static T spin_factor(const T& x) {
    const T x2 = x * x, x4 = x2 * x2;
    return 1.0 - 1.0 / 8.0 * x - 1.0 / 64.0 * x2 - 5.0 / 1024.0 * (x * x2) - 0.0019368 * x4 - 0.0037290 * x * x4 * x4;
  }

  template <class T>
  static LocalSliding<T> average_over_contact(const T& rim, const T& speed) {
    if (scalar_part(speed) < scalar_part(rim)) {
      const T u = speed / rim, h = spin_factor(T(u * u));
      return {T(u * h), T(rim / h)};
    }
    const T u = rim / speed, h = spin_factor(T(u * u));
    return {h, T(speed / h)};
  }

  /// v_r [m/s] in stick at the friction `mu` and the speed `disc_speed` [rad/s] of the disc: omega R_c g^-1(mu/mu_s).
  template <class T>
  T creep(const T* p, const T& mu_s, double mu, double /*slope*/, double disc_speed) const {
    const T share = std::abs(mu) / mu_s;
    // Three steps of Newton on u h(u^2) = share; u < 1 while mu < 0.85 mu_s, beyond that the block slides.
    if (scalar_part(share) >= 0.84) return rim_speed(p, disc_speed);
    T u = share;
    for (int i = 0; i < 4; ++i) {
      const T g = u * spin_factor(T(u * u));
      const T slope = 1.0 - 0.375 * u * u - 5.0 / 64.0 * u * u * u * u - 0.034 * u * u * u * u * u * u;
      u += (share - g) / slope;
    }
    return rim_speed(p, disc_speed) * u;
  }
};

}  // namespace tribofit
