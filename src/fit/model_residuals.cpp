#include "model_residuals.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribofit/friction/evaluate.hpp"

namespace tribofit {

namespace {

/// Derivatives taken in one pass over a slip.
constexpr int kStride = 4;
using Dual = ceres::Jet<double, kStride>;

/// sign(r) sqrt(rho(r^2)) for a residual whose weight has the square root given.
template <class T>
T bend(const T& r, const ModelResiduals::Options& options, double root_weight) {
  using std::abs;
  using std::sqrt;
  if (options.loss == Loss::squares || options.loss_width <= 0) return r;
  const double s = options.loss_width * root_weight;
  const T u = abs(r) / s;
  T root = u;
  if (options.loss == Loss::huber) {
    if (scalar_part(u) > 1) root = sqrt(2.0 * u - 1.0);
  } else if (scalar_part(u) > 1e-8) {
    root = sqrt(2.0 * (sqrt(1.0 + u * u) - 1.0));
  }
  return scalar_part(r) < 0 ? T(-s * root) : T(s * root);
}

}  // namespace

ModelResiduals::ModelResiduals(const FrictionModel& model, const Observations& observations,
                               std::vector<std::size_t> slips, const Options& options)
    : model_(model), observations_(observations), slips_(std::move(slips)), options_(options) {}

/// Calls write(row, residual) for every row of a slip; false where the model is not finite.
template <class T, class Write>
bool ModelResiduals::run(const Observations::Range& range, const T* p, Write&& write) const {
  const Slip slip = observations_.slip(range);
  std::vector<T> velocity(slip.size()), mu(slip.size());
  std::transform(slip.velocity.begin(), slip.velocity.end(), velocity.begin(), [](double v) { return T(v); });
  tribofit::evaluate<T>(model_, p, slip, velocity, mu);
  for (std::size_t i = 0; i < slip.size(); ++i) {
    const double root_weight = observations_.root_weight[range.begin + i];
    const T r = root_weight * (observations_.friction[range.begin + i] - mu[i]);
    if (!std::isfinite(scalar_part(r))) return false;
    write(i, bend(r, options_, root_weight));
  }
  if (range.from_stick) {
    const T r = range.break_away_friction - break_away_level(model_, p, slip);
    if (!std::isfinite(scalar_part(r))) return false;
    write(slip.size(), bend(r, options_, 1.0));
  }
  return true;
}

bool ModelResiduals::fill(std::size_t k, const double* p, bool with_jacobian, Rows& rows) const {
  const auto& range = observations_.slips[slips_[k]];
  const std::size_t n = parameter_count();
  const auto count = static_cast<Eigen::Index>(range.end - range.begin + (range.from_stick ? 1 : 0));
  rows.jacobian_and_residual.resize(count, with_jacobian ? static_cast<Eigen::Index>(n) + 1 : 1);
  auto& matrix = rows.jacobian_and_residual;
  if (!with_jacobian) {
    if (!run<double>(range, p, [&](std::size_t row, double r) { matrix(Eigen::Index(row), 0) = r; })) return false;
  }
  std::vector<Dual> dual(n);
  for (std::size_t first = 0; with_jacobian && first < n; first += kStride) {
    const std::size_t last = std::min(n, first + kStride);
    for (std::size_t j = 0; j < n; ++j) {
      dual[j] = j >= first && j < last ? Dual(p[j], static_cast<int>(j - first)) : Dual(p[j]);
    }
    const bool finite = run<Dual>(range, dual.data(), [&](std::size_t row, const Dual& r) {
      const auto i = static_cast<Eigen::Index>(row);
      matrix(i, Eigen::Index(n)) = r.a;
      for (std::size_t j = first; j < last; ++j) matrix(i, Eigen::Index(j)) = r.v[Eigen::Index(j - first)];
    });
    if (!finite) return false;
  }
  if (whitening_ != nullptr) {
    const Whitening& w = (*whitening_)[slips_[k]];
    if (w.part > 0) matrix -= (w.part / w.g.squaredNorm() * w.g) * (w.g.transpose() * matrix).eval();
  }
  return true;
}

bool ModelResiduals::evaluate(const double* p, double* residual, double* jacobian) const {
  const auto n = static_cast<Eigen::Index>(parameter_count());
  Rows rows;
  std::fill_n(residual, count(), 0.0);
  if (jacobian != nullptr) std::fill_n(jacobian, count() * parameter_count(), 0.0);
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    if (!fill(k, p, jacobian != nullptr, rows)) return false;
    double* r = residual + first_row(k);
    if (jacobian == nullptr) {
      r[0] = rows.residual().norm();
      continue;
    }
    Eigen::MatrixXd& matrix = rows.jacobian_and_residual;
    const Eigen::Index kept = std::min(matrix.rows(), n + 1);
    const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(matrix);  // in place
    for (Eigen::Index i = 0; i < kept; ++i) {
      r[i] = i <= n ? matrix(i, n) : 0;
      for (Eigen::Index j = i; j < n; ++j) jacobian[(first_row(k) + std::size_t(i)) * std::size_t(n) + std::size_t(j)] = matrix(i, j);
    }
  }
  return true;
}

std::vector<double> ModelResiduals::squares(const double* p) const {
  std::vector<double> out;
  Rows rows;
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    if (!fill(k, p, false, rows)) return {};
    out.push_back(rows.residual().squaredNorm());
  }
  return out;
}

std::vector<ModelResiduals::Whitening> ModelResiduals::whitening_at(const double* p) const {
  std::vector<Whitening> out(observations_.slips.size());
  const bool breaks_away = std::any_of(slips_.begin(), slips_.end(),
                                       [this](std::size_t s) { return observations_.slips[s].from_stick; });
  if (!breaks_away) return out;
  // delta_i of each slip by least squares, and what noise is left once it is taken out.
  std::vector<double> deltas;
  double left = 0, freedom = 0;
  Rows rows;
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    if (!fill(k, p, true, rows)) return std::vector<Whitening>(observations_.slips.size());
    Eigen::VectorXd& g = out[slips_[k]].g;
    g = rows.jacobian_and_residual.col(0);
    const double norm = g.squaredNorm();
    if (!(norm > 0)) continue;
    const double projection = g.dot(rows.residual());
    deltas.push_back(projection / norm);
    left += rows.residual().squaredNorm() - projection * projection / norm;
    freedom += static_cast<double>(g.size()) - 1;
  }
  double mean = 0, scatter = 0;
  for (const double delta : deltas) mean += delta / static_cast<double>(deltas.size());
  for (const double delta : deltas) scatter += (delta - mean) * (delta - mean) / static_cast<double>(deltas.size());
  const double noise = freedom > 0 ? left / freedom : 0;
  for (const std::size_t s : slips_) {
    const double norm = out[s].g.squaredNorm();
    if (norm > 0 && noise > 0) out[s].part = 1 - 1 / std::sqrt(1 + scatter * norm / noise);
  }
  return out;
}

}  // namespace tribofit
