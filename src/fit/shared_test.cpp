#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "shared_parts.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

bool SharingTest::is_refused() const {
  return p_value < kChanceOfRefusal && ratio > 1;
}

namespace sharing {

namespace {

/// Spread of the sums over cycles of what a record does to some numbers, one row a cycle.
Spread spread_of_sums(const MatrixXd& rows, const SlowLevels& slow = {}) {
  return spread_of(static_cast<double>(rows.rows()) * rows, slow);
}

/// The scores of one record at the common values along the directions of which it knows something: their squares over
/// their variances, free of what few degrees of freedom add.
struct Scores {
  double squares = 0, directions = 0, degrees_of_freedom = 0;
};

Scores scores_of(const Problem& problem, const Part& part, const Common& common) {
  Scores out;
  if (part.common.empty()) return out;
  const MatrixXd knows = part.reduced(part.equations.total);
  VectorXd scale(knows.rows());
  for (Index k = 0; k < scale.size(); ++k)
    scale(k) = 1 / std::sqrt(common.information(part.values[at(k)], part.values[at(k)]));
  const SymmetricEigen eigen = symmetric_eigen(scale.asDiagonal() * knows * scale.asDiagonal());
  std::vector<Index> kept;
  for (Index k = 0; k < scale.size(); ++k) {
    if (eigen.values(k) > kLeastKnownDirection * eigen.values(scale.size() - 1)) kept.push_back(k);
  }
  if (kept.empty()) return out;
  MatrixXd to_scores(kept.size(), scale.size());
  for (Index i = 0; i < to_scores.rows(); ++i)
    to_scores.row(i) =
        (scale.asDiagonal() * eigen.vectors.col(kept[at(i)])).transpose() / std::sqrt(eigen.values(kept[at(i)]));
  const auto cycles = static_cast<Index>(part.equations.gradient.size());
  MatrixXd rows(cycles, to_scores.rows()), levels = rows;
  const VectorXd level = level_change(problem.model, part.p);
  for (Index c = 0; c < cycles; ++c) {
    rows.row(c) = (to_scores * part.reduced(part.equations.gradient[at(c)])).transpose();
    levels.row(c) = (to_scores * part.reduced(VectorXd(part.equations.curvature[at(c)] * level))).transpose();
  }
  SlowLevels slow = slow_levels_of(problem, part, part.equations);
  slow.influence = levels;
  const Spread spread = spread_of_sums(rows, slow);
  const VectorXd score = rows.colwise().sum().transpose();
  const auto k = static_cast<double>(kept.size());
  out.degrees_of_freedom = spread.degrees_of_freedom.minCoeff();
  if (!(out.degrees_of_freedom > k + 1)) return out;
  const double squares = score.dot(solve_symmetric(spread.covariance, score).col(0));
  out.directions = k;
  out.squares = squares * (out.degrees_of_freedom - k - 1) / out.degrees_of_freedom;
  return out;
}

}  // namespace

SharingTest test_of(const Problem& problem, const std::vector<Part>& parts, const Common& common) {
  SharingTest out;
  double squares = 0, directions = 0, below = 0, largest = 0;
  for (std::size_t r = 0; r < parts.size(); ++r) {
    const Scores scores = scores_of(problem, parts[r], common);
    squares += scores.squares;
    directions += scores.directions;
    if (scores.directions > 0) below += scores.degrees_of_freedom;
    if (scores.directions > 0 && scores.squares / scores.directions > largest) {
      largest = scores.squares / scores.directions;
      out.most_different = r;
    }
  }
  const auto fitted = std::count(common.free.begin(), common.free.end(), true);
  out.degrees_of_freedom = std::max(0.0, directions - static_cast<double>(fitted));
  if (!(out.degrees_of_freedom > 0) || !std::isfinite(squares)) return out;
  out.ratio = squares / out.degrees_of_freedom;
  out.p_value = f_p_value(out.ratio, out.degrees_of_freedom, below);
  return out;
}

}  // namespace sharing

}  // namespace tribofit
