#include "stick.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tribofit/friction/creep.hpp"
#include "tribofit/segmentation/stick_motion.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

namespace {

/// v_r [m/s] that a model predicts for parts of sticks of one record.
class Prediction {
 public:
  Prediction(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
             const Segmentation& segmentation)
      : model_(model),
        p_(p),
        segmentation_(segmentation),
        disc_speed_(motion.conditions.speed.known() ? motion.conditions.speed.value : 0) {}

  double operator()(const StickCreep& stick, const StickPart& part) const {
    const Cycle& cycle = segmentation_.cycles[stick.cycle];
    Slip slip;
    slip.stick_time = cycle.stick_time;
    slip.direction = cycle.direction;
    return creep_in_stick(model_, p_.data(), slip, StickMoment{part.friction, part.friction_rate, disc_speed_});
  }

 private:
  const FrictionModel& model_;
  const std::vector<double>& p_;
  const Segmentation& segmentation_;
  double disc_speed_;
};

}  // namespace

double stick_creep_rmse(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
                        const Segmentation& segmentation) {
  const Prediction predict(model, p, motion, segmentation);
  const double at_rest = friction_at_rest(model.law(), p);
  double squares = 0, count = 0;
  for (const StickCreep& stick : stick_motion(motion, segmentation)) {
    for (const StickPart& part : stick.parts) {
      const double predicted = predict(stick, part);
      if (part.friction >= at_rest || !std::isfinite(predicted)) continue;
      squares += std::pow(part.relative_velocity - predicted, 2);
      count += 1;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

Estimate gap_beside_creep(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
                          const Segmentation& segmentation) {
  const Prediction predict(model, p, motion, segmentation);
  std::vector<double> gaps;
  double sum = 0, creeps = 0;
  for (const StickCreep& stick : stick_motion(motion, segmentation)) {
    double gap = 0, creep = 0, disc = 0;
    for (std::size_t k = creep_law(model).first_part; k < stick.parts.size(); ++k) {
      const double predicted = predict(stick, stick.parts[k]);
      gap += stick.parts[k].relative_velocity - predicted;
      creep += predicted;
      disc += stick.parts[k].disc_velocity;
    }
    if (!(disc > 0)) continue;
    gaps.push_back(gap / disc);
    sum += gap / disc;
    creeps += creep / disc;
  }
  Estimate out;
  out.value = std::numeric_limits<double>::quiet_NaN();
  if (gaps.empty()) return out;
  const auto n = static_cast<double>(gaps.size());
  const MeanError error = standard_error_of_mean(gaps);
  const double allowed = creep_law(model).inaccuracy * std::abs(creeps) / n;
  out.value = std::copysign(std::max(0.0, std::abs(sum / n) - allowed), sum);
  out.std_error = error.std_error;
  out.degrees_of_freedom = error.degrees_of_freedom;
  return out;
}

}  // namespace tribofit
