#pragma once

#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>

namespace tribofit {

/// Zero of f between low and high, where f changes sign, to the last bits.
template <class F>
double find_zero(F&& f, double low, double high, double at_low, double at_high) {
  if (at_low == 0) return low;
  if (at_high == 0) return high;
  std::uintmax_t iterations = 100;
  const auto bracket = boost::math::tools::toms748_solve(f, low, high, at_low, at_high,
                                                         boost::math::tools::eps_tolerance<double>(50), iterations);
  return bracket.second;
}

}  // namespace tribofit
