#pragma once

namespace tribofit::studies {

/// Zero of f between low and high, where its sign changes, by bisection until the bracket is `tolerance` of its place.
template <class F>
double root_of(F&& f, double low, double high, double tolerance) {
  const bool at_low = f(low) > 0;
  while (high - low > tolerance * high) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0) == at_low ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace tribofit::studies
