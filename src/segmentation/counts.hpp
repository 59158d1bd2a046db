#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribofit/segmentation/cycles.hpp"
#include "tribofit/segmentation/friction_levels.hpp"

namespace tribofit {

/// What the cycles of a record come to.

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

/// What keeps the data from carrying an analysis, as sentences; none when nothing does.
/// must_slip: the analysis needs slip, as a fit of a friction law does.
std::vector<std::string> obstacles(const Motion& motion, const Segmentation& segmentation, bool must_slip);

/// Whether each sample slips. Before the first and after the last cycle only the speed shows it.
std::vector<bool> slipping_samples(const Motion& motion, const Segmentation& segmentation);

namespace segmentation {

/// Friction [1 or N] of a slip while speeding up less that while slowing down: mean difference over ten bins of speed
/// between a quarter and three quarters of the peak. NaN where the slip does not show both branches.
double branch_difference(std::span<const double> velocity, std::span<const double> friction, int direction);

/// Frequency from the periods: one over their mean without those further than three robust standard deviations from the
/// median (a long stick, a missed slip), which belong to another motion.
Estimate frequency_of(const std::vector<double>& periods);

/// Mean over slips with its standard error: where there are fewer than thirty, too few to show how neighbours are
/// correlated, as if they were not.
Estimate mean_over_slips(std::vector<double> values);

}  // namespace segmentation

}  // namespace tribofit
