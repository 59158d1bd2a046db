#pragma once

#include <cmath>

#include "tribofit/friction/law.hpp"

namespace tribofit {

/// mu_k in slip, mu_s at break-away.
struct CoulombLaw {
  static constexpr std::string_view key = "coulomb";

  static LawInfo info() {
    return {.statement = "friction in slip is the same at every speed, and another level breaks a stick",
            .equation = "mu = mu_k in slip, mu_s at break-away",
            .source = "C. A. Coulomb, Theorie des machines simples (1785)",
            .parameters = {static_level(), kinetic_level()},
            .two_levels = true,
            .constant_in_slip = true};
  }
  static std::vector<double> start(const FrictionCurve& curve) {
    const double mean = curve.line_over([](double) { return 0.0; }).constant;
    return {std::isnan(curve.break_away) ? mean : curve.break_away, mean};
  }
  template <class T>
  static T at_rest(const T* q) {
    return q[0];
  }
  template <class T>
  static T friction(const T* q, const T& /*v*/) {
    return q[1];
  }
  template <class T>
  static T mean_friction(const T* q, const T& /*v*/, const T& /*variance*/) {
    return q[1];
  }
};

}  // namespace tribofit
