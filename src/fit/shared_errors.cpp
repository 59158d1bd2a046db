#include <algorithm>
#include <cmath>
#include <numeric>

#include "fit_context.hpp"
#include "influence.hpp"
#include "limits.hpp"
#include "points.hpp"
#include "shared_fit.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using sharing::Member;
using sharing::Problem;

/// Part of what a record knows of a value that rounding leaves where a value of its own takes all of it.
constexpr double kRounding = 1e-10;

std::size_t at(Index k) {
  return static_cast<std::size_t>(k);
}

/// Rows and columns `index` of a matrix.
MatrixXd block_of(const MatrixXd& matrix, const std::vector<Index>& rows, const std::vector<Index>& columns) {
  MatrixXd out(rows.size(), columns.size());
  for (Index i = 0; i < out.rows(); ++i) {
    for (Index j = 0; j < out.cols(); ++j) out(i, j) = matrix(rows[at(i)], columns[at(j)]);
  }
  return out;
}

VectorXd part_of(const VectorXd& all, const std::vector<Index>& rows) {
  VectorXd out(rows.size());
  for (Index i = 0; i < out.size(); ++i) out(i) = all(rows[at(i)]);
  return out;
}

/// One record at one set of values: its normal equations, weighted, and which of its parameters are whose.
struct Part {
  const Member* member = nullptr;
  std::vector<double> p;
  NormalEquations equations;
  std::vector<bool> free;       ///< estimated: of its own and common ones
  std::vector<bool> own_free;   ///< those of its own
  std::vector<bool> open;       ///< of its own, of which only combinations are determined
  std::vector<Index> own, common;  ///< free parameters of either kind
  std::vector<Index> values;       ///< the common values that `common` take

  /// Of the common parameters once the record's own follow: solves for these.
  MatrixXd own_inverse(const MatrixXd& curvature) const { return block_of(inverse_over(curvature, own_free), own, own); }
  /// What the record knows of the common values, beside its own ones.
  MatrixXd reduced(const MatrixXd& curvature) const {
    const MatrixXd across = block_of(curvature, common, own);
    MatrixXd out = block_of(curvature, common, common) - across * own_inverse(curvature) * across.transpose();
    for (Index k = 0; k < out.rows(); ++k) {
      if (out(k, k) > kRounding * curvature(common[at(k)], common[at(k)])) continue;
      out.row(k).setZero();
      out.col(k).setZero();
    }
    return out;
  }
  VectorXd reduced(const VectorXd& gradient) const {
    const MatrixXd across = block_of(equations.total, common, own);
    return part_of(gradient, common) - across * (own_inverse(equations.total) * part_of(gradient, own));
  }
};

Part part_at(const Problem& problem, const Member& member, std::vector<double> p) {
  Part out;
  out.member = &member;
  out.p = std::move(p);
  out.equations = normal_equations(member.residuals, *member.record.observations, out.p);
  for (MatrixXd& c : out.equations.curvature) c *= member.weight;
  for (VectorXd& g : out.equations.gradient) g *= member.weight;
  for (VectorXd& g : out.equations.level_gradient) g *= member.weight;
  out.equations.total *= member.weight;
  const std::vector<bool> unconstrained = out.equations.unconstrained();
  std::vector<bool> own_inside;
  for (std::size_t k = 0; k < out.p.size(); ++k) {
    const double lower = problem.lower[member.index[k]], upper = problem.upper[member.index[k]];
    const bool own = member.record.common[k] == SharingRecord::kOwn;
    out.free.push_back(!unconstrained[k] && lower < upper);
    out.own_free.push_back(own && out.free[k]);
    own_inside.push_back(out.own_free[k] && !on_bound(out.p[k], lower, upper));
  }
  out.open.assign(out.p.size(), false);
  const std::vector<bool> all_inside = own_inside;
  for (const auto& group : undetermined(out.equations.total, own_inside)) {
    for (const std::size_t k : group) out.open[k] = true;
  }
  for (std::size_t k = 0; k < out.p.size(); ++k) {
    const bool spare = own_inside[k] != all_inside[k];
    out.free[k] = out.free[k] && !spare;
    out.own_free[k] = out.own_free[k] && !spare;
    if (out.own_free[k]) out.own.push_back(static_cast<Index>(k));
    if (!out.free[k] || out.own_free[k]) continue;
    out.common.push_back(static_cast<Index>(k));
    out.values.push_back(static_cast<Index>(member.index[k]));
  }
  return out;
}

/// What all records know of the common values, and what follows from it.
struct Common {
  MatrixXd information, inverse;
  std::vector<bool> free, open;
};

void add_to(MatrixXd& all, const std::vector<Index>& index, const MatrixXd& part) {
  for (Index i = 0; i < part.rows(); ++i) {
    for (Index j = 0; j < part.cols(); ++j) all(index[at(i)], index[at(j)]) += part(i, j);
  }
}

Common common_of(const Problem& problem, const std::vector<Part>& parts, const std::vector<double>& values) {
  const auto count = static_cast<Index>(problem.common_count);
  Common out;
  out.information = MatrixXd::Zero(count, count);
  for (const Part& part : parts) add_to(out.information, part.values, part.reduced(part.equations.total));
  std::vector<bool> inside;
  for (std::size_t c = 0; c < problem.common_count; ++c) {
    out.free.push_back(out.information(Index(c), Index(c)) > 0 && problem.lower[c] < problem.upper[c]);
    inside.push_back(out.free[c] && !on_bound(values[c], problem.lower[c], problem.upper[c]));
  }
  const std::vector<bool> all_inside = inside;
  out.open.assign(problem.common_count, false);
  for (const auto& group : undetermined(out.information, inside)) {
    for (const std::size_t k : group) out.open[k] = true;
  }
  for (std::size_t c = 0; c < problem.common_count; ++c) out.free[c] = out.free[c] && inside[c] == all_inside[c];
  out.inverse = inverse_over(out.information, out.free);
  return out;
}

/// Leaves out of a record the common values that no record determines.
void drop_open(const Common& common, Part& part) {
  std::vector<Index> kept, values;
  for (std::size_t k = 0; k < part.common.size(); ++k) {
    if (common.free[at(part.values[k])]) {
      kept.push_back(part.common[k]);
      values.push_back(part.values[k]);
    } else {
      part.free[at(part.common[k])] = false;
    }
  }
  part.common = std::move(kept);
  part.values = std::move(values);
}

/// Spread of the sums over cycles of what a record does to some numbers, one row a cycle.
Spread spread_of_sums(const MatrixXd& rows, const SlowLevels& slow = {}) {
  return spread_of(static_cast<double>(rows.rows()) * rows, slow);
}

/// Slow noise of the level, where the record shows it without any model: what else differs between records is tested.
SlowLevels slow_levels_of(const Problem& problem, const Part& part, const NormalEquations& equations) {
  const double flicker = part.member->record.observations->flicker;
  if (part.member->record.is_points || !(flicker > 0)) return {};
  return slow_levels(equations, level_change(problem.model, part.p), part.free, flicker);
}

double squares_of(const Part& part) {
  const auto n = part.member->residuals.count();
  std::vector<double> rows(n);
  part.member->residuals.evaluate(part.p.data(), rows.data(), nullptr);
  return part.member->weight * std::inner_product(rows.begin(), rows.end(), rows.begin(), 0.0);
}

/// What one record's own noise does to its parameters and, through its common ones, to all common values.
struct Contribution {
  Spread spread;       ///< of its parameters, by its own cycles
  MatrixXd to_common;  ///< from the values it takes to all of them
  MatrixXd common;     ///< covariance of all common values
};

Contribution contribution_of(const Problem& problem, const Part& part, const Common& common) {
  Contribution out;
  NormalEquations equations = part.equations;
  const auto count = static_cast<Index>(part.common.size());
  MatrixXd known = inverse_of_symmetric(block_of(common.inverse, part.values, part.values));
  if (count > 0) add_to(equations.total, part.common, known - part.reduced(part.equations.total));
  out.spread = part.member->record.is_points
                   ? spread_of_points(equations, squares_of(part), part.free)
                   : spread_of(influence(equations, part.free), slow_levels_of(problem, part, equations));
  out.to_common = MatrixXd::Zero(common.inverse.rows(), count);
  for (Index j = 0; j < count; ++j) out.to_common.col(j) = common.inverse.col(part.values[at(j)]);
  if (count > 0) out.to_common = out.to_common * known;
  out.common = out.to_common * block_of(out.spread.covariance, part.common, part.common) * out.to_common.transpose();
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
  const MatrixXd follow =
      part.own_inverse(part.equations.total) * block_of(part.equations.total, part.own, part.common);
  const MatrixXd elsewhere = block_of(covariance, part.values, part.values) -
                             block_of(contribution.common, part.values, part.values);
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

/// The records without the cycles of one fold, one Gauss-Newton step from the fit of all (as cross_validate() does):
/// squares of the cycles held out.
class HeldOut {
 public:
  HeldOut(const Problem& problem, const std::vector<Part>& parts, const Common& common)
      : problem_(problem), parts_(parts), common_(common) {
    for (const Part& part : parts) {
      const Observations& o = *part.member->record.observations;
      first_.push_back(fit_.cycle_squares.size());
      blocks_.push_back(blocks_of(o, std::min(o.cycles, kFolds)));
      fit_.cycle_squares.resize(fit_.cycle_squares.size() + o.cycles, 0.0);
      fit_.cycle_counts.resize(fit_.cycle_squares.size(), 0.0);
      for (const auto& slip : o.slips) {
        double& count = fit_.cycle_counts[first_.back() + slip.cycle];
        for (std::size_t i = slip.begin; i < slip.end; ++i) count += part.member->weight * o.weight[i];
      }
    }
  }

  /// Cycles of all records with their held-out squares over the variance of their record.
  Fit run() {
    for (std::size_t fold = 0; fold < kFolds; ++fold) hold_out(fold);
    return std::move(fit_);
  }

 private:
  static constexpr std::size_t kFolds = 5;

  struct Kept {
    MatrixXd curvature;
    VectorXd gradient;
  };
  Kept kept(std::size_t r, std::size_t fold) const {
    const NormalEquations& all = parts_[r].equations;
    Kept out{all.total, VectorXd::Zero(all.total.rows())};
    for (std::size_t c = 0; c < all.curvature.size(); ++c) {
      if (blocks_[r][c] == fold) {
        out.curvature -= all.curvature[c];
      } else {
        out.gradient += all.gradient[c];
      }
    }
    return out;
  }

  void hold_out(std::size_t fold) {
    MatrixXd information = MatrixXd::Zero(common_.information.rows(), common_.information.cols());
    VectorXd score = VectorXd::Zero(information.rows());
    std::vector<Kept> all;
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      const Part& part = parts_[r];
      all.push_back(kept(r, fold));
      const MatrixXd across = block_of(all[r].curvature, part.common, part.own);
      const MatrixXd inverse = own_inverse(part, all[r]);
      add_to(information, part.values,
             block_of(all[r].curvature, part.common, part.common) - across * inverse * across.transpose());
      const VectorXd reduced =
          part_of(all[r].gradient, part.common) - across * (inverse * part_of(all[r].gradient, part.own));
      for (std::size_t k = 0; k < part.values.size(); ++k) score(part.values[k]) += reduced(Index(k));
    }
    VectorXd step = score;  // nothing, where nothing is common
    if (step.size() > 0) step = -inverse_where_known(information, common_.information, common_.free) * score;
    for (std::size_t r = 0; r < parts_.size(); ++r) judge(r, fold, all[r], step);
  }

  static MatrixXd own_inverse(const Part& part, const Kept& kept) {
    return block_of(inverse_where_known(kept.curvature, part.equations.total, part.own_free), part.own, part.own);
  }

  void judge(std::size_t r, std::size_t fold, const Kept& kept, const VectorXd& step) {
    const Part& part = parts_[r];
    const VectorXd common = part_of(step, part.values);
    const VectorXd own = -own_inverse(part, kept) * (part_of(kept.gradient, part.own) +
                                                     block_of(kept.curvature, part.own, part.common) * common);
    std::vector<double> p = part.p;
    const auto move = [&](Index k, double by) {
      const std::size_t value = part.member->index[at(k)];
      p[at(k)] = std::clamp(p[at(k)] + by, problem_.lower[value], problem_.upper[value]);
    };
    for (std::size_t k = 0; k < part.common.size(); ++k) move(part.common[k], common(Index(k)));
    for (std::size_t k = 0; k < part.own.size(); ++k) move(part.own[k], own(Index(k)));
    const Observations& observations = *part.member->record.observations;
    std::vector<std::size_t> held;
    for (const std::size_t s : all_slips(observations)) {
      if (blocks_[r][observations.slips[s].cycle] == fold) held.push_back(s);
    }
    const std::vector<double> squares = ModelResiduals(problem_.model, observations, held).squares(p.data());
    for (std::size_t k = 0; k < squares.size(); ++k)
      fit_.cycle_squares[first_[r] + observations.slips[held[k]].cycle] += part.member->weight * squares[k];
  }

  const Problem& problem_;
  const std::vector<Part>& parts_;
  const Common& common_;
  std::vector<std::size_t> first_;  // cycle of each record among all
  std::vector<std::vector<std::size_t>> blocks_;
  Fit fit_;
};

/// The records each by itself, where their own fits ended.
Fit held_out_alone(const Problem& problem) {
  Problem alone{problem.model, 0, {}, {}, {}};
  std::deque<SharingRecord> records;
  std::vector<Part> parts;
  for (const Member& member : problem.members) {
    records.push_back(member.record);
    records.back().common.assign(member.index.size(), SharingRecord::kOwn);
    Member& own = alone.members.emplace_back(problem.model, records.back());
    for (const std::size_t value : member.index) {
      own.index.push_back(alone.lower.size());
      alone.lower.push_back(problem.lower[value]);
      alone.upper.push_back(problem.upper[value]);
    }
    own.weight = member.weight;
    own.whitening = own.residuals.whitening_at(own.record.values.data());
    own.residuals.whiten(own.whitening, true);
    parts.push_back(part_at(alone, own, own.record.values));
  }
  return HeldOut(alone, parts, common_of(alone, parts, {})).run();
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

bool SharingTest::is_refused() const {
  return p_value < kChanceOfRefusal && ratio > 1;
}

void sharing::add_errors(const Problem& problem, const std::vector<double>& values, RecordsFit& out) {
  std::vector<Part> parts;
  for (const Member& member : problem.members)
    parts.push_back(part_at(problem, member, problem.of_member(member, values)));
  const Common common = common_of(problem, parts, values);
  for (Part& part : parts) drop_open(common, part);
  std::vector<Contribution> contributions;
  MatrixXd covariance = MatrixXd::Zero(common.inverse.rows(), common.inverse.cols());
  for (const Part& part : parts) {
    contributions.push_back(contribution_of(problem, part, common));
    covariance += contributions.back().common;
  }
  out.test = test_of(problem, parts, common);
  out.common = common_estimates(problem, values, parts, contributions);
  widen_by_differences(out.test, out.common);
  for (std::size_t c = 0; c < out.common.size(); ++c)
    close(problem.lower[c], problem.upper[c], common.open[c] || !common.free[c], out.common[c]);
  for (std::size_t r = 0; r < parts.size(); ++r)
    out.records.push_back(estimates_of(problem, parts[r], contributions[r], covariance, out.common));
  const Fit together = HeldOut(problem, parts, common).run(), alone = held_out_alone(problem);
  out.held_out = compare_held_out(together, alone);
}

}  // namespace tribofit
