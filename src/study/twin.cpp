#include "tribofit/study/twin.hpp"
#include "fit/assessment.hpp"
#include "limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "fit_machines.hpp"
#include "motion_measures.hpp"
#include "simulated_run.hpp"
#include "statistics/reductions.hpp"
#include "step_counter.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/sensors.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kBreakAway = 3;  // among the measures
const double kNone = std::numeric_limits<double>::quiet_NaN();

/// A channel as a function of time since the record's first sample: means over `grid` [s] with straight lines between.
std::function<double(double)> follow(const std::vector<double>& channel, double step, double grid) {
  const auto length = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(grid / step)));
  const auto means = std::make_shared<std::vector<double>>();
  for (std::size_t begin = 0; begin < channel.size(); begin += length) {
    const std::size_t end = std::min(begin + length, channel.size());
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += channel[i];
    means->push_back(sum / static_cast<double>(end - begin));
  }
  grid = static_cast<double>(length) * step;
  return [means, grid](double t) {
    const double place = std::clamp(t / grid - 0.5, 0.0, static_cast<double>(means->size() - 1));
    const auto k = std::min(static_cast<std::size_t>(place), means->size() - 1),
               next = std::min(k + 1, means->size() - 1);
    return (*means)[k] + (place - static_cast<double>(k)) * ((*means)[next] - (*means)[k]);
  };
}

/// What a simulation takes from the record: its length, and the conditions it was run under.
struct RecordedConditions {
  explicit RecordedConditions(const Motion& recorded) : motion(recorded), duration(recorded.duration()) {}
  const Motion& motion;  ///< whose friction and v_r are not read
  double duration;       ///< [s]
};

SpeedProfile speed_of(const Motion& motion, double duration, double radius, double grid) {
  std::vector<double> times, speeds;
  const std::function<double(double)> velocity = follow(motion.disc_velocity, motion.step, grid);
  for (double t = 0; t < duration; t += grid) {
    times.push_back(t);
    speeds.push_back(velocity(t) / radius);
  }
  return piecewise_linear_speed(std::move(times), std::move(speeds));
}

/// The machine's drive at the record's own conditions.
Drive drive_of(const Machine& machine, const RecordedConditions& recorded) {
  const Motion& motion = recorded.motion;
  Drive drive = machine.drive();
  const double grid = 2 * std::numbers::pi / machine.rig.natural_frequency() / kConditionsAPeriod;
  if (!motion.disc_velocity.empty()) drive.speed = speed_of(motion, recorded.duration, machine.radius, grid);
  if (!motion.load.empty() && motion.friction_kind == FrictionKind::coefficient) {
    drive.load = follow(motion.load, motion.step, grid);
  }
  if (!motion.temperature.empty()) {
    drive.temperature = follow(motion.temperature, motion.step, grid);
    drive.mean_temperature = mean_of(motion.temperature);
  }
  return drive;
}

/// N/k of a machine: what the spring gives for a unit of friction [m].
double compliance(const Machine& machine) {
  return machine.load / machine.rig.stiffness;
}

/// One simulated record as the measured one is read. shown: takes three cycles of it where it is given.
MotionMeasures simulated_measures(const Machine& machine, const BreakAwayScatter& scatter, Sensors sensors,
                                  const RecordedConditions& recorded, std::uint64_t seed, BlockMotion* shown) {
  const Drive drive = drive_of(machine, recorded);
  SimulationOptions options;
  options.duration = recorded.duration;
  options.rate = 1 / recorded.motion.step;
  options.scatter = scatter;
  options.seed = seed;
  if (drive.speed.constant) options.settle = settling_time(machine.rig, drive, machine.parameters);
  options.channels = recorded_channels(machine.model, machine.parameters, drive, sensors);
  sensors.seed = seed + 0x9e3779b97f4a7c15u;
  Trace trace = recorded_trace(simulate(machine.rig, drive, machine.model, machine.parameters, options), machine.model,
                               machine.parameters, sensors);
  trace.conditions.radius = {machine.radius, "twin"};
  if (drive.speed.constant) trace.conditions.speed = {machine.speed, "twin"};
  const Motion twin = compute_motion(std::move(trace), {},
                                     {.trim = false,
                                      .undo_high_pass = false,
                                      .undo_speed_ripple = false,
                                      .undo_distortions = false,
                                      .stick = recorded.motion.stick});
  const Segmentation cycles = find_cycles(twin);
  if (cycles.kind != MotionKind::stick_slip || cycles.cycles.size() < 4) return {};
  if (shown != nullptr) *shown = block_motion(twin, cycles, compliance(machine));
  return measure_motion(twin, cycles);
}

/// What the simulations predict for one measure of a record of this length.
class Predictions {
 public:
  Predictions(const std::vector<MotionMeasures>& simulations, const Estimate& break_away)
      : simulations_(simulations), break_away_(break_away.value) {}

  /// With its error and the difference in those. `given_break_away`: at the mean break-away that the record has, by a
  /// straight line through the simulations; else their mean.
  TwinMeasure::Simulated of(std::vector<Estimate> MotionMeasures::*list, std::size_t k, const Estimate& measured,
                            bool given_break_away) const {
    std::vector<double> x, y;
    double within = 0;
    for (const MotionMeasures& m : simulations_) {
      if ((m.*list).empty() || !std::isfinite((m.*list)[k].value)) continue;
      x.push_back(given_break_away ? m.values[kBreakAway].value - break_away_ : 0);
      y.push_back((m.*list)[k].value);
      if (std::isfinite((m.*list)[k].std_error)) within += std::pow((m.*list)[k].std_error, 2);
    }
    const auto n = static_cast<double>(y.size());
    if (n < 4 || 2 * n < static_cast<double>(simulations_.size())) return {kNone, kNone, kNone};
    const StraightLine line = fit_line(x, y);
    const bool leans = line.squares > 0;
    double squares = 0;
    for (std::size_t i = 0; i < y.size(); ++i) squares += std::pow(y[i] - line.at(x[i]), 2);
    const double variance = squares / (n - (leans ? 2 : 1));
    const double leverage = 1 + 1 / n + (leans ? line.middle * line.middle / line.squares : 0);
    // A record that scatters more than its twins knows its own mean less well than they do.
    const double own = std::isfinite(measured.std_error) ? std::pow(measured.std_error, 2) : 0;
    TwinMeasure::Simulated out;
    out.value = line.at(0);
    out.std_error = std::sqrt(variance * leverage);
    const double difference = out.value - measured.value;
    if (std::abs(difference) > kRounding * std::abs(measured.value)) {
      out.difference = difference / std::sqrt(variance * leverage + std::max(0.0, own - within / n));
    }
    return out;
  }

 private:
  static constexpr double kRounding = 1e-9;

  const std::vector<MotionMeasures>& simulations_;
  double break_away_;
};

/// Root mean square of the differences over the loop.
double portrait_distance(const std::vector<Estimate>& measured, const Predictions& predictions) {
  double squares = 0, n = 0;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const double d = predictions.of(&MotionMeasures::portrait, k, measured[k], true).difference;
    if (!std::isfinite(d)) continue;
    squares += d * d, n += 1;
  }
  return n > 0 ? std::sqrt(squares / n) : kNone;
}

std::vector<MotionMeasures> simulate_column(const IdentifiedMachine& identified, const Sensors& sensors,
                                            const RecordedConditions& recorded, std::size_t count,
                                            const TwinOptions& options, StepCounter& counter, BlockMotion& shown) {
  const std::vector<Machine> machines = draws_of(identified.machine, identified.covariance, count, options.seed);
  std::vector<MotionMeasures> out(machines.size());
  run_tasks(machines.size(), options.threads, [&](std::size_t k) {
    try {
      out[k] = simulated_measures(machines[k], identified.scatter, sensors, recorded, options.seed * 1000003 + k,
                                  k == 0 ? &shown : nullptr);
    } catch (const InputError&) {  // numbers that cannot be simulated: one prediction less
    }
    counter.step();
  });
  return out;
}

void add_column(const MotionMeasures& measured, const std::vector<MotionMeasures>& simulations, Twin& twin) {
  const Predictions predictions(simulations, measured.values[kBreakAway]);
  double squares = 0, n = 0;
  bool missing = false;
  const auto count = [&](double d) {
    if (std::isfinite(d)) squares += d * d, n += 1;
    missing |= !std::isfinite(d);
  };
  for (std::size_t k = 0; k + 1 < twin.measures.size(); ++k) {
    if (!std::isfinite(measured.values[k].value)) {
      twin.measures[k].simulated.push_back({kNone, kNone, kNone});
      continue;
    }
    const auto value = predictions.of(&MotionMeasures::values, k, measured.values[k], k != kBreakAway);
    count(value.difference);
    twin.measures[k].simulated.push_back(value);
  }
  const double distance = portrait_distance(measured.portrait, predictions);
  count(distance);
  twin.measures.back().simulated.push_back({distance, kNone, distance});
  twin.rms_difference.push_back(n > 0 && !missing ? std::sqrt(squares / n) : kNone);
}

void say_what_fails(Twin& twin) {
  for (std::size_t c = 0; c < twin.columns.size(); ++c) {
    if (!std::isfinite(twin.rms_difference[c])) {
      twin.messages.push_back(twin.columns[c] + ": the twin does not stick and slip as the record does");
      continue;
    }
    const std::vector<std::string> off = twin.failures(c);
    std::string names;
    for (const std::string& name : off) names += (names.empty() ? "" : ", ") + name;
    twin.messages.push_back(twin.columns[c] + (off.empty() ? ": the twin moves as the record does, within its errors"
                                                           : ": the twin fails in " + names));
  }
}

}  // namespace

std::vector<std::string> Twin::failures(std::size_t column) const {
  std::vector<std::pair<double, std::string>> off;
  for (const TwinMeasure& m : measures) {
    const double d = std::abs(m.simulated.at(column).difference);
    if (!(d <= kTwinIsOff) && std::isfinite(m.measured)) off.emplace_back(-d, m.name);
  }
  std::stable_sort(off.begin(), off.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (auto& [size, name] : off) names.push_back(std::move(name));
  return names;
}

bool Twin::agrees() const {
  return reason.empty() && !columns.empty() && std::isfinite(rms_difference.back()) &&
         failures(columns.size() - 1).empty();
}

std::string Twin::short_name(std::size_t column) const {
  const std::string& name = columns[column];
  const std::size_t plus = name.find(" + ");
  return column == 0 || plus == std::string::npos ? name : name.substr(plus + 1);
}

bool TwinIdentification::law_falls_short() const {
  return !trace.fits.empty() && is_conditional(trace.fits.back());
}

Twin compare_twins(const Motion& motion, const Segmentation& segmentation, std::span<const Fit> fits,
                   std::span<const RigFit> rigs, const TwinOptions& options) {
  return compare_twins(motion, segmentation, fits, rigs, options, [] {});
}

Twin compare_twins(const Motion& motion, const Segmentation& segmentation, std::span<const Fit> fits,
                   std::span<const RigFit> rigs, const TwinOptions& options,
                   const std::function<void()>& measured_all) {
  Twin twin;
  if (segmentation.kind != MotionKind::stick_slip) {
    twin.reason = "the block does not stick and slip: there is no cycle to compare";
    return twin;
  }
  std::vector<IdentifiedMachine> machines;
  for (std::size_t c = 0; c < fits.size(); ++c) {
    const Fit& fit = fits[c];
    machines.push_back(identified_machine(fit, rigs[c], motion, segmentation));
    if (!machines.back().reason.empty()) {
      twin.reason = machines.back().reason;
      return twin;
    }
    for (const std::string& note : machines.back().notes) twin.messages.push_back(fit.model.name() + ": " + note);
  }
  const MotionMeasures measured = measure_motion(motion, segmentation);
  const bool force = motion.friction_kind == FrictionKind::force;
  for (std::size_t k = 0; k < measured.values.size(); ++k) {
    const MotionMeasureInfo& info = motion_measures()[k];
    const Estimate& m = measured.values[k];
    twin.measures.push_back(
        {info.name, info.unit == "1" && force ? "N" : info.unit, info.si, m.value, m.std_error, {}});
  }
  twin.measures.push_back({"phase portrait", "std errors", 1, 0, kNone, {}});
  const auto affordable = static_cast<std::size_t>(kMostSimulatedSamples / static_cast<double>(motion.size()));
  twin.simulations = std::max(kFewestSimulations, std::min(options.simulations, affordable));
  const Sensors sensors = noise_of_record(motion, segmentation, fits.empty() ? Floor{} : fits[0].floor);
  if (!machines.empty()) twin.measured = block_motion(motion, segmentation, compliance(machines.back().machine));
  const RecordedConditions recorded(motion);
  measured_all();
  std::function<void(double)> say;
  if (options.progress) say = [&](double part) { options.progress("simulating twins", part); };
  StepCounter counter(machines.size() * twin.simulations, say);
  for (std::size_t c = 0; c < machines.size(); ++c) {
    const auto simulations = simulate_column(machines[c], sensors, recorded, twin.simulations, options, counter,
                                             twin.simulated.emplace_back());
    twin.columns.push_back(fits[c].model.name());
    add_column(measured, simulations, twin);
  }
  say_what_fails(twin);
  return twin;
}

}  // namespace tribofit
