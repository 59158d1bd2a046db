#include "shared_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit::sharing {

MatrixXd Part::knows() const {
  constexpr double kRounding = 1e-10;  // left where a value of its own takes all that it knows
  const MatrixXd across = evidence.total(common, own);
  MatrixXd out = evidence.total(common, common) - across * own_inverse() * across.transpose();
  for (Index k = 0; k < out.rows(); ++k) {
    if (out(k, k) > kRounding * evidence.total(common[at(k)], common[at(k)])) continue;
    out.row(k).setZero();
    out.col(k).setZero();
  }
  return out;
}

VectorXd Part::pull(const VectorXd& gradient) const {
  return gradient(common) - evidence.total(common, own) * (own_inverse() * gradient(own));
}

Part part_at(const Problem& problem, const Member& member, std::vector<double> p) {
  Part out;
  out.member = &member;
  out.p = std::move(p);
  out.evidence = evidence_at(member.residuals, *member.record.observations, out.p);
  for (MatrixXd& c : out.evidence.curvature) c *= member.weight;
  for (VectorXd& g : out.evidence.gradient) g *= member.weight;
  for (VectorXd& g : out.evidence.level_gradient) g *= member.weight;
  out.evidence.total *= member.weight;
  out.evidence.level = level_change(problem.model, out.p);
  out.evidence.known_flicker = member.record.observations->flicker;
  const std::vector<bool> unconstrained = out.evidence.unconstrained();
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
  for (const auto& group : undetermined(out.evidence.total, own_inside)) {
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

Common common_of(const Problem& problem, const std::vector<Part>& parts, const std::vector<double>& values) {
  const auto count = static_cast<Index>(problem.common_count);
  Common out;
  out.information = MatrixXd::Zero(count, count);
  for (const Part& part : parts) out.information(part.values, part.values) += part.knows();
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

SlowLevels slow_levels_of(const Part& part, const CycleEvidence& evidence) {
  const bool shows = evidence.known_flicker > 0 || part.common.empty();
  return part.member->record.is_points || !shows ? SlowLevels() : slow_levels(evidence, part.free);
}

namespace {

/// The scores of one record at the common values along the directions of which it knows something: their squares over
/// their variances, free of what few degrees of freedom add.
struct Scores {
  double squares = 0, directions = 0, degrees_of_freedom = 0;
};

Scores scores_of(const Part& part, const Common& common) {
  Scores out;
  if (part.common.empty()) return out;
  const MatrixXd knows = part.knows();
  const VectorXd scale = common.information.diagonal()(part.values).cwiseSqrt().cwiseInverse();
  const SymmetricEigen eigen = symmetric_eigen(scale.asDiagonal() * knows * scale.asDiagonal());
  std::vector<Index> kept;
  for (Index k = 0; k < scale.size(); ++k) {
    if (eigen.values(k) > kLeastKnownDirection * eigen.values(scale.size() - 1)) kept.push_back(k);
  }
  if (kept.empty()) return out;
  const MatrixXd to_scores = (scale.asDiagonal() * eigen.vectors(Eigen::all, kept) *
                              eigen.values(kept).cwiseSqrt().cwiseInverse().asDiagonal())
                                 .transpose();
  const std::vector<VectorXd>& gradient = part.evidence.gradient;
  MatrixXd rows(gradient.size(), kept.size()), levels = rows;
  for (std::size_t c = 0; c < gradient.size(); ++c) {
    rows.row(Index(c)) = (to_scores * part.pull(gradient[c])).transpose();
    levels.row(Index(c)) = (to_scores * part.pull(part.evidence.curvature[c] * part.evidence.level)).transpose();
  }
  SlowLevels slow = slow_levels_of(part, part.evidence);
  slow.influence = levels;
  const Spread spread = spread_of(static_cast<double>(rows.rows()) * rows, slow);  // of sums over the cycles
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

SharingTest test_of(const std::vector<Part>& parts, const Common& common) {
  SharingTest out;
  double squares = 0, directions = 0, below = 0, largest = 0;
  for (std::size_t r = 0; r < parts.size(); ++r) {
    const Scores scores = scores_of(parts[r], common);
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

namespace {

/// The records without the cycles of one fold, one Gauss-Newton step from the fit of all (as cross_validate() does):
/// squares of the cycles held out.
class HeldOut {
 public:
  HeldOut(const Problem& problem, const std::vector<Part>& parts, const Common& common)
      : problem_(problem), parts_(parts), common_(common) {
    for (const Part& part : parts) {
      const Observations& o = *part.member->record.observations;
      first_.push_back(fit_.cycle_squares.size());
      blocks_.push_back(blocks_of(o, std::min(o.cycles, folds_)));
      fit_.cycle_squares.resize(fit_.cycle_squares.size() + o.cycles, 0.0);
      fit_.cycle_counts.resize(fit_.cycle_squares.size(), 0.0);
      for (const auto& slip : o.slips) {
        const double count = std::accumulate(o.weight.begin() + std::ptrdiff_t(slip.begin),
                                             o.weight.begin() + std::ptrdiff_t(slip.end), 0.0);
        fit_.cycle_counts[first_.back() + slip.cycle] += count;
        counts_ += count;
      }
    }
  }

  /// Cycles of all records with their held-out squares over the variance of their record.
  Fit run() {
    for (std::size_t fold = 0; fold < folds_; ++fold) hold_out(fold);
    fit_.error.held_out_rmse = std::sqrt(squares_ / counts_);
    return std::move(fit_);
  }

 private:
  const std::size_t folds_ = static_cast<std::size_t>(FitOptions().folds);

  void hold_out(std::size_t fold) {
    MatrixXd information = MatrixXd::Zero(common_.information.rows(), common_.information.cols());
    VectorXd score = VectorXd::Zero(information.rows());
    std::vector<NormalSum> kept;
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      const Part& part = parts_[r];
      kept.push_back(sum_of(part.evidence, blocks_[r], fold));
      const MatrixXd across = kept[r].curvature(part.common, part.own) * own_inverse(part, kept[r]);
      information(part.values, part.values) +=
          kept[r].curvature(part.common, part.common) - across * kept[r].curvature(part.own, part.common);
      score(part.values) += kept[r].gradient(part.common) - across * kept[r].gradient(part.own);
    }
    VectorXd step = score;  // nothing, where nothing is common
    if (step.size() > 0)
      step = -inverse_where_known(information, known_directions(common_.information, common_.free)) * score;
    for (std::size_t r = 0; r < parts_.size(); ++r) judge(r, fold, kept[r], step);
  }

  static MatrixXd own_inverse(const Part& part, const NormalSum& kept) {
    return inverse_where_known(kept.curvature, known_directions(part.evidence.total, part.own_free))(part.own,
                                                                                                     part.own);
  }

  void judge(std::size_t r, std::size_t fold, const NormalSum& kept, const VectorXd& step) {
    const Part& part = parts_[r];
    VectorXd all = VectorXd::Zero(Index(part.p.size()));
    all(part.common) = step(part.values);
    all(part.own) = -own_inverse(part, kept) *
                    (kept.gradient(part.own) + kept.curvature(part.own, part.common) * step(part.values));
    const Observations& observations = *part.member->record.observations;
    std::vector<std::size_t> held, rest;
    for (const std::size_t s : all_slips(observations))
      (blocks_[r][observations.slips[s].cycle] == fold ? held : rest).push_back(s);
    const std::vector<double> p = moved(part, all, rest);
    const std::vector<double> squares = ModelResiduals(problem_.model, observations, held).squares(p.data());
    for (std::size_t k = 0; k < squares.size(); ++k) {
      fit_.cycle_squares[first_[r] + observations.slips[held[k]].cycle] += part.member->weight * squares[k];
      squares_ += squares[k];
    }
  }

  /// Where a step leads; where it is too long, own values are fitted to the rest anew.
  std::vector<double> moved(const Part& part, const VectorXd& step, const std::vector<std::size_t>& rest) const {
    Bounds bounds;
    for (const std::size_t value : part.member->index) {
      bounds.lower.push_back(problem_.lower[value]);
      bounds.upper.push_back(problem_.upper[value]);
    }
    std::vector<double> p = part.p;
    if (!take_step(bounds, part.free, step, p)) return p;
    for (std::size_t k = 0; k < p.size(); ++k) {
      if (part.own_free[k]) {
        p[k] = part.p[k];
      } else {
        bounds.lower[k] = bounds.upper[k] = p[k];
      }
    }
    ModelResiduals residuals(problem_.model, *part.member->record.observations, rest);
    residuals.whiten(part.member->whitening, true);
    return minimize(residuals, p, bounds.lower, bounds.upper, kQuickSearch).p;
  }

  const Problem& problem_;
  const std::vector<Part>& parts_;
  const Common& common_;
  std::vector<std::size_t> first_;  // cycle of each record among all
  std::vector<std::vector<std::size_t>> blocks_;
  Fit fit_;
  double squares_ = 0, counts_ = 0;  // of all cycles, as they are
};

}  // namespace

Fit held_out_together(const Problem& problem, const std::vector<Part>& parts, const Common& common) {
  return HeldOut(problem, parts, common).run();
}

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
    own.whiten_at(own.record.values);
    parts.push_back(part_at(alone, own, own.record.values));
  }
  return HeldOut(alone, parts, common_of(alone, parts, {})).run();
}

}  // namespace tribofit::sharing
