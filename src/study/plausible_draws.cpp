#include "plausible_draws.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "fit/model_residuals.hpp"
#include "limits.hpp"
#include "tribofit/fit/observations.hpp"
#include "tribofit/study/uncertainty.hpp"

namespace tribofit {

/// Whitened squares of the record about the minimum.
struct PlausibleDraws::Squares {
  Observations observations;
  ModelResiduals::Whitening whitening;
  Eigen::MatrixXd curvature;
  double least = 0;     ///< at the minimum
  double expected = 0;  ///< by which those of a draw rise on average, by its covariance

  ModelResiduals residuals(const FrictionModel& model) const {
    ModelResiduals out(model, observations, all_slips(observations));
    out.whiten(whitening);
    return out;
  }

  /// NaN where the model is not finite.
  double at(const FrictionModel& model, const std::vector<double>& p) const {
    return residuals(model).white_squares(p.data());
  }
};

PlausibleDraws::PlausibleDraws(const IdentifiedMachine& known, const Record& record) : known_(known) {
  const Machine& machine = known_.machine;
  const auto n = static_cast<Eigen::Index>(machine.parameters.size());
  if (known_.covariance.friction.size() != machine.parameters.size() * machine.parameters.size()) return;
  auto squares = std::make_shared<Squares>();
  squares->observations = observe(*record.motion, *record.segmentation, machine.model.needs(), kValuesOfPlausible);
  const ModelResiduals plain(machine.model, squares->observations, all_slips(squares->observations));
  squares->whitening = plain.whitening_at(machine.parameters.data());
  squares->curvature = Eigen::MatrixXd::Zero(n, n);
  for (const Eigen::MatrixXd& rows : squares->residuals(machine.model).white_rows(machine.parameters.data())) {
    squares->curvature += rows.leftCols(n).transpose() * rows.leftCols(n);
  }
  squares->least = squares->at(machine.model, machine.parameters);
  const Eigen::Map<const Eigen::MatrixXd> covariance(known_.covariance.friction.data(), n, n);
  squares->expected = (squares->curvature * covariance).trace();
  if (std::isfinite(squares->least) && squares->expected > 0) squares_ = std::move(squares);
}

Machine PlausibleDraws::draw(std::uint64_t seed) const {
  const std::vector<Machine> drawn = draws_of(known_.machine, known_.covariance, 1, seed);
  if (drawn.empty()) return known_.machine;
  Machine machine = drawn.front();
  if (!squares_) return machine;
  const std::vector<double>& least = known_.machine.parameters;
  Eigen::VectorXd change(static_cast<Eigen::Index>(least.size()));
  for (std::size_t k = 0; k < least.size(); ++k)
    change[static_cast<Eigen::Index>(k)] = machine.parameters[k] - least[k];
  for (int tries = 0; tries < kMostShortenings; ++tries) {
    const double promised = change.dot(squares_->curvature * change);
    const double risen = squares_->at(machine.model, machine.parameters) - squares_->least;
    if (risen <= kRiseOverPromised * (promised + squares_->expected)) return machine;  // NaN: shorter, too
    change *= kShortened;
    for (std::size_t k = 0; k < least.size(); ++k)
      machine.parameters[k] = least[k] + change[static_cast<Eigen::Index>(k)];
  }
  machine.parameters = least;
  return machine;
}

}  // namespace tribofit
