#include "cycle_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A symmetric matrix over the free parameters that it knows of, scaled to a diagonal of one: units differ by orders.
struct ScaledBlock {
  std::vector<Index> index;
  VectorXd scale;
  SymmetricEigen eigen;
};

ScaledBlock scaled_block(const MatrixXd& matrix, const std::vector<bool>& free) {
  ScaledBlock out;
  for (Index k = 0; k < matrix.rows(); ++k) {
    if (free[static_cast<std::size_t>(k)] && matrix(k, k) > 0) out.index.push_back(k);
  }
  if (out.index.empty()) return out;
  out.scale = matrix.diagonal()(out.index).cwiseSqrt().cwiseInverse();
  out.eigen = symmetric_eigen(out.scale.asDiagonal() * matrix(out.index, out.index) * out.scale.asDiagonal());
  return out;
}

/// Squares of a cycle after a step.
double squares_after(const CycleEvidence& evidence, std::size_t cycle, const VectorXd& step) {
  const double change = step.dot(2 * evidence.gradient[cycle] + evidence.curvature[cycle] * step);
  return std::max(0.0, evidence.squares[cycle] + change);
}

}  // namespace

std::vector<bool> CycleEvidence::unconstrained() const {
  std::vector<bool> out;
  for (Index k = 0; k < total.rows(); ++k) out.push_back(!(total(k, k) > 0));
  return out;
}

CycleEvidence evidence_at(const ModelResiduals& residuals, const Observations& observations,
                          const std::vector<double>& p) {
  const auto n = static_cast<Index>(p.size());
  CycleEvidence out;
  out.curvature.assign(observations.cycles, MatrixXd::Zero(n, n));
  out.gradient.assign(observations.cycles, VectorXd::Zero(n));
  out.level_gradient = out.gradient;
  out.total = MatrixXd::Zero(n, n);
  const std::vector<ModelResiduals::Normal> slips = residuals.normal_equations(p.data());
  out.finite = !slips.empty();
  for (std::size_t k = 0; k < slips.size(); ++k) {
    const std::size_t cycle = observations.slips[residuals.slips()[k]].cycle;
    out.curvature[cycle] += slips[k].curvature;
    out.gradient[cycle] += slips[k].gradient + slips[k].level_gradient;
    out.level_gradient[cycle] += slips[k].level_gradient;
  }
  for (const MatrixXd& c : out.curvature) out.total += c;
  return out;
}

CycleEvidence evidence_of(const std::vector<MatrixXd>& rows) {
  CycleEvidence out;
  out.finite = !rows.empty();
  for (const MatrixXd& own : rows) {
    const Index n = own.cols() - 1;
    MatrixXd products(n + 1, n + 1);
    for (Index i = 0; i <= n; ++i) {
      for (Index j = 0; j <= i; ++j)
        products(i, j) = products(j, i) = dot(own.col(i).data(), own.col(j).data(), own.rows());
    }
    out.curvature.emplace_back(products.topLeftCorner(n, n));
    out.gradient.emplace_back(products.col(n).head(n));
    out.squares.push_back(products(n, n));
  }
  if (out.finite) out.total = MatrixXd::Zero(out.gradient[0].size(), out.gradient[0].size());
  for (const MatrixXd& c : out.curvature) out.total += c;
  return out;
}

VectorXd level_change(const FrictionModel& model, const std::vector<double>& p) {
  VectorXd change = VectorXd::Zero(static_cast<Index>(p.size()));
  for (std::size_t k = 0; k < model.base_count(); ++k) {
    if (model.parameters()[k].parameter.scales_with_friction) change(static_cast<Index>(k)) = p[k];
  }
  return change;
}

NormalSum sum_of(const CycleEvidence& evidence, const std::vector<std::size_t>& block_of_cycle, std::size_t held) {
  NormalSum out{evidence.total, VectorXd::Zero(evidence.total.rows())};
  for (std::size_t c = 0; c < evidence.gradient.size(); ++c) {
    if (!block_of_cycle.empty() && block_of_cycle[c] == held) {
      out.curvature -= evidence.curvature[c];
    } else {
      out.gradient += evidence.gradient[c];
    }
  }
  return out;
}

MatrixXd known_directions(const MatrixXd& total, const std::vector<bool>& free) {
  constexpr double kLeastEigenvalue = 1e-10;
  const ScaledBlock block = scaled_block(total, free);
  std::vector<Index> good;
  for (Index i = 0; i < block.eigen.values.size(); ++i) {
    if (block.eigen.values(i) > kLeastEigenvalue) good.push_back(i);
  }
  MatrixXd out = MatrixXd::Zero(total.rows(), static_cast<Index>(good.size()));
  if (!good.empty()) {
    const VectorXd root = block.eigen.values(good).cwiseSqrt().cwiseInverse();
    out(block.index, Eigen::all) = block.scale.asDiagonal() * block.eigen.vectors(Eigen::all, good) * root.asDiagonal();
  }
  return out;
}

MatrixXd inverse_where_known(const MatrixXd& kept, const MatrixXd& directions) {
  constexpr double kLeastKnown = 0.1;  // less, and the step there is a guess
  if (directions.cols() == 0) return MatrixXd::Zero(kept.rows(), kept.cols());
  const SymmetricEigen known = symmetric_eigen(directions.transpose() * kept * directions);
  const VectorXd inverse = known.values.unaryExpr([](double part) { return part >= kLeastKnown ? 1 / part : 0; });
  const MatrixXd of_kept = directions * known.vectors;
  return of_kept * inverse.asDiagonal() * of_kept.transpose();
}

MatrixXd inverse_over(const MatrixXd& matrix, const std::vector<bool>& free) {
  const ScaledBlock block = scaled_block(matrix, free);
  MatrixXd out = MatrixXd::Zero(matrix.rows(), matrix.cols());
  if (block.index.empty()) return out;
  // Eigenvalues at rounding level belong to combinations the data do not determine: no finite error is claimed less
  // than that.
  const VectorXd values = block.eigen.values.cwiseMax(1e-14);
  const MatrixXd vectors = block.scale.asDiagonal() * block.eigen.vectors;
  out(block.index, block.index) = vectors * values.cwiseInverse().asDiagonal() * vectors.transpose();
  return out;
}

VectorXd gauss_newton_step(const CycleEvidence& evidence, const std::vector<bool>& free) {
  const NormalSum all = sum_of(evidence);
  return -inverse_where_known(all.curvature, known_directions(all.curvature, free)) * all.gradient;
}

VectorXd bounded_step(const CycleEvidence& evidence, const VectorXd& lower, const VectorXd& upper) {
  NormalSum all = sum_of(evidence);
  std::vector<bool> free(static_cast<std::size_t>(lower.size()), true);
  VectorXd step = VectorXd::Zero(lower.size());
  while (true) {
    const VectorXd wanted = -inverse_where_known(all.curvature, known_directions(all.curvature, free)) * all.gradient;
    Index worst = -1;
    double most = 0;
    for (Index k = 0; k < step.size(); ++k) {
      if (!free[static_cast<std::size_t>(k)]) continue;
      step(k) = std::clamp(wanted(k), lower(k), upper(k));
      const double beyond = std::abs(wanted(k) - step(k)) / std::max(1e-300, upper(k) - lower(k));
      if (beyond > most) most = beyond, worst = k;
    }
    if (worst < 0) return step;
    free[static_cast<std::size_t>(worst)] = false;
    all.gradient += all.curvature.col(worst) * step(worst);
  }
}

std::vector<double> squares_after(const CycleEvidence& evidence, const VectorXd& step) {
  std::vector<double> out;
  for (std::size_t c = 0; c < evidence.squares.size(); ++c) out.push_back(squares_after(evidence, c, step));
  return out;
}

CycleEvidence moved(CycleEvidence evidence, const VectorXd& step) {
  evidence.squares = squares_after(evidence, step);
  for (std::size_t c = 0; c < evidence.gradient.size(); ++c) evidence.gradient[c] += evidence.curvature[c] * step;
  return evidence;
}

std::vector<double> held_out_squares(const CycleEvidence& evidence, const std::vector<bool>& free,
                                     const std::vector<std::size_t>& block_of_cycle) {
  const MatrixXd directions = known_directions(evidence.total, free);
  std::vector<double> out(evidence.squares.size());
  for (std::size_t block = 0; block <= *std::max_element(block_of_cycle.begin(), block_of_cycle.end()); ++block) {
    const NormalSum kept = sum_of(evidence, block_of_cycle, block);
    const VectorXd step = -inverse_where_known(kept.curvature, directions) * kept.gradient;
    for (std::size_t c = 0; c < out.size(); ++c) {
      if (block_of_cycle[c] == block) out[c] = squares_after(evidence, c, step);
    }
  }
  return out;
}

MatrixXd influence(const CycleEvidence& evidence, const std::vector<bool>& free) {
  const std::size_t cycles = evidence.curvature.size();
  MatrixXd out(cycles, evidence.total.rows());
  const MatrixXd of_all = inverse_over(evidence.total, free);
  for (std::size_t c = 0; c < cycles; ++c) {
    const MatrixXd inverse = inverse_over(evidence.total - evidence.curvature[c], free);
    // (n-1) is the jackknife's; the rows then average to the error of the estimate.
    const VectorXd& level = evidence.level_gradient[c];
    out.row(static_cast<Index>(c)) =
        -static_cast<double>(cycles - 1) * (inverse * (evidence.gradient[c] - level) + of_all * level).transpose();
  }
  return out;
}

std::vector<std::vector<std::size_t>> undetermined(const MatrixXd& total, std::vector<bool>& free) {
  // An error a million times that of the parameter alone; products of derivatives by differences round at 1e-16.
  constexpr double kRounding = 1e-12, kPart = 1e-3, kLarge = 0.3;
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t tries = 0; tries < free.size(); ++tries) {
    const ScaledBlock block = scaled_block(total, free);
    if (block.index.size() < 2 || !(block.eigen.values(0) < kRounding)) break;  // the least first
    const VectorXd part = block.eigen.vectors.col(0).cwiseAbs();
    std::vector<std::size_t> group;
    auto spare = static_cast<std::size_t>(block.index[0]);
    for (Index i = 0; i < part.size(); ++i) {
      const auto k = static_cast<std::size_t>(block.index[static_cast<std::size_t>(i)]);
      if (part(i) > kPart) group.push_back(k);
      if (part(i) > kLarge * part.maxCoeff()) spare = k;
    }
    free[spare] = false;
    groups.push_back(std::move(group));
  }
  return groups;
}

SlowNoise slow_noise_of(const CycleEvidence& evidence) {
  if (evidence.level.size() == 0) return {};
  std::vector<double> levels;
  for (std::size_t c = 0; c < evidence.curvature.size(); ++c) {
    const double norm = evidence.level.dot(evidence.curvature[c] * evidence.level);
    levels.push_back(norm > 0 ? evidence.level.dot(evidence.gradient[c]) / norm : 0);
  }
  return slow_noise(levels, evidence.known_flicker);
}

SlowLevels slow_levels(const CycleEvidence& evidence, const std::vector<bool>& free) {
  SlowLevels out{slow_noise_of(evidence), {}};
  if (out.noise.covariance.empty()) return out;
  const MatrixXd inverse = inverse_over(evidence.total, free);
  out.influence = MatrixXd(evidence.curvature.size(), evidence.total.rows());
  for (std::size_t c = 0; c < evidence.curvature.size(); ++c)
    out.influence.row(static_cast<Index>(c)) = (inverse * (evidence.curvature[c] * evidence.level)).transpose();
  return out;
}

namespace {

/// Standard error of a parameter where scatter is independent from cycle to cycle but for slow noise of the level.
double beside_slow_noise(const VectorXd& influence, const SlowNoise& noise, const VectorXd& of_level) {
  const auto n = static_cast<double>(influence.size());
  const double independent = (influence.array() - influence.mean()).square().sum() / (n * n);
  const double own = noise.variance_within() * of_level.squaredNorm();  // of which `independent` knows already
  const std::span weights(of_level.data(), static_cast<std::size_t>(of_level.size()));
  return std::sqrt(std::max(0.0, independent + noise.variance_of_sum(weights) - own));
}

}  // namespace

Spread spread_of(const MatrixXd& influence, const SlowLevels& slow) {
  const Index n = influence.cols();
  Spread spread{VectorXd(n), VectorXd(n), {}};
  for (Index k = 0; k < n; ++k) {
    const VectorXd column = influence.col(k);
    const Estimate error = standard_error_of_mean({column.data(), static_cast<std::size_t>(column.size())});
    spread.std_error(k) = error.std_error;
    if (!slow.noise.covariance.empty())
      spread.std_error(k) = std::max(error.std_error, beside_slow_noise(column, slow.noise, slow.influence.col(k)));
    spread.degrees_of_freedom(k) = error.degrees_of_freedom;
  }
  const MatrixXd centred = influence.rowwise() - influence.colwise().mean();
  MatrixXd correlation = centred.transpose() * centred;
  const VectorXd scale = correlation.diagonal().unaryExpr([](double s) { return s > 0 ? 1 / std::sqrt(s) : 0; });
  correlation = scale.asDiagonal() * correlation * scale.asDiagonal();
  correlation.diagonal().setOnes();
  spread.covariance = spread.std_error.asDiagonal() * correlation * spread.std_error.asDiagonal();
  return spread;
}

}  // namespace tribofit
