#include "influence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

std::vector<bool> NormalEquations::unconstrained() const {
  std::vector<bool> unconstrained(static_cast<std::size_t>(total.rows()));
  for (Eigen::Index k = 0; k < total.rows(); ++k) unconstrained[static_cast<std::size_t>(k)] = !(total(k, k) > 0);
  return unconstrained;
}

NormalEquations normal_equations(const ModelResiduals& residuals, const Observations& observations,
                                 const std::vector<double>& p) {
  const auto n = static_cast<Eigen::Index>(p.size());
  NormalEquations equations;
  equations.curvature.assign(observations.cycles, Eigen::MatrixXd::Zero(n, n));
  equations.gradient.assign(observations.cycles, Eigen::VectorXd::Zero(n));
  equations.level_gradient = equations.gradient;
  equations.total = Eigen::MatrixXd::Zero(n, n);
  const std::vector<ModelResiduals::Normal> slips = residuals.normal_equations(p.data());
  equations.finite = !slips.empty();
  for (std::size_t k = 0; k < slips.size(); ++k) {
    const std::size_t cycle = observations.slips[residuals.slips()[k]].cycle;
    equations.curvature[cycle] += slips[k].curvature;
    equations.gradient[cycle] += slips[k].gradient + slips[k].level_gradient;
    equations.level_gradient[cycle] += slips[k].level_gradient;
  }
  for (const Eigen::MatrixXd& c : equations.curvature) equations.total += c;
  return equations;
}

Eigen::MatrixXd inverse_over(const Eigen::MatrixXd& matrix, const std::vector<bool>& free) {
  std::vector<Eigen::Index> index;
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (free[k] && matrix(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)) > 0) {
      index.push_back(static_cast<Eigen::Index>(k));
    }
  }
  const auto m = static_cast<Eigen::Index>(index.size());
  if (m == 0) return Eigen::MatrixXd::Zero(matrix.rows(), matrix.cols());
  Eigen::VectorXd scale(m);
  Eigen::MatrixXd scaled(m, m);
  for (Eigen::Index i = 0; i < m; ++i) scale(i) = 1 / std::sqrt(matrix(index[std::size_t(i)], index[std::size_t(i)]));
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < m; ++j) {
      scaled(i, j) = scale(i) * matrix(index[std::size_t(i)], index[std::size_t(j)]) * scale(j);
    }
  }
  // Eigenvalues at rounding level belong to combinations the data do not determine: no finite error is claimed less
  // than that.
  const SymmetricEigen eigen = symmetric_eigen(scaled);
  const Eigen::VectorXd values = eigen.values.cwiseMax(1e-14);
  const Eigen::MatrixXd inverse = eigen.vectors * values.cwiseInverse().asDiagonal() * eigen.vectors.transpose();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(matrix.rows(), matrix.cols());
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < m; ++j) {
      out(index[std::size_t(i)], index[std::size_t(j)]) = scale(i) * inverse(i, j) * scale(j);
    }
  }
  return out;
}

Eigen::MatrixXd inverse_where_known(const Eigen::MatrixXd& kept, const Eigen::MatrixXd& total,
                                    const std::vector<bool>& free) {
  constexpr double kLeastKnown = 0.1;
  // total^-1 = B B'; B' kept B has the known parts as eigenvalues. Scaled, because units differ by many orders.
  const Eigen::Index n = total.rows();
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale(i) = total(i, i) > 0 ? 1 / std::sqrt(total(i, i)) : 1;
  const Eigen::MatrixXd scaled_total = scale.asDiagonal() * total * scale.asDiagonal();
  const Eigen::MatrixXd scaled_kept = scale.asDiagonal() * kept * scale.asDiagonal();
  const SymmetricEigen all = symmetric_eigen(inverse_over(scaled_total, free));
  const Eigen::MatrixXd basis = all.vectors * all.values.cwiseMax(0).cwiseSqrt().asDiagonal();
  const SymmetricEigen known = symmetric_eigen(basis.transpose() * scaled_kept * basis);
  Eigen::VectorXd inverse = known.values;
  for (Eigen::Index i = 0; i < n; ++i) inverse(i) = inverse(i) >= kLeastKnown ? 1 / inverse(i) : 0;
  const Eigen::MatrixXd directions = scale.asDiagonal() * basis * known.vectors;
  return directions * inverse.asDiagonal() * directions.transpose();
}

Eigen::MatrixXd influence(const NormalEquations& equations, const std::vector<bool>& free) {
  const auto cycles = static_cast<Eigen::Index>(equations.curvature.size());
  const auto n = static_cast<double>(cycles);
  Eigen::MatrixXd out(cycles, equations.total.rows());
  const Eigen::MatrixXd of_all = inverse_over(equations.total, free);
  for (Eigen::Index c = 0; c < cycles; ++c) {
    const auto i = static_cast<std::size_t>(c);
    const Eigen::MatrixXd inverse = inverse_over(equations.total - equations.curvature[i], free);
    // (n-1) is the jackknife's; the rows then average to the error of the estimate.
    const Eigen::VectorXd& level = equations.level_gradient[i];
    out.row(c) = -(n - 1) * (inverse * (equations.gradient[i] - level) + of_all * level).transpose();
  }
  return out;
}

std::vector<std::vector<std::size_t>> undetermined(const Eigen::MatrixXd& total, std::vector<bool>& free) {
  // An error a million times that of the parameter alone; products of derivatives by differences round at 1e-16.
  constexpr double kRounding = 1e-12, kPart = 1e-3, kLarge = 0.3;
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t tries = 0; tries < free.size(); ++tries) {
    std::vector<std::size_t> index;
    for (std::size_t k = 0; k < free.size(); ++k) {
      if (free[k] && total(Eigen::Index(k), Eigen::Index(k)) > 0) index.push_back(k);
    }
    const auto m = static_cast<Eigen::Index>(index.size());
    if (m < 2) break;
    Eigen::MatrixXd scaled(m, m);
    for (Eigen::Index i = 0; i < m; ++i) {
      for (Eigen::Index j = 0; j < m; ++j) {
        const auto a = Eigen::Index(index[std::size_t(i)]), b = Eigen::Index(index[std::size_t(j)]);
        scaled(i, j) = total(a, b) / std::sqrt(total(a, a) * total(b, b));
      }
    }
    const SymmetricEigen eigen = symmetric_eigen(scaled);  // the least first
    if (!(eigen.values(0) < kRounding)) break;
    const Eigen::VectorXd part = eigen.vectors.col(0).cwiseAbs();
    std::vector<std::size_t> group;
    std::size_t spare = index[0];
    for (Eigen::Index i = 0; i < m; ++i) {
      if (part(i) > kPart) group.push_back(index[std::size_t(i)]);
      if (part(i) > kLarge * part.maxCoeff()) spare = index[std::size_t(i)];
    }
    free[spare] = false;
    groups.push_back(std::move(group));
  }
  return groups;
}

Eigen::VectorXd level_change(const FrictionModel& model, const std::vector<double>& p) {
  Eigen::VectorXd change = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(p.size()));
  for (std::size_t k = 0; k < model.base_count(); ++k) {
    if (model.parameters()[k].parameter.scales_with_friction) change(static_cast<Eigen::Index>(k)) = p[k];
  }
  return change;
}

SlowLevels slow_levels(const NormalEquations& equations, const Eigen::VectorXd& level, const std::vector<bool>& free,
                       double known_flicker) {
  SlowLevels out;
  const std::size_t cycles = equations.curvature.size();
  out.influence.resize(static_cast<Eigen::Index>(cycles), level.size());
  const Eigen::MatrixXd inverse = inverse_over(equations.total, free);
  std::vector<double> levels;
  for (std::size_t c = 0; c < cycles; ++c) {
    const Eigen::VectorXd pull = equations.curvature[c] * level;
    const double norm = level.dot(pull);
    levels.push_back(norm > 0 ? level.dot(equations.gradient[c]) / norm : 0);
    out.influence.row(static_cast<Eigen::Index>(c)) = (inverse * pull).transpose();
  }
  out.noise = slow_noise(levels, known_flicker);
  return out;
}

namespace {

/// Standard error of a parameter where scatter is independent from cycle to cycle but for slow noise of the level.
double beside_slow_noise(const Eigen::VectorXd& influence, const SlowNoise& noise, const Eigen::VectorXd& of_level) {
  const auto n = static_cast<double>(influence.size());
  const double independent = (influence.array() - influence.mean()).square().sum() / (n * n);
  const double own = noise.variance_within() * of_level.squaredNorm();  // of which `independent` knows already
  const std::span weights(of_level.data(), static_cast<std::size_t>(of_level.size()));
  return std::sqrt(std::max(0.0, independent + noise.variance_of_sum(weights) - own));
}

}  // namespace

Spread spread_of(const Eigen::MatrixXd& influence, const SlowLevels& slow) {
  const Eigen::Index n = influence.cols();
  const Eigen::Index cycles = influence.rows();
  Spread spread;
  spread.std_error.resize(n);
  spread.degrees_of_freedom.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::VectorXd column = influence.col(k);
    const MeanError error = standard_error_of_mean({column.data(), static_cast<std::size_t>(cycles)});
    spread.std_error(k) = error.std_error;
    if (!slow.noise.covariance.empty())
      spread.std_error(k) = std::max(error.std_error, beside_slow_noise(column, slow.noise, slow.influence.col(k)));
    spread.degrees_of_freedom(k) = error.degrees_of_freedom;
  }
  const Eigen::MatrixXd centred = influence.rowwise() - influence.colwise().mean();
  const Eigen::MatrixXd plain = centred.transpose() * centred;
  spread.covariance = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double size = std::sqrt(plain(i, i) * plain(j, j));
      const double correlation = size > 0 ? plain(i, j) / size : (i == j ? 1.0 : 0.0);
      spread.covariance(i, j) = correlation * spread.std_error(i) * spread.std_error(j);
    }
  }
  return spread;
}

}  // namespace tribofit
