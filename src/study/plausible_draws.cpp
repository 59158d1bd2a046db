#include <Eigen/Dense>
#include <boost/random/normal_distribution.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "fit/errors.hpp"
#include "fit/model_residuals.hpp"
#include "fit/starts.hpp"
#include "limits.hpp"
#include "open_question.hpp"
#include "statistics/ensemble_sampler.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/fit/observations.hpp"
#include "tribofit/study/identified.hpp"

namespace tribofit {

namespace {

/// Parameters that are free, in the coordinates in which they are drawn: positive ones by their logarithm.
class Coordinates {
 public:
  Coordinates(const FrictionModel& model, const Observations& observations, const std::vector<double>& least)
      : least_(least) {
    const Bounds bounds = bounds_of(model, observations);
    for (std::size_t k = 0; k < least.size(); ++k) {
      const double lower = std::min(bounds.lower[k], least[k]), upper = std::max(bounds.upper[k], least[k]);
      if (lower < upper) free_.push_back({k, lower, upper, lower > 0});
    }
  }

  std::size_t size() const { return free_.size(); }

  std::vector<double> at_least() const {
    std::vector<double> x;
    for (const Free& f : free_) x.push_back(f.is_scale ? std::log(least_[f.index]) : least_[f.index]);
    return x;
  }

  /// Empty outside the bounds.
  std::vector<double> parameters(const std::vector<double>& x) const {
    std::vector<double> p = least_;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const Free& f = free_[k];
      p[f.index] = f.is_scale ? std::exp(x[k]) : x[k];
      if (!(p[f.index] >= f.lower && p[f.index] <= f.upper)) return {};
    }
    return p;
  }

  /// Curvature by these coordinates, of that by the parameters.
  Eigen::MatrixXd curvature(const Eigen::MatrixXd& by_parameters) const {
    std::vector<Eigen::Index> indices;
    Eigen::VectorXd step(static_cast<Eigen::Index>(free_.size()));
    for (const Free& f : free_) {
      step[static_cast<Eigen::Index>(indices.size())] = f.is_scale ? least_[f.index] : 1.0;
      indices.push_back(static_cast<Eigen::Index>(f.index));
    }
    return (step * step.transpose()).cwiseProduct(by_parameters(indices, indices));
  }

 private:
  struct Free {
    std::size_t index;
    double lower, upper;
    bool is_scale;
  };
  std::vector<double> least_;
  std::vector<Free> free_;
};

/// Walkers about the minimum, as its curvature allows; those that would leave the bounds, or climb far, nearer to it.
std::vector<std::vector<double>> walkers_about(const std::vector<double>& least, const Eigen::MatrixXd& information,
                                               const LogDensity& density) {
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const SymmetricEigen eigen = symmetric_eigen(scale.asDiagonal() * information * scale.asDiagonal());
  const Eigen::VectorXd spread = eigen.values.cwiseMax(kFlattestStart).cwiseSqrt().cwiseInverse();
  std::mt19937_64 engine(1);
  boost::random::normal_distribution<double> normal;
  const double top = density(least);
  std::vector<std::vector<double>> walkers;
  for (std::size_t w = 0; w < 2 * (least.size() + 1); ++w) {
    Eigen::VectorXd step(scale.size());
    for (double& x : step) x = normal(engine);
    step = scale.asDiagonal() * (eigen.vectors * spread.asDiagonal() * step);
    std::vector<double> walker(least.size());
    do {
      for (std::size_t k = 0; k < walker.size(); ++k) walker[k] = least[k] + step[static_cast<Eigen::Index>(k)];
      step *= -0.5;
    } while (!(density(walker) > top - kFarthestStart) && step.norm() > 0);
    walkers.push_back(std::move(walker));
  }
  return walkers;
}

}  // namespace

PlausibleDraws::PlausibleDraws(const IdentifiedMachine& known, const Record& record, const Fit& fit) : known_(known) {
  const Machine& machine = known_.machine;
  const std::vector<double>& least = machine.parameters;
  const std::size_t slips = std::max<std::size_t>(1, record.segmentation->cycles.size());
  Observations observations = observe(*record.motion, *record.segmentation, machine.model.needs(),
                                      std::clamp(kValuesOfPlausible / slips, kFewestOfSlip, kSamplesOfSlip));
  refer_to_conditions_of(fit, observations);
  const Coordinates coordinates(machine.model, observations, least);
  ModelResiduals residuals(machine.model, observations, all_slips(observations));
  const ModelResiduals::Whitening whitening = residuals.whitening_at(least.data());
  residuals.whiten(whitening);
  const double squares = residuals.white_squares(least.data());
  const double freedom = static_cast<double>(observations.size()) - static_cast<double>(least.size());
  if (!(squares > 0 && std::isfinite(squares) && freedom > 0) || coordinates.size() == 0) return;
  const double unit = 2 * kTemper * squares / freedom;
  const LogDensity density = [&](const std::vector<double>& x) {
    const std::vector<double> p = coordinates.parameters(x);
    return p.empty() ? -std::numeric_limits<double>::infinity() : -residuals.white_squares(p.data()) / unit;
  };
  const auto n = static_cast<Eigen::Index>(least.size());
  Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(n, n);
  for (const Eigen::MatrixXd& rows : residuals.white_rows(least.data())) {
    curvature += rows.leftCols(n).transpose() * rows.leftCols(n);
  }
  auto drawn = sample_ensemble(
      density, walkers_about(coordinates.at_least(), coordinates.curvature(curvature) * (2 / unit), density),
      kRoundsToForget, kRoundsOfDraws, 1);
  for (std::vector<double>& x : drawn) x = coordinates.parameters(x);
  std::erase_if(drawn, [](const std::vector<double>& p) { return p.empty(); });
  if (!drawn.empty()) parameters_ = std::make_shared<const std::vector<std::vector<double>>>(std::move(drawn));
}

Machine PlausibleDraws::draw(std::uint64_t seed) const {
  const std::vector<Machine> by_covariance = draws_of(known_.machine, known_.covariance, 1, seed);
  Machine machine = by_covariance.empty() ? known_.machine : by_covariance.front();
  if (!parameters_) return machine;
  std::mt19937_64 engine(seed);
  machine.parameters = (*parameters_)[engine() % parameters_->size()];
  return machine;
}

}  // namespace tribofit
