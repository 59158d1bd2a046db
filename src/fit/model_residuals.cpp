#include "model_residuals.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribofit/friction/evaluate.hpp"

namespace tribofit {

namespace {

/// Derivatives taken in one pass over the slips.
constexpr int kStride = 4;
using Dual = ceres::Jet<double, kStride>;

/// sign(r) sqrt(rho(r^2)) for a residual of weight w (a mean of w samples) and the width s of a single sample.
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
    : model_(model), observations_(observations), slips_(std::move(slips)), options_(options) {
  for (const std::size_t s : slips_) {
    const auto& range = observations_.slips[s];
    rows_.push_back({count_, count_ + range.end - range.begin});
    count_ = rows_.back().end;
  }
  const std::size_t breaks = static_cast<std::size_t>(std::count_if(
      slips_.begin(), slips_.end(), [&](std::size_t s) { return observations_.slips[s].from_stick; }));
  std::size_t next = count_;
  count_ += breaks;
  for (const std::size_t s : slips_) break_away_rows_.push_back(observations_.slips[s].from_stick ? next++ : count_);
}

ModelResiduals::ModelResiduals(const FrictionModel& model, const Observations& observations,
                               std::vector<std::size_t> slips)
    : ModelResiduals(model, observations, std::move(slips), Options()) {}

/// Calls write(row, residual) for every row; false where the model is not finite.
template <class T, class Write>
bool ModelResiduals::run(const T* p, Write&& write) const {
  std::vector<T> velocity, mu;
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    const auto& range = observations_.slips[slips_[k]];
    const Slip slip = observations_.slip(range);
    velocity.resize(slip.size());
    std::transform(slip.velocity.begin(), slip.velocity.end(), velocity.begin(), [](double v) { return T(v); });
    mu.resize(slip.size());
    tribofit::evaluate<T>(model_, p, slip, velocity, mu);
    for (std::size_t i = 0; i < slip.size(); ++i) {
      const double root_weight = std::sqrt(observations_.weight[range.begin + i]);
      const T r = root_weight * (observations_.friction[range.begin + i] - mu[i]);
      if (!std::isfinite(scalar_part(r))) return false;
      write(rows_[k].begin + i, bend(r, options_, root_weight));
    }
    if (range.from_stick) {
      const T r = range.break_away_friction - break_away_level(model_, p, slip);
      if (!std::isfinite(scalar_part(r))) return false;
      write(break_away_rows_[k], bend(r, options_, 1.0));
    }
  }
  return true;
}

bool ModelResiduals::evaluate(const double* p, double* residual, double* jacobian) const {
  if (jacobian == nullptr) {
    if (!run<double>(p, [&](std::size_t row, double r) { residual[row] = r; })) return false;
    apply_whitening(residual, nullptr);
    return true;
  }
  const std::size_t n = parameter_count();
  std::vector<Dual> dual(n);
  for (std::size_t first = 0; first < n; first += kStride) {
    const std::size_t last = std::min(n, first + kStride);
    for (std::size_t k = 0; k < n; ++k) {
      dual[k] = k >= first && k < last ? Dual(p[k], static_cast<int>(k - first)) : Dual(p[k]);
    }
    const bool finite = run<Dual>(dual.data(), [&](std::size_t row, const Dual& r) {
      residual[row] = r.a;
      for (std::size_t k = first; k < last; ++k) jacobian[row * n + k] = r.v[static_cast<Eigen::Index>(k - first)];
    });
    if (!finite) return false;
  }
  apply_whitening(residual, jacobian);
  return true;
}

void ModelResiduals::apply_whitening(double* residual, double* jacobian) const {
  if (whitening_ == nullptr) return;
  const std::size_t n = parameter_count();
  std::vector<double> projected(n + 1);
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    const Whitening& w = (*whitening_)[slips_[k]];
    if (w.part <= 0) continue;
    const auto each_row = [&](auto&& visit) {
      for (std::size_t i = 0; i < rows_[k].size(); ++i) visit(rows_[k].begin + i, w.g[i]);
      if (break_away_rows_[k] < count_) visit(break_away_rows_[k], w.g.back());
    };
    double norm = 0;
    std::fill(projected.begin(), projected.end(), 0.0);
    each_row([&](std::size_t row, double g) {
      norm += g * g;
      projected[n] += g * residual[row];
      for (std::size_t j = 0; jacobian != nullptr && j < n; ++j) projected[j] += g * jacobian[row * n + j];
    });
    for (double& x : projected) x *= w.part / norm;
    each_row([&](std::size_t row, double g) {
      residual[row] -= g * projected[n];
      for (std::size_t j = 0; jacobian != nullptr && j < n; ++j) jacobian[row * n + j] -= g * projected[j];
    });
  }
}

std::vector<ModelResiduals::Whitening> ModelResiduals::whitening_at(const double* p) const {
  const std::size_t n = parameter_count();
  std::vector<double> residual(count_), jacobian(count_ * n);
  std::vector<Whitening> out(observations_.slips.size());
  const bool breaks_away = std::any_of(break_away_rows_.begin(), break_away_rows_.end(),
                                       [this](std::size_t row) { return row < count_; });
  if (!breaks_away) return out;
  if (!evaluate(p, residual.data(), jacobian.data())) return out;
  // delta_i of each slip by least squares, and what noise is left once it is taken out.
  std::vector<double> deltas, norms(slips_.size(), 0.0);
  double left = 0, rows = 0;
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    Whitening& w = out[slips_[k]];
    double projection = 0, squares = 0;
    const auto add = [&](std::size_t row) {
      const double g = jacobian[row * n];
      w.g.push_back(g);
      norms[k] += g * g;
      projection += g * residual[row];
      squares += residual[row] * residual[row];
    };
    for (std::size_t row = rows_[k].begin; row < rows_[k].end; ++row) add(row);
    if (break_away_rows_[k] < count_) add(break_away_rows_[k]);
    if (!(norms[k] > 0)) continue;
    deltas.push_back(projection / norms[k]);
    left += squares - projection * projection / norms[k];
    rows += static_cast<double>(w.g.size()) - 1;
  }
  double mean = 0, scatter = 0;
  for (const double delta : deltas) mean += delta / static_cast<double>(deltas.size());
  for (const double delta : deltas) scatter += (delta - mean) * (delta - mean) / static_cast<double>(deltas.size());
  const double noise = rows > 0 ? left / rows : 0;
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    if (norms[k] > 0 && noise > 0) out[slips_[k]].part = 1 - 1 / std::sqrt(1 + scatter * norms[k] / noise);
  }
  return out;
}

}  // namespace tribofit
