#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "limits.hpp"
#include "model_residuals.hpp"
#include "statistics/linear_algebra.hpp"

namespace tribofit {

namespace {

/// Products of the rows of one slip: g = d model/d mu_s, u the model itself, r what it leaves.
struct Products {
  std::size_t slip = 0;  ///< index in the observations
  double rows = 0, gg = 0, gu = 0, uu = 0, gr = 0, ur = 0, rr = 0;

  /// The regression on g and u together: how far they are from being one, the level, and what both leave.
  double independence() const { return gg * uu - gu * gu; }
  bool has_both() const { return independence() > kLeastIndependence * gg * uu; }
  double level() const { return (gg * ur - gu * gr) / independence(); }
  double left_by_both() const { return rr - (gr * (uu * gr - gu * ur) + ur * (gg * ur - gu * gr)) / independence(); }

  /// The same of rows whitened against scatter of the level. slow: its variance over that of a row.
  Products whitened(double slow) const {
    const double part = slow / (1 + slow * uu);
    Products out = *this;
    out.gg -= part * gu * gu;
    out.gr -= part * gu * ur;
    out.rr -= part * ur * ur;
    return out;
  }
};

/// Half the mean square of the steps between neighbours of one stretch, and how many steps there are.
struct Steps {
  double variance = 0, count = 0;
};

Steps steps_of(const std::vector<double>& values, const std::vector<std::size_t>& stretch) {
  Steps out;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (stretch[k] != stretch[k - 1]) continue;
    out.variance += 0.5 * (values[k] - values[k - 1]) * (values[k] - values[k - 1]);
    out.count += 1;
  }
  if (out.count > 0) out.variance /= out.count;
  return out;
}

/// t^2/sigma^2 of the scatter of levels: what those of neighbours differ by, but no more than the record shows without
/// any model. 0 where chance would make levels differ as much. What a wrong model does to the levels is thus no
/// scatter.
double level_scatter_of_slips(const std::vector<Products>& slips, const Observations& observations) {
  std::vector<double> levels;
  std::vector<std::size_t> stretch;
  double left = 0, freedom = 0, spread = 0;
  for (const Products& slip : slips) {
    const auto& range = observations.slips[slip.slip];
    if (!slip.has_both()) continue;
    levels.push_back(slip.level());
    stretch.push_back(2 * range.record + (range.direction > 0 ? 1 : 0));
    left += slip.left_by_both();
    freedom += slip.rows - 2;
    spread += slip.gg / slip.independence();
  }
  const Steps steps = steps_of(levels, stretch);
  if (!(left > 0) || !(freedom > 0) || !(steps.count > 0)) return 0;
  // The variance from steps of n independent values has a relative standard error of sqrt(3/n) (J. von Neumann, Ann.
  // Math. Stat. 12 (1941) 367).
  const auto n = static_cast<double>(levels.size());
  const double noise = left / freedom, by_chance = noise * spread / n;
  if (!(steps.variance > by_chance * (1 + kClearOfZero * std::sqrt(3 / steps.count)))) return 0;
  double most = 0;  // of one record or several
  for (const RecordNoise& record : observations.noise) most += record.level_scatter * record.level_scatter;
  most /= static_cast<double>(std::max<std::size_t>(1, observations.noise.size()));
  return std::min(steps.variance - by_chance, most) / noise;
}

/// delta_i of every slip by least squares, and what noise is left once it is taken out.
void whiten_break_away(const std::vector<Products>& slips, const Observations& observations,
                       ModelResiduals::Whitening& out) {
  std::vector<double> deltas;
  std::vector<std::size_t> records;
  double left = 0, freedom = 0, norms = 0;
  for (const Products& slip : slips) {
    deltas.push_back(slip.gr / slip.gg);
    out.level[slip.slip] = -deltas.back();
    records.push_back(observations.slips[slip.slip].record);
    left += slip.rr - slip.gr * slip.gr / slip.gg;
    freedom += slip.rows - 1;
    norms += slip.gg;
  }
  const auto n = static_cast<double>(deltas.size());
  double mean = 0, scatter = 0;
  for (const double delta : deltas) mean += delta / n;
  for (const double delta : deltas) scatter += (delta - mean) * (delta - mean) / n;
  // What differs slowly from cycle to cycle, or between records, may be an effect that the model lacks: only what
  // neighbours differ by is taken for scatter.
  const Steps steps = steps_of(deltas, records);
  if (steps.count > 0) scatter = std::min(scatter, steps.variance);
  if (deltas.size() < 2 || !(left > 0) || !(freedom > 0)) return;
  out.noise = left / freedom;            // of a row
  const double information = norms / n;  // of a slip about its delta
  scatter = std::max(0.0, scatter - out.noise / information);
  out.part = 1 - 1 / std::sqrt(1 + scatter * information / out.noise);
  out.log_spread.assign(out.g.size(), 0.0);
  for (const Products& slip : slips) {
    const double share = scatter * slip.gg / out.noise;
    out.log_spread[slip.slip] = std::log1p(share) + std::log1p(out.slow * slip.uu);
    out.weight[slip.slip] = share / (1 + share);
  }
  for (std::size_t k = 0; k < out.g.size(); ++k) out.level[k] *= out.weight[k];
}

}  // namespace

ModelResiduals::Whitening ModelResiduals::whitening_at(const double* p) const {
  Whitening out;
  out.g.resize(observations_.slips.size());
  out.u.resize(observations_.slips.size());
  out.level.assign(observations_.slips.size(), 0.0);
  out.weight.assign(observations_.slips.size(), 0.0);
  const bool breaks_away =
      std::any_of(slips_.begin(), slips_.end(), [this](std::size_t s) { return observations_.slips[s].from_stick; });
  if (!breaks_away) return out;
  std::vector<Products> slips(slips_.size());
  const bool finite = in_parts([&](const ModelResiduals& own, std::size_t begin, std::size_t end) {
    Workspace workspace;
    Block block;
    for (std::size_t k = begin; k < end; ++k) {
      if (!own.fill(k, p, 1, workspace, block, true)) return false;
      const auto& range = observations_.slips[slips_[k]];
      const Eigen::Index rows = friction_rows(range);
      Eigen::VectorXd& g = out.g[slips_[k]];
      g = block.col(0).head(rows);
      const auto r = block.col(1).head(rows);
      Eigen::VectorXd& u = out.u[slips_[k]];
      u = -r;
      for (std::size_t i = range.begin; i < range.end; ++i) {
        u(static_cast<Eigen::Index>(i - range.begin)) += observations_.root_weight[i] * observations_.friction[i];
      }
      if (range.from_stick) u(rows - 1) += range.break_away_root_weight * range.break_away_friction;
      slips[k] = {
          slips_[k],      static_cast<double>(rows), g.squaredNorm(), g.dot(u), u.squaredNorm(), g.dot(r), u.dot(r),
          r.squaredNorm()};
    }
    return true;
  });
  if (!finite) {
    out.g.assign(observations_.slips.size(), {});
    out.u = out.g;
    return out;
  }
  std::erase_if(slips, [](const Products& slip) { return !(slip.gg > 0); });
  out.slow = level_scatter_of_slips(slips, observations_);
  for (Products& slip : slips) slip = slip.whitened(out.slow);
  whiten_break_away(slips, observations_, out);
  return out;
}

void ModelResiduals::whiten_level(const Eigen::VectorXd& level, Block& block) const {
  const double norm = level.squaredNorm();
  if (!(norm > 0)) return;
  const double part = 1 - 1 / std::sqrt(1 + whitening_->slow * norm);
  const Eigen::RowVectorXd mean = level.transpose() * block.topRows(level.size()) / norm;
  block.topRows(level.size()) -= part * level * mean;
}

Eigen::MatrixXd ModelResiduals::corrections(const std::vector<Block>& blocks) const {
  if (whitening_ == nullptr || whitening_->part <= 0 || blocks.empty()) return {};
  const Eigen::Index columns = blocks[0].cols() - 1;
  Eigen::MatrixXd out(columns, static_cast<Eigen::Index>(blocks.size()));
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(columns);
  double weights = 0;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    auto own = out.col(static_cast<Eigen::Index>(k));
    const double* g = blocks[k].col(columns).data();
    const double norm = dot(g, g, blocks[k].rows()), weight = whitening_->weight[slips_[k]];
    for (Eigen::Index j = 0; j < columns; ++j) {
      own(j) = norm > 0 ? dot(g, blocks[k].col(j).data(), blocks[k].rows()) / norm : 0;
    }
    mean += weight * own;
    weights += weight;
  }
  if (weights > 0) mean /= weights;
  out = whitening_->part * (mean.replicate(1, out.cols()) - out);
  return out;
}

void ModelResiduals::add_to(Block& block, Eigen::Index slip, const Eigen::MatrixXd& added) {
  for (Eigen::Index j = 0; j < added.rows(); ++j) block.col(j) += added(j, slip) * block.col(added.rows());
}

std::vector<double> ModelResiduals::squares_of(const std::vector<Eigen::MatrixXd>& blocks) const {
  const Eigen::MatrixXd added = corrections(blocks);
  std::vector<double> out;
  out.reserve(blocks.size());
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto r = blocks[k].col(0), g = blocks[k].col(1);
    out.push_back(added.cols() > 0 ? (r + added(0, static_cast<Eigen::Index>(k)) * g).squaredNorm() : r.squaredNorm());
  }
  return out;
}

}  // namespace tribofit
