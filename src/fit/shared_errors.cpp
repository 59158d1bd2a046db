#include <algorithm>
#include <cmath>
#include <limits>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "points.hpp"
#include "shared_parts.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

bool SharingTest::is_refused() const {
  return p_value < kChanceOfRefusal && ratio > 1;
}

namespace sharing {

namespace {

/// What one record's own noise does to its parameters and, through its common ones, to all common values.
struct Contribution {
  Spread spread;    ///< of its parameters, by its own cycles
  MatrixXd common;  ///< covariance of all common values
};

Contribution contribution_of(const Part& part, const Common& common) {
  Contribution out;
  CycleEvidence evidence = part.evidence;
  const auto count = static_cast<Index>(part.common.size());
  MatrixXd known(count, count);
  if (count > 0) {
    known = inverse_of_symmetric(common.inverse(part.values, part.values));
    evidence.total(part.common, part.common) += known - part.knows();
  }
  const double squares = part.member->weight * part.member->residuals.white_squares(part.p.data());
  out.spread = part.member->record.is_points
                   ? spread_of_points(evidence, squares, part.free)
                   : spread_of(influence(evidence, part.free), slow_levels_of(part, evidence));
  const MatrixXd to_common =
      common.inverse(Eigen::all, part.values) * known;  // from the values it takes to all of them
  out.common = to_common * out.spread.covariance(part.common, part.common) * to_common.transpose();
  return out;
}

/// Degrees of freedom of a sum of variances (B. L. Welch, Biometrika 34 (1947) 28).
class SumOfVariances {
 public:
  void add(double variance, double degrees_of_freedom) {
    sum_ += variance;
    if (degrees_of_freedom > 0) squares_ += variance * variance / degrees_of_freedom;
  }
  double sum() const { return sum_; }
  double degrees_of_freedom() const { return squares_ > 0 ? sum_ * sum_ / squares_ : 1; }

 private:
  double sum_ = 0, squares_ = 0;
};

SharedEstimate estimate_of(double value, const SumOfVariances& variance, double lower, double upper) {
  SharedEstimate out;
  out.value = value;
  out.std_error = out.statistical = std::sqrt(std::max(0.0, variance.sum()));
  out.degrees_of_freedom = variance.degrees_of_freedom();
  out.at_bound = on_bound(value, lower, upper);
  return out;
}

/// Sets the interval; one that holds all that is possible says nothing.
void close(double lower, double upper, bool open, SharedEstimate& out) {
  const double half = t_quantile_95(out.degrees_of_freedom) * out.std_error;
  out.lower95 = out.value - half;
  out.upper95 = out.value + half;
  if (lower == upper) return;
  open |= !(half > 0) || (out.lower95 <= lower && out.upper95 >= upper);
  out.determined = !open;
  if (!open) {
    out.lower95 = std::max(out.lower95, lower);
    out.upper95 = std::min(out.upper95, upper);
  } else {
    out.std_error = out.statistical = out.upper95 = std::numeric_limits<double>::infinity();
    out.lower95 = -out.upper95;
  }
}

std::vector<SharedEstimate> common_estimates(const Problem& problem, const std::vector<double>& values,
                                             const std::vector<Part>& parts,
                                             const std::vector<Contribution>& contributions) {
  std::vector<SharedEstimate> out;
  for (std::size_t c = 0; c < problem.common_count; ++c) {
    SumOfVariances variance;
    for (std::size_t r = 0; r < parts.size(); ++r) {
      if (parts[r].common.empty()) continue;
      Index slot = parts[r].common[0];
      for (std::size_t k = 0; k < parts[r].common.size(); ++k) {
        if (parts[r].values[k] == Index(c)) slot = parts[r].common[k];
      }
      variance.add(contributions[r].common(Index(c), Index(c)), contributions[r].spread.degrees_of_freedom(slot));
    }
    out.push_back(estimate_of(values[c], variance, problem.lower[c], problem.upper[c]));
  }
  return out;
}

/// The parameters of one record; common ones are those of all. covariance: of all common values.
std::vector<SharedEstimate> estimates_of(const Problem& problem, const Part& part, const Contribution& contribution,
                                         const MatrixXd& covariance, const std::vector<SharedEstimate>& common) {
  const MatrixXd follow = part.own_inverse() * part.evidence.total(part.own, part.common);
  const MatrixXd elsewhere = (covariance - contribution.common)(part.values, part.values);
  const VectorXd through_common = (follow * elsewhere * follow.transpose()).diagonal();
  double freedom_of_common = std::numeric_limits<double>::infinity();
  for (const Index c : part.values) freedom_of_common = std::min(freedom_of_common, common[at(c)].degrees_of_freedom);
  std::vector<SharedEstimate> out;
  std::size_t own = 0;
  for (std::size_t k = 0; k < part.p.size(); ++k) {
    if (part.member->record.common[k] != SharingRecord::kOwn) {
      out.push_back(common[part.member->record.common[k]]);
      continue;
    }
    const double lower = problem.lower[part.member->index[k]], upper = problem.upper[part.member->index[k]];
    SumOfVariances variance;
    if (part.own_free[k]) {
      variance.add(contribution.spread.covariance(Index(k), Index(k)),
                   contribution.spread.degrees_of_freedom(Index(k)));
      variance.add(std::max(0.0, through_common(Index(own++))), freedom_of_common);
    }
    out.push_back(estimate_of(part.p[k], variance, lower, upper));
    close(lower, upper, part.open[k] || !part.own_free[k], out.back());
  }
  return out;
}

/// What differs between records beyond their own errors widens the errors of what they share.
void widen_by_differences(const SharingTest& test, std::vector<SharedEstimate>& common) {
  if (!test.is_refused()) return;
  for (SharedEstimate& value : common) {
    value.std_error *= std::sqrt(test.ratio);
    value.degrees_of_freedom = std::min(value.degrees_of_freedom, test.degrees_of_freedom);
  }
}

}  // namespace

void add_errors(const Problem& problem, const std::vector<double>& values, RecordsFit& out) {
  std::vector<Part> parts;
  for (const Member& member : problem.members)
    parts.push_back(part_at(problem, member, problem.of_member(member, values)));
  const Common common = common_of(problem, parts, values);
  for (Part& part : parts) drop_open(common, part);
  std::vector<Contribution> contributions;
  MatrixXd covariance = MatrixXd::Zero(common.inverse.rows(), common.inverse.cols());
  for (const Part& part : parts) {
    contributions.push_back(contribution_of(part, common));
    covariance += contributions.back().common;
  }
  out.test = test_of(parts, common);
  out.common = common_estimates(problem, values, parts, contributions);
  widen_by_differences(out.test, out.common);
  for (std::size_t c = 0; c < out.common.size(); ++c)
    close(problem.lower[c], problem.upper[c], common.open[c] || !common.free[c], out.common[c]);
  for (std::size_t r = 0; r < parts.size(); ++r)
    out.records.push_back(estimates_of(problem, parts[r], contributions[r], covariance, out.common));
  const Fit together = held_out_together(problem, parts, common), alone = held_out_alone(problem);
  out.held_out = compare_held_out(together, alone);
  out.held_out_rmse_together = together.error.held_out_rmse;
  out.held_out_rmse_alone = alone.error.held_out_rmse;
}

}  // namespace sharing

}  // namespace tribofit
