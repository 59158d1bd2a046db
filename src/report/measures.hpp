#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

struct Identification;

/// What several of the report's forms (terminal, JSON, CSV) need to know in the same way.

struct Interval {
  double lower = 0, upper = 0;
};

/// 95 % interval of a mean over cycles.
Interval interval_of(const Estimate& measure);

/// Sticks of more than a second, and the longest [s] (NaN where none is complete).
struct LongSticks {
  std::size_t count = 0;
  double longest = 0;
};
LongSticks long_sticks(const Segmentation& segmentation);

/// Cycles with a stick and a slip.
std::size_t count_of_cycles(const Segmentation& segmentation);

/// The best fit against another of the same protocol, on held-out cycles.
struct LawComparison {
  std::size_t first = 0, second = 0;  ///< indices of fits; `first` is the better one
  Comparison comparison;
};

/// The best fit against each other fit of the same protocol; empty where there is nothing to compare.
std::vector<LawComparison> compare_laws(std::span<const Fit> fits, std::size_t best);

/// The law of a fit with its band at `points` speeds from rest to a quarter beyond the fastest slip, so that the
/// extrapolation is seen as such.
Curve curve_of(const Fit& fit, std::size_t points);

/// Cycle and held-out fold of every sample.
struct Membership {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> cycle;  ///< index in Segmentation::cycles; none outside
  std::vector<std::size_t> fold;   ///< in which the fit held the sample's cycle out; none where it was not fitted
};
/// `before`: cycles of the traces that the fit holds before this one.
Membership membership(const Identification& trace, const Fit* fit, std::size_t before = 0);

/// Units of evidence that a trace gives to a fit: slips, or pieces of one where nothing sticks.
std::size_t evidence_of(const Identification& trace);

}  // namespace tribofit
