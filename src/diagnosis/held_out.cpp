#include "held_out.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::diagnosis {

namespace {

std::vector<Eigen::Index> free_indices(const Linearised& model) {
  std::vector<Eigen::Index> index;
  for (std::size_t k = 0; k < model.free.size(); ++k) {
    if (model.free[k]) index.push_back(static_cast<Eigen::Index>(k));
  }
  return index;
}

/// Normal equations over the free parameters of some cycles.
struct Normal {
  Eigen::MatrixXd curvature;
  Eigen::VectorXd gradient;

  explicit Normal(Eigen::Index n) : curvature(Eigen::MatrixXd::Zero(n, n)), gradient(Eigen::VectorXd::Zero(n)) {}
};

Normal normal_of(const Linearised& model, const std::vector<Eigen::Index>& index, const std::vector<bool>& kept) {
  Normal out(static_cast<Eigen::Index>(index.size()));
  for (std::size_t c = 0; c < model.rows.size(); ++c) {
    if (!kept.empty() && !kept[c]) continue;
    const Eigen::MatrixXd& rows = model.rows[c];
    for (std::size_t i = 0; i < index.size(); ++i) {
      const double* column = rows.col(index[i]).data();
      for (std::size_t j = 0; j <= i; ++j) {
        out.curvature(Eigen::Index(i), Eigen::Index(j)) += dot(column, rows.col(index[j]).data(), rows.rows());
      }
      out.gradient(Eigen::Index(i)) += dot(column, rows.col(rows.cols() - 1).data(), rows.rows());
    }
  }
  out.curvature.triangularView<Eigen::StrictlyUpper>() = out.curvature.transpose();
  return out;
}

/// Columns that turn the curvature into the identity, without directions the data do not determine.
Eigen::MatrixXd whitener(const Eigen::MatrixXd& curvature) {
  const Eigen::Index n = curvature.rows();
  if (n == 0) return Eigen::MatrixXd(0, 0);
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale(i) = curvature(i, i) > 0 ? 1 / std::sqrt(curvature(i, i)) : 0;
  const SymmetricEigen eigen = symmetric_eigen(scale.asDiagonal() * curvature * scale.asDiagonal());
  std::vector<Eigen::Index> good;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (eigen.values(i) > 1e-10) good.push_back(i);
  }
  Eigen::MatrixXd out(n, static_cast<Eigen::Index>(good.size()));
  for (std::size_t g = 0; g < good.size(); ++g) {
    out.col(static_cast<Eigen::Index>(g)) =
        scale.asDiagonal() * eigen.vectors.col(good[g]) / std::sqrt(eigen.values(good[g]));
  }
  return out;
}

Eigen::VectorXd spread_out(const Eigen::VectorXd& step, const std::vector<Eigen::Index>& index, std::size_t count) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < index.size(); ++i) out(index[i]) = step(static_cast<Eigen::Index>(i));
  return out;
}

/// Step from the normal equations of the kept cycles, in the basis in which all cycles know one of everything.
Eigen::VectorXd step_of(const Normal& kept, const Eigen::MatrixXd& basis) {
  if (basis.cols() == 0) return Eigen::VectorXd::Zero(basis.rows());
  const SymmetricEigen known = symmetric_eigen(basis.transpose() * kept.curvature * basis);
  Eigen::VectorXd pull = known.vectors.transpose() * (basis.transpose() * kept.gradient);
  for (Eigen::Index i = 0; i < pull.size(); ++i) {
    const double part = known.values(i);
    pull(i) = part >= limits::kLeastKnown ? pull(i) / part : 0;
  }
  return -(basis * (known.vectors * pull));
}

}  // namespace

Eigen::VectorXd gauss_newton_step(const Linearised& model, const std::vector<bool>& kept) {
  const auto index = free_indices(model);
  const Normal all = normal_of(model, index, {});
  const Eigen::MatrixXd basis = whitener(all.curvature);
  const Normal part = kept.empty() ? all : normal_of(model, index, kept);
  return spread_out(step_of(part, basis), index, model.free.size());
}

Eigen::VectorXd bounded_step(const Linearised& model, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  std::vector<Eigen::Index> index = free_indices(model);
  std::vector<Eigen::Index> every(static_cast<std::size_t>(lower.size()));
  std::iota(every.begin(), every.end(), Eigen::Index{0});
  Normal all = normal_of(model, every, {});
  Eigen::VectorXd step = Eigen::VectorXd::Zero(lower.size());
  while (!index.empty()) {
    Normal free(static_cast<Eigen::Index>(index.size()));
    free.curvature = all.curvature(index, index);
    free.gradient = all.gradient(index);
    const Eigen::VectorXd free_step = spread_out(step_of(free, whitener(free.curvature)), index, every.size());
    Eigen::Index worst = -1;
    double most = 0;
    for (const Eigen::Index k : index) {
      step(k) = std::clamp(free_step(k), lower(k), upper(k));
      const double beyond = std::abs(free_step(k) - step(k)) / std::max(1e-300, upper(k) - lower(k));
      if (beyond > most) {
        most = beyond;
        worst = k;
      }
    }
    if (worst < 0) break;
    std::erase(index, worst);
    all.gradient += all.curvature.col(worst) * step(worst);
  }
  return step;
}

std::vector<double> squares_after(const Linearised& model, const Eigen::VectorXd& step) {
  std::vector<double> out;
  out.reserve(model.rows.size());
  Eigen::VectorXd left;  // its memory serves every cycle
  for (const Eigen::MatrixXd& rows : model.rows) {
    const Eigen::Index n = rows.cols() - 1;
    left = rows.col(n);
    left.noalias() += rows.leftCols(n) * step;
    out.push_back(left.squaredNorm());
  }
  return out;
}

std::vector<double> held_out_squares(const Linearised& model, const Blocks& blocks) {
  const auto index = free_indices(model);
  const Normal all = normal_of(model, index, {});
  const Eigen::MatrixXd basis = whitener(all.curvature);
  std::vector<double> out(model.rows.size());
  std::vector<bool> held(model.rows.size());
  for (std::size_t b = 0; b < blocks.count(); ++b) {
    for (std::size_t c = 0; c < held.size(); ++c) held[c] = blocks.of(c) == b;
    const Normal left_out = normal_of(model, index, held);
    Normal kept = all;
    kept.curvature -= left_out.curvature;
    kept.gradient -= left_out.gradient;
    const Eigen::VectorXd step = spread_out(step_of(kept, basis), index, model.free.size());
    for (std::size_t c = 0; c < held.size(); ++c) {
      if (!held[c]) continue;
      const Eigen::Index n = model.rows[c].cols() - 1;
      out[c] = (model.rows[c].col(n) + model.rows[c].leftCols(n) * step).squaredNorm();
    }
  }
  return out;
}

namespace {

/// Rows of a cycle as all friction is raised alike.
Eigen::VectorXd level_rows(const Linearised& model, std::size_t cycle) {
  return model.rows[cycle].leftCols(model.level.size()) * model.level;
}

std::span<const double> numbers_of(const Eigen::RowVectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

}  // namespace

SlowNoise slow_noise_of(const Linearised& model) {
  if (model.level.size() == 0) return {};
  std::vector<double> levels;
  for (std::size_t c = 0; c < model.rows.size(); ++c) {
    const Eigen::VectorXd shape = level_rows(model, c);
    const double norm = shape.squaredNorm();
    levels.push_back(norm > 0 ? shape.dot(model.rows[c].col(model.rows[c].cols() - 1)) / norm : 0);
  }
  return slow_noise(levels, model.known_flicker);
}

std::vector<DesignEffect> design_effects(const Linearised& model, std::size_t first, std::size_t count, double noise,
                                         const SlowNoise& slow) {
  std::vector<DesignEffect> out(count);
  if (!(noise > 0)) return out;
  const auto index = free_indices(model);
  const auto n = static_cast<Eigen::Index>(index.size()), cycles = static_cast<Eigen::Index>(model.rows.size());
  const Eigen::MatrixXd basis = whitener(normal_of(model, index, {}).curvature);
  // What each cycle pulls at each parameter: by what it leaves, and by a change of its level.
  Eigen::MatrixXd gradient(n, cycles), of_level(n, slow.covariance.empty() ? 0 : cycles);
  for (Eigen::Index c = 0; c < cycles; ++c) {
    const Eigen::MatrixXd& rows = model.rows[static_cast<std::size_t>(c)];
    const Eigen::VectorXd raised =
        of_level.cols() > 0 ? level_rows(model, static_cast<std::size_t>(c)) : Eigen::VectorXd();
    for (Eigen::Index i = 0; i < n; ++i) {
      const double* column = rows.col(index[static_cast<std::size_t>(i)]).data();
      gradient(i, c) = dot(column, rows.col(rows.cols() - 1).data(), rows.rows());
      if (of_level.cols() > 0) of_level(i, c) = dot(column, raised.data(), rows.rows());
    }
  }
  for (std::size_t k = first; k < first + count; ++k) {
    if (!model.free[k]) continue;
    const auto at = std::find(index.begin(), index.end(), static_cast<Eigen::Index>(k)) - index.begin();
    const Eigen::RowVectorXd direction = basis.row(at) * basis.transpose();  // row of the inverse curvature
    const double independent = noise * direction(at);
    if (!(independent > 0)) continue;
    const Eigen::RowVectorXd influence = static_cast<double>(cycles) * (direction * gradient);
    const Eigen::RowVectorXd pull = direction * of_level;
    const double error = standard_error_of_mean(numbers_of(influence)).std_error;
    out[k - first] = {std::max(1.0, error * error / independent),
                      1 + slow.variance_of_sum(numbers_of(pull)) / independent};
  }
  return out;
}

double fall_p_value(double fall, std::size_t parameters, double noise, double design_effect, double freedom) {
  if (!(fall > 0) || !(noise > 0)) return 1;
  const auto k = static_cast<double>(parameters);
  return f_p_value(fall / (k * noise * design_effect), k, std::max(1.0, freedom));
}

double few_frequencies(double cycles) {
  return std::max(3.0, 0.4 * std::pow(cycles, 2.0 / 3));
}

double sum(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0);
}

}  // namespace tribofit::diagnosis
