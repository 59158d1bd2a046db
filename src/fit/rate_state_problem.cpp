#include "rate_state_steps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dual.hpp"
#include "oscillator/rate_state_slider.hpp"
#include "tribofit/execution/stop.hpp"

namespace tribofit::fit {

namespace {

template <class T>
RateStateParameters<T> unpacked(const T* p, std::size_t states) {
  using std::exp;
  RateStateParameters<T> out;
  out.a = p[0];
  for (std::size_t i = 0; i < states; ++i) {
    out.b[i] = p[1 + 2 * i];
    out.distance[i] = exp(p[2 + 2 * i]);
  }
  out.stiffness = exp(p[1 + 2 * states]);
  return out;
}

}  // namespace

RateStateParameters<double> parameters_from(const double* p, std::size_t states) {
  return unpacked(p, states);
}

RateStateProblem::RateStateProblem(const RateStateData& data, const RateStateModel& model,
                                   std::vector<std::size_t> steps, std::optional<std::size_t> first)
    : data_(data), model_(model), steps_(std::move(steps)), first_(first) {
  for (const std::size_t s : steps_) {
    first_rows_.push_back(values_.size());
    for (std::size_t i = data.begins[s]; i < data.end_of(s); ++i) values_.push_back(i);
  }
  rows_ = values_.size();
  first_rows_.push_back(rows_);
  for (const std::size_t i : values_) {
    times_.push_back(data.time[i]);
    root_count_.push_back(std::sqrt(data.count[i]));
  }
  const std::size_t before = data.before[first.value_or(steps_.front())];
  phases_.assign(data.phases.begin() + static_cast<std::ptrdiff_t>(before), data.phases.end());
  phases_.front().begin = std::min(phases_.front().begin, times_.front());
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    Eigen::MatrixXd basis = design_of(k);
    for (Eigen::Index i = 0; i < basis.rows(); ++i)
      basis.row(i) *= root_count_[first_rows_[k] + static_cast<std::size_t>(i)];
    for (Eigen::Index c = 0; c < basis.cols(); ++c) {
      for (int again = 0; again < 2; ++again) {
        for (Eigen::Index e = 0; e < c; ++e) basis.col(c) -= basis.col(e).dot(basis.col(c)) * basis.col(e);
      }
      basis.col(c).normalize();
    }
    bases_.push_back(std::move(basis));
  }
}

Eigen::MatrixXd RateStateProblem::design_of(std::size_t k) const {
  const VelocityStep& step = data_.steps[steps_[k]];
  const auto n = static_cast<Eigen::Index>(first_rows_[k + 1] - first_rows_[k]);
  Eigen::MatrixXd out(n, model_.detrend == Detrend::none ? 1 : 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t value = values_[first_rows_[k] + static_cast<std::size_t>(i)];
    out(i, 0) = 1;
    if (model_.detrend == Detrend::time) out(i, 1) = data_.time[value] - step.time;
    if (model_.detrend == Detrend::displacement) out(i, 1) = data_.displacement[value] - step.displacement;
  }
  return out;
}

void RateStateProblem::weigh(RowMatrix& rows) const {
  for (std::size_t i = 0; i < rows_; ++i) rows.row(static_cast<Eigen::Index>(i)) *= root_count_[i];
  for (std::size_t k = 0; k < bases_.size(); ++k) {
    const Eigen::MatrixXd& basis = bases_[k];
    auto block = rows.middleRows(static_cast<Eigen::Index>(first_rows_[k]), basis.rows());
    const Eigen::MatrixXd parts = basis.transpose() * block;
    block -= basis * parts;
  }
}

template <class T, std::size_t kStates>
bool RateStateProblem::simulate(const T* p, T* friction) const {
  return oscillator::slide_under<T, kStates>(model_.evolution, unpacked(p, kStates), data_.reference_speed, phases_,
                                             times_, friction);
}

bool RateStateProblem::response(const double* p, Eigen::VectorXd& friction, RowMatrix* jacobian) const {
  friction.resize(static_cast<Eigen::Index>(rows_));
  const auto without = [&]<std::size_t kStates>() { return simulate<double, kStates>(p, friction.data()); };
  if (jacobian == nullptr)
    return model_.states == 1 ? without.template operator()<1>() : without.template operator()<2>();
  const auto with = [&]<std::size_t kStates>() {
    constexpr std::size_t n = 2 + 2 * kStates;
    using T = Dual<n>;
    std::array<T, n> q;
    for (std::size_t k = 0; k < n; ++k) q[k] = T(p[k], k);
    std::vector<T> values(rows_);
    if (!simulate<T, kStates>(q.data(), values.data())) return false;
    jacobian->resize(static_cast<Eigen::Index>(rows_), static_cast<Eigen::Index>(n));
    for (std::size_t i = 0; i < rows_; ++i) {
      friction(static_cast<Eigen::Index>(i)) = values[i].a;
      for (std::size_t k = 0; k < n; ++k)
        (*jacobian)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = values[i].v[k];
    }
    return true;
  };
  return model_.states == 1 ? with.template operator()<1>() : with.template operator()<2>();
}

bool RateStateProblem::evaluate(const double* p, double* residual, double* jacobian) const {
  Eigen::VectorXd friction;
  RowMatrix derivatives;
  if (!response(p, friction, jacobian != nullptr ? &derivatives : nullptr)) return false;
  RowMatrix rows(static_cast<Eigen::Index>(rows_), 1);
  for (std::size_t i = 0; i < rows_; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    rows(at, 0) = friction(at) - data_.friction[values_[i]];
  }
  weigh(rows);
  if (!rows.allFinite()) return false;
  std::copy(rows.data(), rows.data() + rows_, residual);
  if (jacobian == nullptr) return true;
  weigh(derivatives);
  if (!derivatives.allFinite()) return false;
  std::copy(derivatives.data(), derivatives.data() + derivatives.size(), jacobian);
  return true;
}

}  // namespace tribofit::fit
