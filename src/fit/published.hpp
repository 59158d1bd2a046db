#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "influence.hpp"

namespace tribofit {

/// Levels by per-cycle extremes ([D] 3.2, Protocol::published): the largest friction in stick and the smallest in slip,
/// cycle by cycle.
struct CycleExtremes {
  std::array<std::vector<double>, 2>
      of_cycle;  ///< mu_s, mu_k of each unit of evidence; NaN where a cycle is not complete

  /// Means over the cycles that are not in `left_out` (or over all); NaN when fewer than three are left.
  std::array<double, 2> means(const std::vector<bool>& left_out = {}) const;
};
CycleExtremes extremes_of(const Observations& observations, std::span<const Record> records);

/// Influence of each cycle: that on the two means, and what the parameters fitted after them (free) make of both.
Eigen::MatrixXd published_influence(const NormalEquations& equations, const std::vector<bool>& free,
                                    const CycleExtremes& extremes);

}  // namespace tribofit
