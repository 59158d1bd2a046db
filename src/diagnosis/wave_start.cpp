#include "wave_start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tribofit::diagnosis {

std::vector<double> with_amplitude_and_phase(const ModelResiduals& residuals, const FrictionModel& model,
                                             const EffectInfo& effect, const Bounds& bounds,
                                             std::vector<double> start) {
  const auto& parameters = effect.parameters;
  const auto is_phase = [](const Parameter& q) { return q.periodic; };
  if (std::count_if(parameters.begin(), parameters.end(), is_phase) != 1 || parameters[0].neutral != 0) return start;
  if (model.count_of(effect.key) != parameters.size()) return start;  // phases of several records
  const std::size_t amplitude = model.offset_of(effect.key);
  const auto found = std::find_if(parameters.begin(), parameters.end(), is_phase);
  const std::size_t phase = amplitude + static_cast<std::size_t>(found - parameters.begin());
  Linearised linear;
  linear.rows = residuals.white_rows(start.data());
  if (!linear.finite() || !(start[amplitude] > 0)) return start;
  linear.free.assign(start.size(), true);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    linear.free[amplitude + k] = amplitude + k == amplitude || amplitude + k == phase;
  }
  const Eigen::VectorXd step = gauss_newton_step(linear);
  const double along = start[amplitude] + step[static_cast<Eigen::Index>(amplitude)];
  const double across = start[amplitude] * step[static_cast<Eigen::Index>(phase)];
  std::vector<double> better = start;
  better[amplitude] = std::clamp(std::hypot(along, across), bounds.lower[amplitude], bounds.upper[amplitude]);
  better[phase] = std::remainder(start[phase] + std::atan2(across, along), 2 * std::numbers::pi);
  return residuals.white_squares(better.data()) < residuals.white_squares(start.data()) ? better : start;
}

}  // namespace tribofit::diagnosis
