#include "tribofit/study/uncertainty.hpp"
#include "limits.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// A square root of a covariance, which need not have full rank.
Eigen::MatrixXd root_of(const std::vector<double>& covariance, std::size_t count) {
  const auto n = static_cast<Eigen::Index>(count);
  if (covariance.empty()) return Eigen::MatrixXd::Zero(n, n);
  if (covariance.size() != count * count) throw std::invalid_argument("draws_of: wrong size of a covariance");
  const Eigen::MatrixXd full = Eigen::Map<const Eigen::MatrixXd>(covariance.data(), n, n);
  // Parameters differ by powers of ten: scaled to a correlation first.
  const Eigen::VectorXd scale =
      full.diagonal().cwiseMax(0).cwiseSqrt().unaryExpr([](double s) { return s > 0 ? s : 1; });
  const Eigen::MatrixXd correlation = scale.cwiseInverse().asDiagonal() * full * scale.cwiseInverse().asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(0.5 * (correlation + correlation.transpose()));
  return scale.asDiagonal() * eigen.vectors * eigen.values.cwiseMax(0).cwiseSqrt().asDiagonal();
}

bool can_be(const Machine& m) {
  const auto law = std::span(m.parameters).first(m.model.base_count());
  return m.rig.mass > 0 && m.rig.stiffness > 0 && m.rig.damping >= 0 && is_possible(m.model.law(), law);
}

}  // namespace

std::vector<Machine> draws_of(const Machine& machine, const MachineCovariance& covariance, std::size_t count,
                              std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  boost::random::normal_distribution<double> normal;
  const Eigen::MatrixXd friction = root_of(covariance.friction, machine.parameters.size());
  const Eigen::MatrixXd rig = root_of(covariance.rig, 3);
  const auto draw = [&](const Eigen::MatrixXd& root) {
    Eigen::VectorXd z(root.cols());
    for (double& x : z) x = normal(engine);
    return Eigen::VectorXd(root * z);
  };
  std::vector<Machine> out;
  for (std::size_t tries = 0; out.size() < count && tries < kMostTries * count; ++tries) {
    Machine drawn = machine;
    const Eigen::VectorXd change = draw(friction), of_rig = draw(rig);
    for (std::size_t k = 0; k < drawn.parameters.size(); ++k) {
      drawn.parameters[k] += change[static_cast<Eigen::Index>(k)];
      const Parameter& q = drawn.model.parameters()[k].parameter;
      if (!drawn.model.parameters()[k].effect.empty()) {
        drawn.parameters[k] = std::clamp(drawn.parameters[k], q.lower * q.si, q.upper * q.si);
      }
    }
    drawn.rig.mass += of_rig[0];
    drawn.rig.damping += of_rig[1];
    drawn.rig.stiffness += of_rig[2];
    if (can_be(drawn)) out.push_back(std::move(drawn));
  }
  return out;
}

Interval interval95_of(std::vector<double> values) {
  const std::size_t all = values.size();
  std::erase_if(values, [](double x) { return std::isnan(x); });
  const double missing = static_cast<double>(all - values.size());
  if (values.empty() || missing > kMostMissing * static_cast<double>(all)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan};
  }
  std::sort(values.begin(), values.end());
  return {quantile_of_sorted(values, 0.025), quantile_of_sorted(values, 0.975)};
}

}  // namespace tribofit
