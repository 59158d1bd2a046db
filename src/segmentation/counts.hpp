#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tribofit/segmentation/cycles.hpp"
#include "tribofit/segmentation/friction_levels.hpp"

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

/// A slider on a spring that follows its drive: it swings so little about it that friction follows the drive alone.
bool follows_drive(const Motion& motion, const Segmentation& segmentation);

/// Friction in large swings less that in small ones.
struct LevelDifference {
  Estimate value;      ///< [1 or N]
  bool agree = false;  ///< no more than chance, and what smoothing and the stated mass and stiffness leave
};
/// Nothing where there are no two levels with their errors.
std::optional<LevelDifference> difference_of(const FrictionLevels& levels);

/// Friction at break-away, and how far it falls in a whole slip, over the cycles [1 or N]: neither needs a velocity.
struct PullLevels {
  Estimate break_away, drop;
};
PullLevels pull_levels(const Segmentation& segmentation);

/// Cycles with a stick and a slip.
std::size_t count_of_cycles(const Segmentation& segmentation);

/// Whether each sample slips. Before the first and after the last cycle only the speed shows it.
std::vector<bool> slipping_samples(const Motion& motion, const Segmentation& segmentation);

}  // namespace tribofit
