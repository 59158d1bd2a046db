#include "experiments.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limits.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {

namespace {

bool is_same(double a, double b) {
  return std::abs(a - b) <= kSameCondition * std::max(std::abs(a), std::abs(b));
}

/// As a machine is set to it: two digits in rpm.
double settable(double speed) {
  const double rpm = std::abs(speed) / kRpm;
  if (!(rpm > 0)) return speed;
  const double step = std::pow(10, std::floor(std::log10(rpm)) - 1);
  return std::copysign(std::round(rpm / step) * step * kRpm, speed);
}

/// What shows over the disc's angle or goes on over time takes a record of several revolutions.
bool takes_revolutions(const OpenQuestion& question) {
  return std::any_of(question.asked.begin(), question.asked.end(), [](const Effect& effect) {
    const SketchView view = describe(effect).sketch.view;
    return view == SketchView::angle || view == SketchView::time || view == SketchView::distance;
  });
}

/// Makes the runs of experiments: as long as they need to be, within the time.
class ExperimentMaker {
 public:
  ExperimentMaker(const OpenQuestion& question, const Identification& trace, const Means& means)
      : question_(question), means_(means), longest_(means.longest > 0 ? means.longest : kUsualLongest) {
    const Segmentation& s = trace.segmentation;
    own_ = conditions_of_record(question, trace);
    if (!means.rates.empty()) own_.rate = *std::max_element(means.rates.begin(), means.rates.end());
    stick_ = s.stick_time.value;
    slip_ = s.slip_time.value;
    cycles_ = std::clamp(static_cast<double>(s.cycles.size()), kFewestPlannedCycles, kMostPlannedCycles);
  }

  const RunConditions& own() const { return own_; }

  /// The run with the duration that it takes, for `parts` runs of an experiment.
  RunConditions timed(RunConditions run, double parts = 1, double longer = 1) const {
    double needed = cycles_ * longer * period(run);
    if (takes_revolutions(question_)) {
      needed = std::max({needed, longer * kPlannedRevolutions * 2 * std::numbers::pi / run.speed, 2 * own_.duration});
    }
    run.duration = std::min({needed, longest_ / parts, kMostSimulatedCycles / parts * period(run)});
    return run;
  }

  /// From break-away to break-away: the spring is wound up at the speed of the disc, and the block slips in a time that
  /// its rig sets.
  double period(const RunConditions& run) const {
    const double wound = (run.load / own_.load) * (own_.stiffness / run.stiffness);
    const double by_speed = own_.radius * own_.speed / (run.radius * run.speed);
    return stick_ * wound * by_speed + slip_ * std::sqrt(own_.stiffness / run.stiffness);
  }

  /// Slides with pauses of a dozen lengths between them, from a few sticks to the longest; each after a few cycles.
  RunConditions with_pauses() const {
    RunConditions run = own_;
    const double between = kCyclesBetweenPauses * period(run), shortest = std::max(2 * stick_, kSpeedChangeTime * 4);
    const double top = std::max(means_.longest_pause, 2 * shortest);
    double t = between;
    for (std::size_t k = 0; k < kPlannedPauses; ++k) {
      // Short and long by turns, so that a drift is no ageing.
      const double u = static_cast<double>((5 * k) % kPlannedPauses) / static_cast<double>(kPlannedPauses - 1);
      const double length = shortest * std::pow(top / shortest, u);
      if (t + length + between > longest_) continue;
      run.pauses.push_back({t, length});
      t += length + between;
    }
    run.duration = std::min(longest_, t + between);
    return run;
  }

  RunConditions reversed() const {
    RunConditions run = own_;
    run.reversing = 1 / (kCyclesOfTurn * period(run));
    run.duration = std::min(longest_, kTurns / run.reversing);
    return run;
  }

 private:
  static constexpr double kCyclesBetweenPauses = 6, kCyclesOfTurn = 20, kTurns = 6;
  static constexpr std::size_t kPlannedPauses = 12;

  const OpenQuestion& question_;
  const Means& means_;
  double longest_, stick_ = 0, slip_ = 0, cycles_ = 0;
  RunConditions own_;
};

void add_speeds(const ExperimentMaker& maker, const Means& means, std::vector<Experiment>& out) {
  std::vector<double> other;
  for (const double speed : means.speeds) {
    if (is_same(speed, maker.own().speed)) continue;
    RunConditions run = maker.own();
    run.speed = speed;
    out.push_back({{maker.timed(run)}});
    other.push_back(speed);
  }
  if (other.size() < 2) return;
  RunConditions slow = maker.own(), fast = maker.own();
  slow.speed = *std::min_element(other.begin(), other.end());
  fast.speed = *std::max_element(other.begin(), other.end());
  out.push_back({{maker.timed(slow, 2), maker.timed(fast, 2)}});
}

/// Other radii: at the speed of the record, and so that the sliding speed stays.
void add_radii(const ExperimentMaker& maker, const Means& means, std::vector<Experiment>& out) {
  const RunConditions& own = maker.own();
  for (const double radius : means.radii) {
    if (is_same(radius, own.radius)) continue;
    RunConditions run = own;
    run.radius = radius;
    out.push_back({{maker.timed(run)}});
    for (const double speed : means.speeds) {
      if (is_same(speed, own.speed) || !is_same(radius * speed, own.radius * own.speed)) continue;
      run.speed = speed;
      out.push_back({{maker.timed(run)}});
    }
  }
  if (means.radii.size() < 2) return;
  const auto [inner, outer] = std::minmax_element(means.radii.begin(), means.radii.end());
  for (const double fast : means.speeds) {
    for (const double slow : means.speeds) {
      if (!(fast > slow) || !is_same(*inner * fast, *outer * slow)) continue;
      RunConditions near = own, far = own;
      near.radius = *inner, near.speed = fast;
      far.radius = *outer, far.speed = slow;
      out.push_back({{maker.timed(near, 2), maker.timed(far, 2)}});
    }
  }
}

/// Experiments with one condition of the record changed to each value.
void add_values(const ExperimentMaker& maker, const std::vector<double>& values, double RunConditions::*condition,
                std::vector<Experiment>& out) {
  for (const double value : values) {
    if (is_same(value, maker.own().*condition)) continue;
    RunConditions run = maker.own();
    run.*condition = value;
    out.push_back({{maker.timed(run)}});
  }
}

}  // namespace

double Experiment::duration() const {
  double sum = 0;
  for (const RunConditions& run : runs) sum += run.duration;
  return sum;
}

RunConditions conditions_of_record(const OpenQuestion& question, const Identification& trace) {
  const Machine& machine = question.machines.front().machine;
  return {.radius = machine.radius,
          .speed = machine.speed,
          .load = machine.load,
          .stiffness = machine.rig.stiffness,
          .duration = trace.duration,
          .rate = question.record.rate};
}

Means usual_means(const Identification& trace, double longest) {
  Means means;
  means.longest = longest;
  for (const double part : kUsualSpeeds) means.speeds.push_back(settable(part * trace.motion.conditions.speed.value));
  return means;
}

std::vector<Experiment> experiments_for(const OpenQuestion& question, const Identification& trace, const Means& means) {
  const ExperimentMaker maker(question, trace, means);
  std::vector<Experiment> out;
  if (means.tap) out.push_back({.runs = {}, .tap = maker.own().rate});
  if (means.lift) out.push_back({.runs = {}, .lift = true});
  add_speeds(maker, means, out);
  add_radii(maker, means, out);
  // What is recorded as a force, or without a load, is not known to follow the load.
  const bool load_known =
      trace.motion.friction_kind == FrictionKind::coefficient && trace.motion.conditions.load.known();
  if (load_known) add_values(maker, means.loads, &RunConditions::load, out);
  add_values(maker, means.springs, &RunConditions::stiffness, out);
  if (means.mass_below > 0) add_values(maker, {means.mass_below}, &RunConditions::mass_below, out);
  if (means.longest_pause > 0) out.push_back({{maker.with_pauses()}});
  if (means.reversing) out.push_back({{maker.reversed()}});
  constexpr double kLonger = 3;
  out.push_back({{maker.timed(maker.own(), 1, kLonger)}});
  return out;
}

}  // namespace tribofit
