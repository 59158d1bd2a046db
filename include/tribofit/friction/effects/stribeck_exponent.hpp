#pragma once

#include <cmath>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// The fall of friction is steeper or gentler than the base law: x = decay v becomes x^delta.
struct StribeckExponent {
  static constexpr std::string_view key = "stribeck-exponent";
  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement = "friction falls with speed over a sharper or wider range than the base law",
        .equation = "mu = mu_k + (mu_s - mu_k) exp(-(alpha v)^delta), or 1/(1 + (beta v)^delta) for the last term",
        .source =
            "L. C. Bo, D. Pavelescu, Wear 82 (1982) 277; B. Armstrong-Helouvry, P. "
            "Dupont, "
            "C. Canudas de Wit, Automatica 30 (1994) 1083, doi:10.1016/0005-1098(94)90209-7",
        .experiment = "four times the disc speed, or slips faster than 3/alpha: the end of the fall shows its shape",
        .parameters = {{.name = "delta",
                        .description =
                            "exponent of the reduced speed; above 1 the fall is sharper than that of the base law",
                        .lower = 0.5,
                        .upper = 2,
                        .start = 1}},
        .sketch = {.view = SketchView::curve, .values = {1.8}}};
  }

  template <class T>
  T transform_speed(const T* p, const T& x) const {
    using std::exp;
    using std::log;
    // x^delta through the logarithm; at rest there is nothing to bend, and log(0) has no derivative.
    return scalar_part(x) > 1e-12 ? T(exp(p[0] * log(x))) : x;
  }
};

}  // namespace tribofit
