#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction remembers over a sliding distance: d phi/ds = (f(v) - phi)/D_c, mu = phi + a asinh(|v|/(2 v0)).
struct RateState {
  static constexpr double reference_velocity = 1e-3;  ///< v0 = 1 mm/s [m/s]

  static EffectInfo info() {
    return {.key = "rate-state",
            .statement =
                "the contacts are renewed over a sliding distance D_c, so friction follows its steady value "
                "with a memory of that length",
            .equation = "d phi/dt = (v/D_c) (f(v) - phi), mu = phi + a asinh(v/(2 v0)), v0 = 1 mm/s",
            .source =
                "A. Ruina, J. Geophys. Res. 88 (1983) 10359, doi:10.1029/JB088iB12p10359; "
                "J. R. Rice, N. Lapusta, K. Ranjith, J. Mech. Phys. Solids 49 (2001) 1865, "
                "doi:10.1016/S0022-5096(01)00042-4",
            .experiment = "1, 2, 4 and 8 rpm: the loop closes over a constant distance, not a constant time",
            .parameters = {{"D_c", "um", 1e-6, 0.5, 200, 20, 0.5, false, false, 4, BoundScaling::with_slip_length},
                           {"a", "1", 1, 0, 0.02, 0, 0, true}},
            .forms = {
                {"healing", "contacts also grow older at rest (Dieterich), so break-away grows with the stick time"}}};
  }

  template <class T>
  Relaxation<T> relaxation(const T* p, const SlidingState<T>& x, const T& steady) const {
    using std::abs;
    return {abs(x.velocity) / p[0], steady};
  }

  /// a asinh(|v|/(2 v0)): what friction does at once.
  template <class T>
  static T direct(const T* p, const SlidingState<T>& x) {
    using std::abs;
    using std::log;
    using std::sqrt;
    const T r = abs(x.velocity) / (2 * reference_velocity);
    return p[1] * log(r + sqrt(r * r + 1.0));
  }

  template <class T>
  T output(const T* p, const SlidingState<T>& x, const T& /*steady*/, const T& phi) const {
    return phi + direct(p, x);
  }
};

}  // namespace tribofit
