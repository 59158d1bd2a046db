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
  double offset = 0, part = 0;             ///< |friction| by offset + part |friction|, break-aways and extremes too
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

/// `delay` times dv_r/dt at every value, slip by slip.
std::vector<double> slopes(const Observations& observations, double delay) {
  std::vector<double> out(observations.size(), 0.0);
  for (const auto& slip : observations.slips) {
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      const std::size_t before = std::max(i, slip.begin + 1) - 1, after = std::min(i + 1, slip.end - 1);
      if (after == before) continue;
      out[i] = delay * (observations.velocity[after] - observations.velocity[before]) /
               (observations.time[after] - observations.time[before]);
    }
  }
  return out;
}

/// What the uncertainties of radius, speed and vibrometer do to v_r.
void add_velocity_shifts(const Motion& motion, const Observations& observations, const Instruments& instruments,
                         std::vector<Shift>& shifts) {
  const auto values = [&](auto&& change) {
    std::vector<double> out(observations.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = change(i);
    return out;
  };
  const auto block_velocity = [&](std::size_t i) { return motion.constant_disc_velocity - observations.velocity[i]; };
  const auto& rig = instruments.rig;
  const auto& vibrometer = instruments.vibrometer;
  const bool plateau = motion.conditions.speed.source == "plateau";
  if (const double u = uncertainty(rig.radius); u > 0 && !plateau && motion.conditions.speed.known()) {
    shifts.push_back({values([&](std::size_t) { return u * motion.conditions.speed.value; }), {}});
  }
  if (const double u = uncertainty(rig.speed); u > 0 && motion.conditions.radius.known()) {
    shifts.push_back({values([&](std::size_t) { return u * motion.conditions.radius.value; }), {}});
  }
  if (const double u = uncertainty(vibrometer.gain); u > 0) {
    // v_b = reading/gain; where omega r was read off the plateau it scales with it, and so does v_r as a whole.
    const double part = u / vibrometer.gain->value;
    shifts.push_back(
        {values([&](std::size_t i) { return plateau ? -part * observations.velocity[i] : part * block_velocity(i); }),
         {}});
  }
  const double corner = vibrometer.high_pass ? uncertainty(vibrometer.high_pass) : motion.high_pass_std_error;
  if (corner > 0) {
    const std::vector<double> x = displacement(motion, observations);
    shifts.push_back({values([&](std::size_t i) { return -2 * std::numbers::pi * corner * x[i]; }), {}});
  }
}

/// What delays between the channels do. Low-passes are corrected as the delay they make at low frequency.
void add_delay_shifts(const Observations& observations, const Instruments& instruments, std::vector<Shift>& shifts) {
  constexpr double kSensorDamping = 0.7;
  const auto low_pass_delay = [](const std::optional<Declared>& corner_frequency, double factor) {
    const double u_f = uncertainty(corner_frequency);
    return u_f > 0 ? factor * u_f / (2 * std::numbers::pi * std::pow(corner_frequency->value, 2)) : 0.0;
  };
  for (const double u : {uncertainty(instruments.vibrometer.delay), low_pass_delay(instruments.vibrometer.low_pass, 1),
                         low_pass_delay(instruments.force_sensor.bandwidth, 2 * kSensorDamping)}) {
    if (u > 0) shifts.push_back({slopes(observations, u), {}});
  }
}

/// Mean over each value of the change of friction by the inertia of a mass below the sensor that is uncertain: `scale`
/// of friction per m/s^2.
std::vector<double> inertia_changes(const Motion& motion, const Observations& observations, double scale) {
  const std::vector<double> full = block_acceleration(motion);
  std::vector<double> change;
  for (const auto& slip : observations.slips) {
    for (std::size_t s = slip.samples.begin; s < slip.samples.end; s += observations.samples_per_value) {
      const std::size_t end = std::min(s + observations.samples_per_value, slip.samples.end);
      double sum = 0;
      for (std::size_t i = s; i < end; ++i) sum += full[i];
      change.push_back(scale * sum / static_cast<double>(end - s));
    }
  }
  return change;
}

/// What the uncertainties of force sensor and load do to friction.
void add_friction_shifts(const Motion& motion, const Observations& observations, const Instruments& instruments,
                         std::vector<Shift>& shifts) {
  const auto& rig = instruments.rig;
  const auto& sensor = instruments.force_sensor;
  const auto zero = zero_of_friction(sensor, motion.friction_kind, motion.conditions.load);
  if (const double u = uncertainty(zero); u > 0) shifts.push_back({{}, {}, -u, 0});
  if (const double u = uncertainty(sensor.crosstalk); u > 0) shifts.push_back({{}, {}, -u, 0});
  if (const double u = uncertainty(sensor.gain); u > 0) shifts.push_back({{}, {}, 0, -u / sensor.gain->value});
  if (const double u = uncertainty(rig.load); u > 0 && !sensor.load_measured) {
    shifts.push_back({{}, {}, 0, -u / rig.load->value});
  }
  if (const double u = uncertainty(sensor.mass_below); u > 0 && motion.conditions.load.known()) {
    // In rigid stick the block moves with the disc, so the levels at break-away do not change.
    shifts.push_back({{}, inertia_changes(motion, observations, u / motion.conditions.load.value)});
  }
}

/// The observations as they would be with the shift.
Observations moved(const Observations& observations, const Shift& shift) {
  Observations out = observations;
  for (std::size_t i = 0; i < shift.velocity.size(); ++i) out.velocity[i] += shift.velocity[i];
  for (std::size_t i = 0; i < shift.friction.size(); ++i) out.friction[i] += shift.friction[i];
  for (auto& slip : out.slips) {
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      // An offset is of the sensor, not of the direction of sliding.
      out.friction[i] += shift.offset + shift.part * out.friction[i];
    }
    slip.break_away_friction += slip.direction * shift.offset + shift.part * slip.break_away_friction;
  }
  return out;
}

}  // namespace

std::vector<double> systematic_errors(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
                                      const Observations& observations, const Instruments& instruments,
                                      const std::vector<bool>& free, bool published) {
  std::vector<double> squares(p.size(), 0.0);
  std::vector<Shift> shifts;
  add_velocity_shifts(motion, observations, instruments, shifts);
  add_delay_shifts(observations, instruments, shifts);
  add_friction_shifts(motion, observations, instruments, shifts);
  if (shifts.empty()) return squares;
  const std::vector<std::size_t> all = all_slips(observations);
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
    Eigen::VectorXd levels = Eigen::VectorXd::Zero(curvature.rows());  // of per-cycle extremes, which give them
    for (Eigen::Index k = 0; published && k < 2; ++k)
      levels(k) = shift.offset + shift.part * p[static_cast<std::size_t>(k)];
    const Eigen::VectorXd pull = gradient(moved(observations, shift), nullptr) - base;
    const Eigen::VectorXd step = levels - inverse * (pull + curvature * levels);
    for (std::size_t k = 0; k < p.size(); ++k) squares[k] += std::pow(step(static_cast<Eigen::Index>(k)), 2);
  }
  for (double& s : squares) s = std::sqrt(s);
  return squares;
}

}  // namespace tribofit
