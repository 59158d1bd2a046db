#include <algorithm>
#include <cmath>
#include <numeric>

#include "cross_validation.hpp"
#include "shared_parts.hpp"

namespace tribofit::sharing {

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
      blocks_.push_back(blocks_of(o, std::min(o.cycles, kFolds)));
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
    for (std::size_t fold = 0; fold < kFolds; ++fold) hold_out(fold);
    fit_.error.held_out_rmse = std::sqrt(squares_ / counts_);
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
          rows_of(all[r].gradient, part.common) - across * (inverse * rows_of(all[r].gradient, part.own));
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
    const VectorXd common = rows_of(step, part.values);
    const VectorXd own = -own_inverse(part, kept) *
                         (rows_of(kept.gradient, part.own) + block_of(kept.curvature, part.own, part.common) * common);
    VectorXd all = VectorXd::Zero(Index(part.p.size()));
    for (std::size_t k = 0; k < part.common.size(); ++k) all(part.common[k]) = common(Index(k));
    for (std::size_t k = 0; k < part.own.size(); ++k) all(part.own[k]) = own(Index(k));
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
    return minimize(residuals, p, bounds.lower, bounds.upper, quick_search()).p;
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
