#include "tribofit/study/twin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "fit/assessment.hpp"
#include "fit/fit_laws.hpp"
#include "fit/requested_effects.hpp"
#include "limits.hpp"
#include "motion_measures.hpp"
#include "simulated_run.hpp"
#include "statistics/reductions.hpp"
#include "step_counter.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit {
namespace {

const double kNoValue = std::numeric_limits<double>::quiet_NaN();

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

SpeedProfile speed_of(const Motion& motion, double radius, double grid) {
  std::vector<double> times, speeds;
  const std::function<double(double)> velocity = follow(motion.disc_velocity, motion.step, grid);
  for (double t = 0; t < motion.duration(); t += grid) {
    times.push_back(t);
    speeds.push_back(velocity(t) / radius);
  }
  return piecewise_linear_speed(std::move(times), std::move(speeds));
}

/// The machine's drive at the record's own conditions.
Drive drive_of(const Machine& machine, const Motion& motion) {
  Drive drive = machine.drive();
  const double grid = 2 * std::numbers::pi / machine.rig.natural_frequency() / kConditionsAPeriod;
  if (!motion.disc_velocity.empty()) drive.speed = speed_of(motion, machine.radius, grid);
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

/// One simulated record as the measured one is read. recorded: whose friction and v_r are not there any more; shown:
/// takes three cycles of it where it is given.
MotionMeasures simulated_measures(const Machine& machine, const BreakAwayScatter& scatter, Sensors sensors,
                                  const Motion& recorded, std::uint64_t seed, BlockMotion* shown) {
  const Drive drive = drive_of(machine, recorded);
  SimulationOptions options{
      .duration = recorded.duration(), .rate = 1 / recorded.step, .scatter = scatter, .seed = seed};
  if (drive.speed.constant) options.settle = settling_time(machine.rig, drive, machine.parameters);
  sensors.seed = seed + 0x9e3779b97f4a7c15u;
  Trace trace = record_machine(machine, drive, options, sensors);
  trace.conditions.radius = {machine.radius, "twin"};
  if (drive.speed.constant) trace.conditions.speed = {machine.speed, "twin"};
  const Motion twin = plain_motion(std::move(trace), recorded.stick);
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

  /// With its error and the difference in those. given_break_away: at the mean break-away that the record has, by a
  /// straight line through the simulations; else their mean.
  TwinMeasure::Simulated of(std::size_t k, const Estimate& measured, bool given_break_away) const {
    std::vector<double> x, y;
    double within = 0;
    for (const MotionMeasures& m : simulations_) {
      if (m.values.empty() || !std::isfinite(m.values[k].value)) continue;
      x.push_back(given_break_away ? m.break_away().value - break_away_ : 0);
      y.push_back(m.values[k].value);
      if (std::isfinite(m.values[k].std_error)) within += std::pow(m.values[k].std_error, 2);
    }
    const auto n = static_cast<double>(y.size());
    if (n < 4 || 2 * n < static_cast<double>(simulations_.size())) return {kNoValue, kNoValue, kNoValue};
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
  for (std::size_t k = motion_measures().size(); k < measured.size(); ++k) {
    const double d = predictions.of(k, measured[k], true).difference;
    if (!std::isfinite(d)) continue;
    squares += d * d, n += 1;
  }
  return n > 0 ? std::sqrt(squares / n) : kNoValue;
}

std::vector<MotionMeasures> simulate_column(const IdentifiedMachine& identified, const Sensors& sensors,
                                            const Motion& recorded, std::size_t count, const TwinOptions& options,
                                            StepCounter& counter, BlockMotion& shown) {
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
  const Predictions predictions(simulations, measured.break_away());
  double squares = 0, n = 0;
  bool missing = false;
  const auto add = [&](TwinMeasure& measure, const TwinMeasure::Simulated& simulated) {
    const double d = simulated.difference;
    measure.simulated.push_back(simulated);
    if (!std::isfinite(measure.measured)) return;
    if (std::isfinite(d)) squares += d * d, n += 1;
    missing |= !std::isfinite(d);
  };
  for (std::size_t k = 0; k + 1 < twin.measures.size(); ++k) {
    const Estimate& value = measured.values[k];
    const bool known = std::isfinite(value.value), at_break_away = &value != &measured.break_away();
    add(twin.measures[k],
        known ? predictions.of(k, value, at_break_away) : TwinMeasure::Simulated{kNoValue, kNoValue, kNoValue});
  }
  const double distance = portrait_distance(measured.values, predictions);
  add(twin.measures.back(), {distance, kNoValue, distance});
  twin.rms_difference.push_back(n > 0 && !missing ? std::sqrt(squares / n) : kNoValue);
}

/// Whether the twin of a column moves as the record does.
std::string agreement_of(const Twin& twin, std::size_t column) {
  const std::string& name = twin.columns[column];
  if (!std::isfinite(twin.rms_difference[column]))
    return name + ": the twin does not stick and slip as the record does";
  std::string off;
  for (const std::string& measure : twin.failures(column)) off += (off.empty() ? "" : ", ") + measure;
  return name + (off.empty() ? ": the twin moves as the record does, within its errors" : ": the twin fails in " + off);
}

void refuse_without_stick_slip(Identification& trace) {
  if (!trace.analysed || trace.segmentation.kind == MotionKind::stick_slip) return;
  trace.refuse(trace.segmentation.kind == MotionKind::always_sticking
                   ? "the block never slips: there is no motion to compare"
                   : "the block never sticks: there are no cycles to compare");
}

/// Fits the laws with the effects of the options and adds the best of them, with its rig.
void add_best(const IdentifyOptions& options, std::vector<Fit>& best, TwinIdentification& out) {
  Identification& trace = out.trace;
  if (trace.analysed) fit_laws(options, trace);
  if (!trace.analysed) return;
  best.push_back(trace.fits[trace.best]);
  out.rigs.push_back(rig_beside(best.back(), trace.motion, trace.segmentation, options.instruments));
  if (!out.rigs.back().determined) trace.refuse("the rig could not be identified: " + out.rigs.back().reason);
}

/// The bare laws, then those with the effects of friction; `out.trace` holds the best fits afterwards.
void fit_machines(const IdentifyOptions& options, TwinIdentification& out) {
  IdentifyOptions plan = options;
  plan.published_protocol = false;
  plan.effects.clear();
  std::vector<Fit> best;
  add_best(plan, best, out);
  plan.effects = options.effects;
  if (!friction_effects(options.effects).empty()) add_best(plan, best, out);
  out.trace.fits = std::move(best);
  out.trace.best = out.trace.fits.empty() ? 0 : out.trace.fits.size() - 1;
}

/// One machine for each fit; none where one of them cannot be had, and `twin` says why.
std::vector<IdentifiedMachine> machines_of(const TwinIdentification& all, Twin& twin) {
  const Identification& trace = all.trace;
  std::vector<IdentifiedMachine> machines;
  for (std::size_t c = 0; c < trace.fits.size(); ++c) {
    machines.push_back(identified_machine(trace.fits[c], all.rigs[c], trace.motion, trace.segmentation));
    twin.reason = machines.back().reason;
    if (!twin.reason.empty()) return {};
    for (const std::string& note : machines.back().notes) {
      twin.messages.push_back(trace.fits[c].model.name() + ": " + note);
    }
  }
  return machines;
}

/// Simulates each of the fits on its rig and compares.
Twin compare_machines(const TwinOptions& options, TwinIdentification& all) {
  Motion& motion = all.trace.motion;
  const Segmentation& segmentation = all.trace.segmentation;
  Twin twin;
  const std::vector<IdentifiedMachine> machines = machines_of(all, twin);
  if (machines.empty()) return twin;
  const MotionMeasures measured = measure_motion(motion, segmentation);
  const bool force = motion.friction_kind == FrictionKind::force;
  for (std::size_t k = 0; k < motion_measures().size(); ++k) {
    const MotionMeasureInfo& info = motion_measures()[k];
    const Estimate& m = measured.values[k];
    twin.measures.push_back(
        {info.name, info.unit == "1" && force ? "N" : info.unit, info.si, m.value, m.std_error, {}});
  }
  twin.measures.push_back({"phase portrait", "std errors", 1, 0, kNoValue, {}});
  const auto affordable = static_cast<std::size_t>(kMostSimulatedSamples / static_cast<double>(motion.size()));
  twin.simulations = std::max(kFewestSimulations, std::min(options.simulations, affordable));
  const Sensors sensors = noise_of_record(motion, segmentation, all.trace.fits[0].floor);
  twin.measured = block_motion(motion, segmentation, compliance(machines.back().machine));
  // A long record and those that are simulated beside it do not fit into memory together.
  std::vector<double>().swap(motion.friction);
  std::vector<double>().swap(motion.relative_velocity);
  std::function<void(double)> say;
  if (options.progress) say = [&](double part) { options.progress("simulating twins", part); };
  StepCounter counter(machines.size() * twin.simulations, say);
  for (std::size_t c = 0; c < machines.size(); ++c) {
    const auto simulations = simulate_column(machines[c], sensors, motion, twin.simulations, options, counter,
                                             twin.simulated.emplace_back());
    twin.columns.push_back(all.trace.fits[c].model.name());
    add_column(measured, simulations, twin);
    twin.messages.push_back(agreement_of(twin, c));
  }
  return twin;
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

void add_twins(const IdentifyOptions& options, TwinOptions more, TwinIdentification& out) {
  Identification& trace = out.trace;
  refuse_without_stick_slip(trace);
  fit_machines(options, out);
  more.threads = options.threads;
  if (trace.analysed) {
    out.twin = compare_machines(more, out);
  } else {
    out.twin.reason = trace.warnings.back();
  }
  trace.analysed = out.twin.reason.empty();
}

}  // namespace tribofit
