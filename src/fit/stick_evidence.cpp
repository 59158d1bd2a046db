#include "stick_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "statistics/linear_algebra.hpp"
#include "tribofit/segmentation/stick_motion.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

namespace {

constexpr Eigen::Index kParts = std::tuple_size_v<decltype(StickCreep::parts)>;
/// Differences between neighbouring sticks without which a covariance of the parts means little.
constexpr double kFewestPairs = 3 * kParts;

/// Columns that span what is orthogonal to a constant and, with `ramps`, to a straight line.
Eigen::MatrixXd contrasts(Eigen::Index count, bool ramps) {
  const Eigen::Index nuisances = ramps ? 2 : 1;
  Eigen::MatrixXd nuisance(count, nuisances);
  nuisance.col(0).setOnes();
  if (ramps) nuisance.col(1) = Eigen::VectorXd::LinSpaced(count, -1, 1);
  return orthogonal_complement(nuisance);
}

Eigen::MatrixXd weights_of(const Observations::StickNoise& noise, const CreepLaw& law, double unit) {
  const auto first = static_cast<Eigen::Index>(law.first_part);
  const Eigen::Index count = kParts - first;
  if (noise.covariance.empty() || count < (noise.ramps ? 3 : 2)) return Eigen::MatrixXd(0, count);
  using Square = Eigen::Matrix<double, kParts, kParts, Eigen::RowMajor>;
  Square all = Eigen::Map<const Square>(noise.covariance.data());
  for (Eigen::Index k = 0; k < kParts; ++k) {
    all(k, k) += noise.sticks * std::pow(law.inaccuracy * noise.mean[static_cast<std::size_t>(k)], 2);
  }
  const Eigen::MatrixXd directions = contrasts(count, noise.ramps);
  Eigen::MatrixXd covariance = directions.transpose() * all.bottomRightCorner(count, count) * directions;
  const double size = covariance.trace() / static_cast<double>(covariance.rows());
  if (!(size > 0)) return Eigen::MatrixXd(0, count);
  // A velocity in steps of the converter may not scatter at all in some direction.
  constexpr double kLeast = 1e-3;
  covariance.diagonal().array() += kLeast * size;
  return unit * solve_lower_factor(covariance, directions.transpose());
}

/// Squares that remain of v_r in stick beside a pattern of free size, in units of its noise.
template <class Pattern>
double left_beside(const Observations& observations, const Eigen::MatrixXd& weights, Pattern pattern) {
  double squares = 0, products = 0, norm = 0;
  for (const StickCreep& stick : observations.sticks) {
    Eigen::VectorXd creep(kParts);
    for (Eigen::Index k = 0; k < kParts; ++k) creep(k) = pattern(stick, stick.parts[static_cast<std::size_t>(k)]);
    const Eigen::VectorXd v = weights * stick_velocities(stick, 0), u = weights * creep;
    squares += v.squaredNorm();
    products += u.dot(v);
    norm += u.squaredNorm();
  }
  return products > 0 ? squares - products * products / norm : squares;  // neither lets v_r fall
}

double mean_break_away(const Segmentation& segmentation) {
  double sum = 0, count = 0;
  for (const Cycle& cycle : segmentation.cycles) {
    if (!std::isfinite(cycle.break_away_friction) || !segmentation.is_selected(cycle)) continue;
    sum += cycle.break_away_friction;
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

std::vector<Eigen::MatrixXd> stick_weights(const Observations& observations, const CreepLaw& law) {
  std::vector<Eigen::MatrixXd> weights;
  for (const auto& noise : observations.stick_noise) {
    weights.push_back(weights_of(noise, law, observations.stick_unit));
  }
  return weights;
}

Eigen::VectorXd stick_velocities(const StickCreep& stick, std::size_t first) {
  Eigen::VectorXd v(kParts - static_cast<Eigen::Index>(first));
  for (Eigen::Index k = 0; k < v.size(); ++k) {
    v(k) = stick.parts[first + static_cast<std::size_t>(k)].relative_velocity;
  }
  return v;
}

void add_stick_evidence(const Motion& motion, const Segmentation& segmentation, double unit, Observations& out) {
  out.sticks = stick_motion(motion, segmentation);
  out.stick_unit = unit;
  Observations::StickNoise noise;
  noise.ramps = motion.high_pass > 0;
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(kParts, kParts);
  double pairs = 0;
  for (std::size_t k = 1; k < out.sticks.size(); ++k) {
    if (out.sticks[k].cycle != out.sticks[k - 1].cycle + 1) continue;
    const Eigen::VectorXd step = stick_velocities(out.sticks[k], 0) - stick_velocities(out.sticks[k - 1], 0);
    products += 0.5 * step * step.transpose();
    pairs += 1;
  }
  if (pairs >= kFewestPairs) {
    // Less what as many directions take from a covariance that is known from few pairs.
    products /= pairs - static_cast<double>(kParts) - 1;
    noise.sticks = static_cast<double>(out.sticks.size());
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(kParts);
    for (const StickCreep& stick : out.sticks) sum += stick_velocities(stick, 0);
    for (const double v : sum) noise.mean.push_back(v / noise.sticks);
    noise.covariance.assign(products.data(), products.data() + products.size());
  }
  out.stick_noise = {std::move(noise)};
  std::size_t next = 0;
  for (auto& slip : out.slips) {  // both are in order of time
    while (next < out.sticks.size() && out.sticks[next].cycle < slip.segment) ++next;
    if (next < out.sticks.size() && slip.from_stick && out.sticks[next].cycle == slip.segment) slip.stick = next;
  }
}

bool spins_rather_than_sags(const Motion& motion, const Segmentation& segmentation, double at_least) {
  Observations observations;
  add_stick_evidence(motion, segmentation, 1, observations);
  if (observations.stick_noise[0].covariance.empty()) return false;
  observations.stick_noise[0].ramps = false;
  const Eigen::MatrixXd weights = stick_weights(observations)[0];
  const double level = mean_break_away(segmentation);
  if (weights.rows() == 0 || !(level > 0)) return false;
  const double sag = left_beside(observations, weights, [](const StickCreep& stick, const StickPart& part) {
    return part.disc_velocity * (part.time - stick.parts[0].time);
  });
  // Creep of constant friction is in proportion to the parameter: any value gives the pattern.
  const FrictionModel spin(CoulombLaw{}, {effect_with(&EffectInfo::creeps_like_sag)});
  const double any = spin.parameters().back().parameter.si;
  double best = sag;
  for (const double above : {0.99, 1.0, 1.01, 1.02, 1.03, 1.05}) {  // mu_s of a contact that creeps is not read exactly
    const std::vector<double> p = {above * level, above * level, any};
    best = std::min(best, left_beside(observations, weights, [&](const StickCreep&, const StickPart& part) {
                      return creep_in_stick(spin, p.data(), Slip(), StickMoment{part.friction, part.friction_rate, 1});
                    }));
  }
  return sag - best > at_least;
}

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
  const Estimate error = standard_error_of_mean(gaps);
  const double allowed = creep_law(model).inaccuracy * std::abs(creeps) / n;
  out.value = std::copysign(std::max(0.0, std::abs(sum / n) - allowed), sum);
  out.std_error = error.std_error;
  out.degrees_of_freedom = error.degrees_of_freedom;
  return out;
}

}  // namespace tribofit
