#pragma once

#include <cmath>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Break-away grows with the time in stick: mu_s + B ln(1 + t_stick/tau_a), erased by slip.
struct Ageing {
  static EffectInfo info() {
    return {.key = "ageing",
            .statement = "contacts grow stronger while they rest, so break-away is higher after a longer stick",
            .equation = "mu_s(t_stick) = mu_s + B ln(1 + t_stick/tau_a)",
            .source = "J. H. Dieterich, J. Geophys. Res. 77 (1972) 3690, doi:10.1029/JB077i020p03690",
            .experiment = "slide, hold, slide with holds of 1, 10, 100 and 1000 s; or four disc speeds",
            .parameters = {{"B", "1", 1, 0.002, 0.03, 0.005, 0.002, true},
                           {"tau_a", "s", 1, 0.001, 10, 0.1, 0.1, false, false, 3}},
            .needs = {.stick_time = true}};
  }

  template <class T>
  void adjust(const T* p, const Slip& slip, LawParameters<T>& law) const {
    using std::log;
    if (slip.stick_time > 0) law.mu_s += p[0] * log(1.0 + slip.stick_time / p[1]);  // NaN: not recorded
  }
};

}  // namespace tribofit
