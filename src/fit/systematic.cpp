#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "fit_steps.hpp"
#include "limits.hpp"

namespace tribofit {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A source of systematic error: how one standard deviation changes the observations. What is NaN is not known.
struct Shift {
  std::vector<double> velocity = {}, friction = {};  ///< one per value; empty: no change
  /// |friction| by offset + part |friction|, break-aways and extremes too; one per record, or empty.
  std::vector<double> offset = {}, part = {};

  std::vector<double> break_away = {};    ///< by which it is late or early [s], one per record, or empty
  std::vector<double> acceleration = {};  ///< part of it, one per record, or empty

  double acceleration_of(std::size_t record) const { return acceleration.empty() ? 0 : acceleration[record]; }
  double late_of(std::size_t record) const { return break_away.empty() ? 0 : break_away[record]; }
  double offset_of(std::size_t record) const { return offset.empty() ? 0 : offset[record]; }
  double part_of(std::size_t record) const { return part.empty() ? 0 : part[record]; }
  bool known() const {
    const auto finite = [](double x) { return std::isfinite(x); };
    return std::all_of(velocity.begin(), velocity.end(), finite) &&
           std::all_of(friction.begin(), friction.end(), finite) && std::all_of(offset.begin(), offset.end(), finite) &&
           std::all_of(part.begin(), part.end(), finite);
  }
};

double uncertainty(const std::optional<Declared>& declared) {
  return declared ? declared->uncertainty : 0;
}

/// A value of the observations in the motion it came from.
struct Place {
  const Motion* motion;
  std::size_t record, sample;
};

/// What all shifts are made from.
struct Sources {
  std::span<const Record> records;
  const Observations& observations;
  const Instruments& instruments;

  /// Calls look(place, index) for every value.
  template <class Look>
  void each_place(Look&& look) const {
    for (const auto& slip : observations.slips) {
      const Motion& motion = *records[slip.record].motion;
      const auto begin = motion.time.begin();
      auto at =
          slip.begin < slip.end ? std::lower_bound(begin, motion.time.end(), observations.time[slip.begin]) : begin;
      for (std::size_t i = slip.begin; i < slip.end; ++i) {  // in order of time
        while (at != motion.time.end() && *at < observations.time[i]) ++at;
        look(Place{&motion, slip.record, std::min(static_cast<std::size_t>(at - begin), motion.size() - 1)}, i);
      }
    }
  }

  /// change(place, index) of every value.
  template <class Change>
  std::vector<double> values(Change&& change) const {
    std::vector<double> out(observations.size());
    each_place([&](const Place& at, std::size_t i) { out[i] = change(at, i); });
    return out;
  }
  /// change(motion) of every record.
  template <class Change>
  std::vector<double> each(Change&& change) const {
    std::vector<double> out;
    for (const Record& record : records) out.push_back(change(*record.motion));
    return out;
  }
};

/// v_r was made from omega r as stated or recorded.
bool follows_stated_disc(const Motion& motion) {
  return motion.velocity_kind != VelocityKind::relative && motion.conditions.speed.source != "plateau";
}

/// The speed of the disc was recorded, not stated (where a ripple was undone, the channel was made from the statement).
bool speed_was_recorded(const Motion& motion) {
  return !motion.disc_speed.empty() && motion.speed_ripple.amplitude == 0;
}

const Condition& condition_at(const Motion& motion, std::size_t sample, Condition Conditions::*which) {
  for (const Step& step : motion.steps) {
    const Condition& own = step.conditions.*which;
    if (step.begin <= sample && sample < step.end && own.known()) return own;
  }
  return motion.conditions.*which;
}

/// omega at a sample; NaN where it is not known [rad/s].
double disc_speed_at(const Place& at) {
  if (!at.motion->disc_speed.empty()) return at.motion->disc_speed[at.sample];
  const Condition& speed = condition_at(*at.motion, at.sample, &Conditions::speed);
  return speed.known() ? speed.value : kUnknown;
}

/// N at a sample; NaN where it is not known [N]. 1 where friction is a force.
double load_at(const Place& at) {
  if (at.motion->friction_kind == FrictionKind::force) return 1;
  if (!at.motion->load.empty()) return at.motion->load[at.sample];
  const Condition& load = condition_at(*at.motion, at.sample, &Conditions::load);
  return load.known() ? load.value : kUnknown;
}

/// Displacement of the block from its mean [m] at every sample: what an uncertain high-pass corner multiplies.
std::vector<double> displacement(const Motion& motion) {
  const std::size_t n = motion.size();
  double mean = 0, x = 0;
  std::vector<double> block(n);
  for (std::size_t i = 0; i < n; ++i) {
    block[i] = motion.disc_velocity_at(i) - motion.relative_velocity[i];
    mean += block[i] / static_cast<double>(n);
  }
  for (double& v : block) v = x += (v - mean) * motion.step;
  return block;
}

/// `delay` of each record times dv_r/dt at every value, slip by slip.
std::vector<double> slopes(const Observations& observations, const std::vector<double>& delay) {
  std::vector<double> out(observations.size(), 0.0);
  for (const auto& slip : observations.slips) {
    if (delay[slip.record] == 0) continue;
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      const std::size_t before = std::max(i, slip.begin + 1) - 1, after = std::min(i + 1, slip.end - 1);
      if (after == before) continue;
      out[i] = delay[slip.record] * (observations.velocity[after] - observations.velocity[before]) /
               (observations.time[after] - observations.time[before]);
    }
  }
  return out;
}

/// What the uncertainties of radius and speed do to v_r.
void add_disc_shifts(const Sources& s, std::vector<Shift>& shifts) {
  const auto& rig = s.instruments.rig;
  if (const double u = uncertainty(rig.radius); u > 0) {
    shifts.push_back({s.values(
        [&](const Place& at, std::size_t) { return follows_stated_disc(*at.motion) ? u * disc_speed_at(at) : 0.0; })});
  }
  if (const double u = uncertainty(rig.speed); u > 0) {
    shifts.push_back({s.values([&](const Place& at, std::size_t) {
      if (!follows_stated_disc(*at.motion) || speed_was_recorded(*at.motion)) return 0.0;
      const Condition& radius = condition_at(*at.motion, at.sample, &Conditions::radius);
      return radius.known() ? u * radius.value : kUnknown;
    })});
  }
}

/// What those of the vibrometer do to it.
void add_vibrometer_shifts(const Sources& s, std::vector<Shift>& shifts) {
  const auto& vibrometer = s.instruments.vibrometer;
  if (const double u = uncertainty(vibrometer.gain); u > 0) {
    // v_b = reading/gain; where omega r was read off the plateau it scales with it, and so does v_r as a whole.
    const double part = u / vibrometer.gain->value;
    shifts.push_back({s.values([&](const Place& at, std::size_t i) {
      const double v = s.observations.velocity[i];
      return follows_stated_disc(*at.motion) ? part * (at.motion->disc_velocity_at(at.sample) - v) : -part * v;
    })});
  }
  std::vector<std::vector<double>> x;
  const auto shift_of = [&](double corner, std::size_t only) {
    for (std::size_t r = x.size(); r < s.records.size(); ++r) x.push_back(displacement(*s.records[r].motion));
    return Shift{s.values([&](const Place& at, std::size_t) {
      return at.record == only || only == s.records.size() ? -2 * std::numbers::pi * corner * x[at.record][at.sample]
                                                           : 0.0;
    })};
  };
  if (vibrometer.high_pass) {
    if (const double u = uncertainty(vibrometer.high_pass); u > 0) shifts.push_back(shift_of(u, s.records.size()));
    return;
  }
  for (std::size_t r = 0; r < s.records.size(); ++r) {  // found in each record by itself
    const double u = s.records[r].motion->high_pass_std_error;
    if (u > 0) shifts.push_back(shift_of(u, r));
  }
}

/// What those of distortions do that were found in a record and undone.
void add_undone_shifts(const Sources& s, std::vector<Shift>& shifts) {
  for (std::size_t r = 0; r < s.records.size(); ++r) {
    const Motion& motion = *s.records[r].motion;
    if (const double u = motion.velocity_zero.std_error; u > 0) {
      shifts.push_back({s.values([&](const Place& at, std::size_t) { return at.record == r ? u : 0.0; })});
    }
    const UndoneResponse &of_v = motion.velocity_response, &of_mu = motion.friction_response;
    if (of_v.any()) {
      shifts.push_back({s.values([&](const Place& at, std::size_t i) {
        const double v = motion.disc_velocity_at(at.sample) - s.observations.velocity[i];
        return at.record == r ? -of_v.std_error * of_v.response.slope(v) : 0.0;
      })});
    }
    if (of_mu.any()) {
      // Break-away is at the end of the range, where s = 1.
      std::vector<double> part(s.records.size(), 0.0);
      part[r] = of_mu.std_error;
      shifts.push_back({.friction = s.values([&](const Place& at, std::size_t i) {
                          const double mu = s.observations.friction[i];
                          return at.record == r ? of_mu.std_error * (of_mu.response.slope(mu) - mu) : 0.0;
                        }),
                        .part = std::move(part)});
    }
  }
}

/// What delays between the channels do. Low-passes are corrected as the delay they make at low frequency.
void add_delay_shifts(const Sources& s, std::vector<Shift>& shifts) {
  constexpr double kSensorDamping = 0.7;
  const Instruments& instruments = s.instruments;
  const auto low_pass_delay = [](const std::optional<Declared>& corner_frequency, double factor) {
    const double u_f = uncertainty(corner_frequency);
    return u_f > 0 ? factor * u_f / (2 * std::numbers::pi * std::pow(corner_frequency->value, 2)) : 0.0;
  };
  for (const double u : {uncertainty(instruments.vibrometer.delay), low_pass_delay(instruments.vibrometer.low_pass, 1),
                         low_pass_delay(instruments.force_sensor.bandwidth, 2 * kSensorDamping)}) {
    if (u > 0) shifts.push_back({slopes(s.observations, std::vector<double>(s.records.size(), u))});
  }
  for (std::size_t r = 0; r < s.records.size(); ++r) {  // clocks and filters were compared in each record by itself
    const Motion& motion = *s.records[r].motion;
    for (const double u :
         {motion.clock_offset_std_error, motion.velocity_low_pass.std_error, motion.friction_low_pass.std_error,
          0.5 * motion.duration() * motion.clock_drift.std_error}) {
      if (u == 0) continue;
      std::vector<double> delay(s.records.size(), 0.0);
      delay[r] = u;
      shifts.push_back({slopes(s.observations, delay)});
    }
  }
}

/// What the uncertainties of force sensor and load do to friction.
void add_friction_shifts(const Sources& s, std::vector<Shift>& shifts) {
  const auto& rig = s.instruments.rig;
  const auto& sensor = s.instruments.force_sensor;
  const std::vector<double> zero = s.each([&](const Motion& motion) {
    return -uncertainty(zero_of_friction(sensor, motion.friction_kind, motion.conditions.load));
  });
  if (uncertainty(sensor.zero) > 0) shifts.push_back({.offset = zero});
  const auto same = [&](double value) { return std::vector<double>(s.records.size(), value); };
  if (const double u = uncertainty(sensor.crosstalk); u > 0) shifts.push_back({.offset = same(-u)});
  if (const double u = uncertainty(sensor.gain); u > 0) shifts.push_back({.part = same(-u / sensor.gain->value)});
  if (const double u = uncertainty(rig.load); u > 0 && !sensor.load_measured) {
    shifts.push_back({.part = s.each([&](const Motion& motion) {
      return motion.friction_kind == FrictionKind::force ? 0.0 : -u / rig.load->value;
    })});
  }
  if (const double u = uncertainty(sensor.mass_below); u > 0) {
    // In rigid stick the block moves with the disc, so the levels at break-away do not change.
    std::vector<std::vector<double>> acceleration;
    for (const Record& record : s.records) acceleration.push_back(block_acceleration(*record.motion));
    shifts.push_back({.friction = s.values([&](const Place& at, std::size_t) {
      return u * acceleration[at.record][at.sample] / load_at(at);
    })});
  }
}

/// The observations as they would be with the shift.
Observations moved(const Observations& observations, const Shift& shift) {
  Observations out = observations;
  for (std::size_t i = 0; i < shift.velocity.size(); ++i) out.velocity[i] += shift.velocity[i];
  for (std::size_t i = 0; i < shift.friction.size(); ++i) out.friction[i] += shift.friction[i];
  for (auto& slip : out.slips) {
    const double offset = shift.offset_of(slip.record), part = shift.part_of(slip.record);
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      // An offset is of the sensor, not of the direction of sliding.
      out.friction[i] += offset + part * out.friction[i];
      if (!out.acceleration.empty()) out.acceleration[i] *= 1 + shift.acceleration_of(slip.record);
    }
    slip.break_away_friction += slip.direction * offset + part * slip.break_away_friction;
    if (const double late = shift.late_of(slip.record); late > 0 && std::isfinite(slip.stick_slope))
      slip.break_away_friction += late * slip.stick_slope;
  }
  return out;
}

/// How the levels of per-cycle extremes follow: means over the slips.
Eigen::VectorXd moved_levels(const Observations& observations, const Shift& shift, const std::vector<double>& p) {
  Eigen::VectorXd levels = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(p.size()));
  const auto slips = static_cast<double>(observations.slips.size());
  for (const auto& slip : observations.slips) {
    for (std::size_t k = 0; k < 2; ++k) {
      levels(static_cast<Eigen::Index>(k)) +=
          (shift.offset_of(slip.record) + shift.part_of(slip.record) * p[k]) / slips;
    }
  }
  return levels;
}

/// By how much each parameter follows the shifts, which are independent.
std::vector<double> errors_of(const std::vector<Shift>& shifts, const FitContext& context,
                              const std::vector<bool>& free) {
  const std::vector<double>& p = context.minimum.p;
  const Observations& observations = context.observations;
  std::vector<double> squares(p.size(), 0.0);
  if (shifts.empty()) return squares;
  if (!std::all_of(shifts.begin(), shifts.end(), [](const Shift& shift) { return shift.known(); }))
    return std::vector<double>(p.size(), kUnknown);
  const std::vector<std::size_t> all = all_slips(observations);
  const auto gradient = [&](const Observations& at, Eigen::MatrixXd* curvature) {
    const CycleEvidence evidence = evidence_at(ModelResiduals(context.model, at, all), at, p);
    if (curvature != nullptr) *curvature = evidence.total;
    return sum_of(evidence).gradient;
  };
  Eigen::MatrixXd curvature;
  const Eigen::VectorXd base = gradient(observations, &curvature);
  const Eigen::MatrixXd inverse = inverse_over(curvature, free);
  for (const Shift& shift : shifts) {
    Eigen::VectorXd levels = Eigen::VectorXd::Zero(curvature.rows());
    if (context.by_extremes()) levels = moved_levels(observations, shift, p);
    const Eigen::VectorXd pull = gradient(moved(observations, shift), nullptr) - base;
    const Eigen::VectorXd step = levels - inverse * (pull + curvature * levels);
    for (std::size_t k = 0; k < p.size(); ++k) squares[k] += std::pow(step(static_cast<Eigen::Index>(k)), 2);
  }
  for (double& s : squares) s = std::sqrt(s);
  return squares;
}

}  // namespace

std::vector<double> systematic_errors(const FitContext& context, const std::vector<bool>& free) {
  std::vector<Shift> shifts;
  const Sources sources{context.records, context.observations, context.instruments};
  add_disc_shifts(sources, shifts);
  add_vibrometer_shifts(sources, shifts);
  add_undone_shifts(sources, shifts);
  add_delay_shifts(sources, shifts);
  add_friction_shifts(sources, shifts);
  return errors_of(shifts, context, free);
}

std::vector<double> smoothing_errors(const FitContext& context, const std::vector<bool>& free) {
  const std::span<const Record> records = context.records;
  std::vector<Shift> shifts;
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (!(records[r].motion->smoothing > 0)) continue;
    shifts.push_back({.break_away = std::vector<double>(records.size(), 0.0)});
    shifts.back().break_away[r] = kPartOfSmoothing * records[r].motion->smoothing;
    if (context.observations.acceleration.empty()) continue;
    shifts.push_back({.acceleration = std::vector<double>(records.size(), 0.0)});
    shifts.back().acceleration[r] = kSmoothedAcceleration;
  }
  return errors_of(shifts, context, free);
}

}  // namespace tribofit
