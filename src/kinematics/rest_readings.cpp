#include "rest_readings.hpp"

#include <algorithm>

#include "limits.hpp"
#include "statistics/linear_algebra.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

LinearFit fit(const RestReadings& readings, const MatrixXd& design, const StickWeights& weights, bool with_errors) {
  const Index n = design.cols();
  MatrixXd rows(design.rows(), n + 1);
  rows << design, readings.velocity;
  MatrixXd normal = MatrixXd::Zero(n + 1, n + 1);
  for (std::size_t k = 0; k < readings.sticks.size(); ++k) {
    auto part = rows.middleRows(readings.sticks[k].begin, readings.sticks[k].size);
    if (!weights.used[k]) continue;
    part.rowwise() -= (weights.of_mean[k] * part.colwise().mean()).eval();
    normal += part.transpose() * part;
  }
  LinearFit out;
  const VectorXd scale = normal.diagonal().cwiseSqrt();
  if (!(scale.head(n).minCoeff() > 0)) return out;
  const MatrixXd scaled = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const SymmetricSystem solved = solve_symmetric_system(scaled.topLeftCorner(n, n), scaled.col(n).head(n));
  if (!(solved.reciprocal_condition >= kFittable)) return out;
  const VectorXd back = scale.head(n).cwiseInverse();
  out.x = scale(n) * back.cwiseProduct(solved.x);
  out.left = normal(n, n) * (1 - scaled.col(n).head(n).dot(solved.x));
  if (!with_errors) return out;
  MatrixXd scores = MatrixXd::Zero(n, n);
  double sticks = 0;
  for (std::size_t k = 0; k < readings.sticks.size(); ++k) {
    const auto part = rows.middleRows(readings.sticks[k].begin, readings.sticks[k].size);
    if (!weights.used[k]) continue;
    const VectorXd score = part.leftCols(n).transpose() * (part.col(n) - part.leftCols(n) * out.x);
    scores += score * score.transpose(), sticks += 1;
  }
  const MatrixXd inverse = back.asDiagonal() * solved.inverse * back.asDiagonal();
  out.covariance = sticks / std::max(1.0, sticks - static_cast<double>(n)) * inverse * scores * inverse;
  return out;
}

/// From what a model leaves: how much the levels of sticks wander, and which of them are far off.
StickWeights weights_of(const RestReadings& readings, const VectorXd& residuals) {
  double within = 0, freedom = 0;
  std::vector<double> levels, off;
  for (const RestReadings::Stick& stick : readings.sticks) {
    const auto part = residuals.segment(stick.begin, stick.size);
    levels.push_back(part.mean());
    within += (part.array() - part.mean()).square().sum(), freedom += static_cast<double>(stick.size) - 1;
  }
  const double centre = median(levels);
  for (const double level : levels) off.push_back(std::abs(level - centre));
  const double spread = kSigmaPerMad * median(off), rounding = kRoundingOfLevel * readings.scale;
  const double limit = std::max(kFarLevel * spread, rounding);
  StickWeights out;
  within = std::max(within / freedom, rounding * rounding);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const double size = static_cast<double>(readings.sticks[k].size);
    const double level = std::max(0.0, spread * spread - within / size);
    out.of_mean.push_back(level > 0 ? 1 - std::sqrt(within / (within + size * level)) : 0);
    out.used.push_back(off[k] <= limit);
  }
  if (static_cast<double>(std::count(out.used.begin(), out.used.end(), true)) <
      kLevelsKept * static_cast<double>(out.used.size()))
    out.used.assign(out.used.size(), true);
  return out;
}

}  // namespace

VectorXd RestReadings::means(std::span<const double> blocks) const {
  VectorXd out(static_cast<Index>(pieces.size()));
  for (std::size_t k = 0; k < pieces.size(); ++k)
    out(static_cast<Index>(k)) = mean_of(blocks.subspan(pieces[k].first, pieces[k].second - pieces[k].first));
  return out;
}

RestReadings rest_readings(const PlateauSearch& search) {
  const std::vector<StickPlateau>& runs = search.plateaus.runs;
  std::vector<double> sizes;
  for (const StickPlateau& run : runs) sizes.push_back(static_cast<double>(run.size()));
  const double least = kShortestPlateau * median(std::move(sizes));
  std::vector<double> velocity = search.blocks.mean, time(velocity.size());
  for (std::size_t b = 0; b < time.size(); ++b) {
    time[b] = (static_cast<double>(b) + 0.5) * search.blocks.step;
    if (!search.disc.mean.empty()) velocity[b] -= search.disc.mean[b];
  }
  RestReadings readings;
  for (const StickPlateau& run : runs) {
    const std::size_t size = run.inner_end() - run.inner_begin(), count = std::min(size, kMostPieces);
    if (static_cast<double>(run.size()) < least || count < kFewestForMedian) continue;
    readings.sticks.push_back({static_cast<Index>(readings.pieces.size()), static_cast<Index>(count),
                               static_cast<double>(run.size()) * search.blocks.step});
    for (std::size_t k = 0; k < count; ++k)
      readings.pieces.emplace_back(run.inner_begin() + k * size / count, run.inner_begin() + (k + 1) * size / count);
  }
  if (readings.sticks.empty()) return readings;
  readings.velocity = readings.means(velocity);
  readings.scale = readings.means(search.blocks.mean).cwiseAbs().mean();
  readings.time = readings.means(time);
  return readings;
}

RestRegression::RestRegression(const RestReadings& readings)
    : readings_(readings), design_(readings.velocity.size(), 2) {
  const double middle = readings.time.mean(), half = 0.5 * (readings.time.maxCoeff() - readings.time.minCoeff());
  design_ << VectorXd::Ones(design_.rows()), (readings.time.array() - middle) / half;
  settle();
}

void RestRegression::add(const MatrixXd& columns) {
  design_.conservativeResize(Eigen::NoChange, design_.cols() + columns.cols());
  design_.rightCols(columns.cols()) = columns;
  settle();
}

void RestRegression::replace(Index at, const MatrixXd& columns) {
  design_.middleCols(at, columns.cols()) = columns;
  fit_ = fit(readings_, design_, weights_, true);
}

std::size_t RestRegression::sticks() const {
  return static_cast<std::size_t>(std::count(weights_.used.begin(), weights_.used.end(), true));
}

LinearFit RestRegression::with(const MatrixXd& columns, bool with_errors) const {
  MatrixXd design(design_.rows(), design_.cols() + columns.cols());
  design << design_, columns;
  return fit(readings_, design, weights_, with_errors);
}

LinearFit RestRegression::in_half(const MatrixXd& columns, const LinearFit& whole, bool second) const {
  RestReadings left = readings_;
  left.velocity -= design_ * whole.x.head(design_.cols());
  StickWeights half = weights_;
  for (std::size_t k = 0; k < half.used.size(); ++k)
    half.used[k] = half.used[k] && (2 * k >= half.used.size()) == second;
  MatrixXd design(design_.rows(), 1 + columns.cols());
  design << VectorXd::Ones(design_.rows()), columns;
  return fit(left, design, half, false);
}

void RestRegression::settle() {
  constexpr int kRounds = 4;
  weights_ = {std::vector<double>(readings_.sticks.size(), 0.0), std::vector<bool>(readings_.sticks.size(), true)};
  for (int round = 0; round < kRounds; ++round) {
    fit_ = fit(readings_, design_, weights_, true);
    if (fit_.x.size() == 0) return;
    weights_ = weights_of(readings_, readings_.velocity - design_ * fit_.x);
  }
}

}  // namespace tribofit::kinematics
