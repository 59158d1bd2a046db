#pragma once

#include <fmt/format.h>

#include <boost/math/distributions/beta.hpp>
#include <cstddef>
#include <string>

namespace recovery {

/// Ends of the one-sided intervals of a rate after `hits` in `n`, each at this confidence (Clopper, Pearson, Biometrika
/// 26 (1934) 404).
inline double upper_bound(std::size_t hits, std::size_t n, double confidence) {
  if (hits >= n) return 1;
  const boost::math::beta_distribution<double> beta(static_cast<double>(hits) + 1, static_cast<double>(n - hits));
  return boost::math::quantile(beta, confidence);
}
inline double lower_bound(std::size_t hits, std::size_t n, double confidence) {
  return 1 - upper_bound(n - hits, n, confidence);
}
inline double upper_bound_95(std::size_t hits, std::size_t n) {
  return upper_bound(hits, n, 0.95);
}

/// "95.4 %"; empty: there were none.
inline std::string percent(std::size_t hits, std::size_t n) {
  return n == 0 ? "" : fmt::format("{:.1f} %", 100 * static_cast<double>(hits) / static_cast<double>(n));
}

/// "95.4 % (88.6 to 98.7)", the ends of the two-sided 95 % interval.
inline std::string share(std::size_t hits, std::size_t n) {
  if (n == 0) return "";
  return fmt::format("{} ({:.1f} to {:.1f})", percent(hits, n), 100 * lower_bound(hits, n, 0.975),
                     100 * upper_bound(hits, n, 0.975));
}

}  // namespace recovery
