#pragma once

#include <cstddef>
#include <vector>

#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// What the cycles of a record come to.

struct Interval {
  double lower = 0, upper = 0;
};

/// 95 % interval of a mean over cycles.
Interval interval_of(const Estimate& estimate);

/// Sticks of more than a second, and the longest [s] (NaN where none is complete).
struct LongSticks {
  std::size_t count = 0;
  double longest = 0;
};
LongSticks long_sticks(const Segmentation& segmentation);

/// Some stick lasts several times as long as the mean one: the mean alone would mislead.
bool has_uneven_sticks(const Segmentation& segmentation);

/// Cycles with a stick and a slip.
std::size_t count_of_cycles(const Segmentation& segmentation);

/// Whether each sample slips. Before the first and after the last cycle only the speed shows it.
std::vector<bool> slipping_samples(const Motion& motion, const Segmentation& segmentation);

}  // namespace tribofit
