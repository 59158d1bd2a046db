#include "points.hpp"

#include <algorithm>
#include <cmath>

#include "limits.hpp"

namespace tribofit {

bool are_points(std::span<const Record> records) {
  return std::all_of(records.begin(), records.end(), [](const Record& record) { return record.motion->is_points(); });
}

void weigh_points(const Motion& motion, Observations& out) {
  if (!motion.is_points() || motion.friction_std_error.empty()) return;
  double sum = 0;
  for (const auto& point : out.slips) {
    out.weight[point.begin] = 1 / std::pow(motion.friction_std_error[point.samples.begin], 2);
    sum += out.weight[point.begin];
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out.weight[i] *= static_cast<double>(out.size()) / sum;
    out.root_weight[i] = std::sqrt(out.weight[i]);
  }
}

namespace {

/// Sum of squares of what points differ by from the line through their neighbours, each over what unit noise would
/// make of it. part: of the way from the point before to the point after.
class NeighbourDifferences {
 public:
  void add(double before, double here, double after, double part) {
    const double difference = here - (1 - part) * before - part * after;
    squares_ += difference * difference / (1 + part * part + (1 - part) * (1 - part));
    count_ += 1;
  }
  double variance() const { return count_ > 0 ? squares_ / count_ : 0; }

 private:
  double squares_ = 0, count_ = 0;
};

}  // namespace

SensorNoise noise_of_points(const Motion& motion, const Segmentation& segmentation) {
  if (!motion.friction_std_error.empty()) {
    double sum = 0;
    for (const double error : motion.friction_std_error) sum += 1 / (error * error);
    return {std::sqrt(static_cast<double>(motion.size()) / sum), 0, "standard errors"};
  }
  const std::vector<double>&v = motion.relative_velocity, &mu = motion.friction;
  NeighbourDifferences over_speed, over_order;
  for (const Cycle& cycle : segmentation.cycles) {
    for (std::size_t i = cycle.slip.begin + 1; i + 1 < cycle.slip.end; ++i) {
      const double width = v[i + 1] - v[i - 1];
      over_speed.add(mu[i - 1], mu[i], mu[i + 1], width > 0 ? (v[i] - v[i - 1]) / width : 0.5);
      over_order.add(mu[i - 1], mu[i], mu[i + 1], 0.5);
    }
  }
  return {std::sqrt(std::min(over_speed.variance(), over_order.variance())), 0, "neighbours"};
}

namespace {

/// Of each parameter: sums over the points of what they do to it, from which the degrees of freedom follow.
class FreedomOfVariances {
 public:
  explicit FreedomOfVariances(const Eigen::MatrixXd& inverse)
      : inverse_(inverse),
        reach_(Eigen::VectorXd::Zero(inverse.rows())),
        own_(reach_),
        weighed_(static_cast<std::size_t>(inverse.rows()), Eigen::MatrixXd::Zero(inverse.rows(), inverse.rows())) {}

  /// left: one less the leverage of the point.
  void add(const Eigen::MatrixXd& curvature, double left) {
    const Eigen::VectorXd reach = (inverse_ * curvature * inverse_).diagonal();
    reach_ += reach;
    own_ += (reach / left).cwiseAbs2() * (2 * left - 1);
    for (Eigen::Index k = 0; k < reach.size(); ++k)
      weighed_[static_cast<std::size_t>(k)] += reach(k) / left * curvature;
  }

  double of(Eigen::Index k) const {
    const Eigen::MatrixXd through = inverse_ * weighed_[static_cast<std::size_t>(k)];
    const double squared = own_(k) + (through * through).trace();
    return squared > 0 ? reach_(k) * reach_(k) / squared : 0;
  }

 private:
  const Eigen::MatrixXd& inverse_;
  Eigen::VectorXd reach_, own_;
  std::vector<Eigen::MatrixXd> weighed_;
};

}  // namespace

Spread spread_of_points(const CycleEvidence& evidence, double squares, const std::vector<bool>& free) {
  const auto count = static_cast<double>(evidence.curvature.size());
  const double most = std::max(1.0, count - static_cast<double>(std::count(free.begin(), free.end(), true)));
  const Eigen::MatrixXd inverse = inverse_over(evidence.total, free);
  Eigen::MatrixXd robust = Eigen::MatrixXd::Zero(inverse.rows(), inverse.rows());
  FreedomOfVariances freedom(inverse);
  for (std::size_t c = 0; c < evidence.curvature.size(); ++c) {
    const double left = std::max(kLeastWeight, 1 - (inverse * evidence.curvature[c]).trace());
    const Eigen::VectorXd pull = inverse * evidence.gradient[c];
    robust += pull * pull.transpose() / left;
    freedom.add(evidence.curvature[c], left);
  }
  Spread spread;
  spread.covariance = squares / most * inverse;
  spread.degrees_of_freedom = Eigen::VectorXd::Constant(inverse.rows(), most);
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(inverse.rows());
  for (Eigen::Index k = 0; k < inverse.rows(); ++k) {
    if (freedom.of(k) < kFewestFreeVariances || !(spread.covariance(k, k) > 0)) continue;
    scale(k) = std::sqrt(robust(k, k) / spread.covariance(k, k));
    spread.degrees_of_freedom(k) = std::min(most, freedom.of(k));
  }
  spread.covariance = scale.asDiagonal() * spread.covariance * scale.asDiagonal();
  spread.std_error = spread.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  return spread;
}

}  // namespace tribofit
