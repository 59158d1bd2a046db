#include "systematic.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <optional>

#include "influence.hpp"

namespace tribofit {

namespace {

/// A source of systematic error: how one standard deviation changes the observations.
struct Shift {
  std::vector<double> velocity, friction;  ///< one per value; empty: no change
  std::vector<double> break_away;          ///< one per slip; empty: no change
};

double uncertainty(const std::optional<Declared>& declared) {
  return declared ? declared->uncertainty : 0;
}

/// Displacement of the block from its mean [m] at every value: what an uncertain high-pass corner multiplies.
std::vector<double> displacement(const Motion& motion, const Observations& observations) {
  const std::size_t n = motion.size();
  double mean = 0;
  std::vector<double> block(n);
  for (std::size_t i = 0; i < n; ++i) {
    block[i] = motion.disc_velocity_at(i) - motion.relative_velocity[i];
    mean += block[i];
  }
  mean /= static_cast<double>(n);
  std::vector<double> at_values;
  double x = 0;
  std::size_t i = 0;
  for (const auto& slip : observations.slips) {
    for (std::size_t begin = slip.samples.begin; begin < slip.samples.end; begin += observations.samples_per_value) {
      for (; i <= begin; ++i) x += (block[i] - mean) * motion.step;
      at_values.push_back(x);
    }
  }
  return at_values;
}

std::vector<Shift> shifts_of(const Motion& motion, const Observations& observations, const Instruments& instruments) {
  const auto values = [&](auto&& change) {
    std::vector<double> out(observations.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = change(i);
    return out;
  };
  const auto breaks = [&](auto&& change) {
    std::vector<double> out;
    for (const auto& slip : observations.slips) {
      out.push_back(change(slip.break_away_friction * slip.direction) * slip.direction);
    }
    return out;
  };
  const auto block_velocity = [&](std::size_t i) { return motion.constant_disc_velocity - observations.velocity[i]; };
  const auto& rig = instruments.rig;
  const auto& vibrometer = instruments.vibrometer;
  const auto& sensor = instruments.force_sensor;
  std::vector<Shift> shifts;
  const bool plateau = motion.conditions.speed.source == "plateau";
  if (const double u = uncertainty(rig.radius); u > 0 && !plateau && motion.conditions.speed.known()) {
    shifts.push_back({values([&](std::size_t) { return u * motion.conditions.speed.value; }), {}, {}});
  }
  if (const double u = uncertainty(rig.speed); u > 0 && motion.conditions.radius.known()) {
    shifts.push_back({values([&](std::size_t) { return u * motion.conditions.radius.value; }), {}, {}});
  }
  if (const double u = uncertainty(vibrometer.gain); u > 0) {
    shifts.push_back({values([&](std::size_t i) { return u / vibrometer.gain->value * block_velocity(i); }), {}, {}});
  }
  const double corner = vibrometer.high_pass ? uncertainty(vibrometer.high_pass) : motion.high_pass_std_error;
  if (corner > 0) {
    const std::vector<double> x = displacement(motion, observations);
    shifts.push_back({values([&](std::size_t i) { return -2 * std::numbers::pi * corner * x[i]; }), {}, {}});
  }
  if (const double u = uncertainty(vibrometer.delay); u > 0 && observations.size() > 1) {
    shifts.push_back({values([&](std::size_t i) {
                        const std::size_t j = i + 1 < observations.size() ? i : i - 1;
                        const double dt = observations.time[j + 1] - observations.time[j];
                        return u * (observations.velocity[j + 1] - observations.velocity[j]) / dt;
                      }),
                      {},
                      {}});
  }
  if (const double u = uncertainty(sensor.zero); u > 0) {
    shifts.push_back({{}, values([&](std::size_t) { return -u; }), breaks([&](double) { return -u; })});
  }
  const auto scale_friction = [&](double part) {
    shifts.push_back({{},
                      values([&](std::size_t i) { return -part * observations.friction[i]; }),
                      breaks([&](double level) { return -part * level; })});
  };
  if (const double u = uncertainty(sensor.gain); u > 0) scale_friction(u / sensor.gain->value);
  if (const double u = uncertainty(rig.load); u > 0 && !sensor.load_measured) scale_friction(u / rig.load->value);
  if (const double u = uncertainty(sensor.crosstalk); u > 0) {
    shifts.push_back({{}, values([&](std::size_t) { return -u; }), breaks([&](double) { return -u; })});
  }
  if (const double u = uncertainty(sensor.mass_below); u > 0 && motion.conditions.load.known()) {
    Channels acceleration;
    acceleration.acceleration = true;
    const double scale = u / motion.conditions.load.value;
    std::vector<double> change;
    std::size_t i = 0;
    const std::vector<double> full = block_acceleration(motion);
    for (const auto& slip : observations.slips) {
      for (std::size_t s = slip.samples.begin; s < slip.samples.end; s += observations.samples_per_value, ++i) {
        change.push_back(scale * full[s]);
      }
    }
    shifts.push_back({{}, std::move(change), {}});
  }
  return shifts;
}

/// The observations as they would be with the shift.
Observations moved(const Observations& observations, const Shift& shift) {
  Observations out = observations;
  for (std::size_t i = 0; i < shift.velocity.size(); ++i) out.velocity[i] += shift.velocity[i];
  for (std::size_t i = 0; i < shift.friction.size(); ++i) out.friction[i] += shift.friction[i];
  for (std::size_t k = 0; k < shift.break_away.size(); ++k) out.slips[k].break_away_friction += shift.break_away[k];
  return out;
}

}  // namespace

std::vector<double> systematic_errors(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
                                      const Observations& observations, const Instruments& instruments,
                                      const std::vector<bool>& free) {
  std::vector<double> squares(p.size(), 0.0);
  const std::vector<Shift> shifts = shifts_of(motion, observations, instruments);
  if (shifts.empty()) return squares;
  std::vector<std::size_t> all(observations.slips.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  const auto gradient = [&](const Observations& at, Eigen::MatrixXd* curvature) {
    const NormalEquations equations = normal_equations(ModelResiduals(model, at, all), at, p);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(p.size()));
    for (const Eigen::VectorXd& g : equations.gradient) sum += g;
    if (curvature != nullptr) *curvature = equations.total;
    return sum;
  };
  Eigen::MatrixXd curvature;
  const Eigen::VectorXd base = gradient(observations, &curvature);
  const Eigen::MatrixXd inverse = inverse_over(curvature, free);
  for (const Shift& shift : shifts) {
    const Eigen::VectorXd step = inverse * (gradient(moved(observations, shift), nullptr) - base);
    for (std::size_t k = 0; k < p.size(); ++k) squares[k] += std::pow(step(static_cast<Eigen::Index>(k)), 2);
  }
  for (double& s : squares) s = std::sqrt(s);
  return squares;
}

}  // namespace tribofit
