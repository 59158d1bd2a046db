#pragma once

#include <cmath>
#include <optional>
#include <string_view>

namespace tribofit {

/// Base laws mu(v), v = |v_r|; every model starts from one of them.
enum class BaseLaw {
  exponential,  ///< mu_k + (mu_s - mu_k) exp(-alpha v)       [D] Eq 2
  fractional,   ///< mu_k + (mu_s - mu_k) / (1 + beta v)      [D] Eq 3
  coulomb       ///< mu_k in slip, mu_s at break-away
};

/// "exponential", "fractional", "coulomb".
std::string_view to_string(BaseLaw law);
/// The law of that name, or nothing.
std::optional<BaseLaw> find_law(std::string_view name);

/// Parameters of a base law. mu_s > mu_k is not assumed: friction that rises with speed is a normal case.
/// Where friction is a force the two levels are in newtons.
template <class T>
struct LawParameters {
  T mu_s;   ///< static friction, the level at break-away [1]
  T mu_k;   ///< kinetic friction, the level at high speed [1]
  T decay;  ///< alpha (exponential) or beta (fractional) [s/m]; unused by coulomb
};

/// The fall of friction from mu_s (1) to mu_k (0) at the reduced speed x = decay * v (dimensionless).
template <class T>
T stribeck_shape(BaseLaw law, const T& x) {
  using std::exp;
  switch (law) {
    case BaseLaw::exponential:
      return exp(-x);
    case BaseLaw::fractional:
      return 1.0 / (1.0 + x);
    case BaseLaw::coulomb:
      break;
  }
  return T(0.0);
}

/// Mean of stribeck_shape over speeds average_over_contact about x with a small variance s2 of the reduced speed: shape
/// + s2 shape''/2. For samples that are means over a few neighbours; the next term is of fourth order in the
/// average_over_contact.
template <class T>
T stribeck_shape_mean(BaseLaw law, const T& x, const T& s2) {
  const T shape = stribeck_shape(law, x);
  switch (law) {
    case BaseLaw::exponential:
      return shape * (1.0 + 0.5 * s2);
    case BaseLaw::fractional:
      return shape * (1.0 + s2 * shape * shape);
    case BaseLaw::coulomb:
      break;
  }
  return shape;
}

}  // namespace tribofit
