#pragma once

#include "tribofit/friction/effects/rate_state.hpp"

namespace tribofit {

/// Dieterich's form of rate-state: the contacts have an age theta that grows with time, at rest as well, and that
/// sliding renews over D_c. Friction is the law at the speed D_c/theta, which in steady sliding is v itself.
///
/// What acts at once (`viscous`, the direct term) is taken at v.
struct RateStateHealing {
  static constexpr std::string_view key = RateState::key;
  static EffectInfo info() {
    EffectInfo info = RateState::info();
    info.option = "healing";
    info.forms.clear();
    info.pairs.clear();  // RateState states them for both
    info.statement =
        "the contacts grow older with time, at rest as well, and are renewed over a sliding distance D_c, so friction "
        "has a memory of that length and break-away grows with the stick time";
    info.equation =
        "d theta/dt = 1 - v theta/D_c, mu = f(D_c/theta) + a asinh(v/(2 v0)), v0 = 1 mm/s; at break-away theta is the "
        "stick time and what was left before it";
    info.source =
        "J. H. Dieterich, J. Geophys. Res. 84 (1979) 2161, doi:10.1029/JB084iB05p02161; A. Ruina, J. Geophys. Res. 88 "
        "(1983) 10359, doi:10.1029/JB088iB12p10359";
    info.experiment = "slide, hold, slide with holds of 1, 10, 100 and 1000 s; 1, 2, 4 and 8 rpm";
    return info;
  }

  /// D_c [m].
  template <class T>
  T renewal_distance(const T* p) const {
    return p[0];
  }

  template <class T>
  T steady(const T* p, const SlidingState<T>& x, const T& mu) const {
    return mu + RateState::direct(p, x);
  }
};

}  // namespace tribofit
