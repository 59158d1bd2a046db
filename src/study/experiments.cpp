#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "limits.hpp"
#include "open_question.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {

namespace {

bool is_same(double a, double b) {
  return std::abs(a - b) <= kSameAsRecord * std::max(std::abs(a), std::abs(b));
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

/// Makes experiments whose runs are as long as they need to be, within the time.
class ExperimentMaker {
 public:
  ExperimentMaker(const OpenQuestion& question, const Means& means)
      : means_(means), own_(question.own_conditions()), turns_(takes_revolutions(question)) {
    const Segmentation& s = question.own().segmentation;
    if (!means.rates.empty()) own_.rate = *std::max_element(means.rates.begin(), means.rates.end());
    stick_ = s.stick_time.value;
    slip_ = s.slip_time.value;
    cycles_ = std::clamp(static_cast<double>(s.cycles.size()), kFewestPlannedCycles, kMostPlannedCycles);
  }

  std::vector<Experiment> make(bool load_known) {
    if (means_.tap) made_.push_back({.runs = {}, .tap = own_.rate});
    if (means_.lift) made_.push_back({.runs = {}, .lift = true});
    change_speed();
    change_radius();
    if (load_known) change(means_.loads, &RunConditions::load);
    change(means_.springs, &RunConditions::stiffness);
    if (means_.mass_below > 0) change({means_.mass_below}, &RunConditions::mass_below);
    if (means_.longest_pause > 0) made_.push_back({{with_pauses()}});
    if (means_.reversing) made_.push_back({{reversed()}});
    constexpr double kLonger = 3;
    made_.push_back({{timed(own_, 1, kLonger)}});
    return std::move(made_);
  }

 private:
  static constexpr double kCyclesBetweenPauses = 6, kCyclesOfTurn = 20, kTurns = 6;
  static constexpr std::size_t kPlannedPauses = 12;

  /// The run with the duration that it takes, for `parts` runs of an experiment.
  RunConditions timed(RunConditions run, double parts = 1, double longer = 1) const {
    double needed = cycles_ * longer * period(run);
    if (turns_) {
      needed = std::max({needed, longer * kPlannedRevolutions * 2 * std::numbers::pi / run.speed, 2 * own_.duration});
    }
    run.duration = std::min({needed, means_.longest / parts, kMostSimulatedCycles / parts * period(run)});
    return run;
  }

  /// From break-away to break-away: the spring is wound up at the speed of the disc, and the block slips in a time that
  /// its rig sets.
  double period(const RunConditions& run) const {
    const double wound = (run.load / own_.load) * (own_.stiffness / run.stiffness);
    const double by_speed = own_.radius * own_.speed / (run.radius * run.speed);
    return stick_ * wound * by_speed + slip_ * std::sqrt(own_.stiffness / run.stiffness);
  }

  RunConditions at(double radius, double speed) const {
    RunConditions run = own_;
    run.radius = radius;
    run.speed = speed;
    return run;
  }
  void add(const RunConditions& run) { made_.push_back({{timed(run)}}); }
  void add(const RunConditions& first, const RunConditions& second) {
    made_.push_back({{timed(first, 2), timed(second, 2)}});
  }

  /// Experiments with one condition of the record changed to each value.
  void change(const std::vector<double>& values, double RunConditions::*condition) {
    for (const double value : values) {
      if (is_same(value, own_.*condition)) continue;
      RunConditions run = own_;
      run.*condition = value;
      add(run);
    }
  }

  /// To each of the speeds, and to the lowest and the highest.
  void change_speed() {
    change(means_.speeds, &RunConditions::speed);
    std::vector<double> other = means_.speeds;
    std::erase_if(other, [&](double speed) { return is_same(speed, own_.speed); });
    if (other.size() < 2) return;
    const auto [slow, fast] = std::minmax_element(other.begin(), other.end());
    add(at(own_.radius, *slow), at(own_.radius, *fast));
  }

  /// Other radii: at the speed of the record, and so that the sliding speed stays.
  void change_radius() {
    for (const double radius : means_.radii) {
      if (is_same(radius, own_.radius)) continue;
      add(at(radius, own_.speed));
      for (const double speed : means_.speeds) {
        if (!is_same(speed, own_.speed) && is_same(radius * speed, own_.radius * own_.speed)) add(at(radius, speed));
      }
    }
    if (means_.radii.size() < 2) return;
    const auto [inner, outer] = std::minmax_element(means_.radii.begin(), means_.radii.end());
    for (const double fast : means_.speeds) {
      for (const double slow : means_.speeds) {
        if (fast > slow && is_same(*inner * fast, *outer * slow)) add(at(*inner, fast), at(*outer, slow));
      }
    }
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
      if (t + length + between > means_.longest) continue;
      run.pauses.push_back({t, length});
      t += length + between;
    }
    run.duration = std::min(means_.longest, t + between);
    return run;
  }

  RunConditions reversed() const {
    RunConditions run = own_;
    run.reversing = 1 / (kCyclesOfTurn * period(run));
    run.duration = std::min(means_.longest, kTurns / run.reversing);
    return run;
  }

  const Means& means_;
  RunConditions own_;
  bool turns_;
  double stick_ = 0, slip_ = 0, cycles_ = 0;
  std::vector<Experiment> made_;
};

}  // namespace

double Experiment::duration() const {
  double sum = 0;
  for (const RunConditions& run : runs) sum += run.duration;
  return sum;
}

RunConditions OpenQuestion::own_conditions() const {
  const Machine& machine = machines.front().machine;
  return {.radius = machine.radius,
          .speed = machine.speed,
          .load = machine.load,
          .stiffness = machine.rig.stiffness,
          .duration = own().duration,
          .rate = record.rate};
}

Means usual_means(const Identification& trace, double longest) {
  Means means;
  means.longest = longest;
  for (const double part : kUsualSpeeds) means.speeds.push_back(settable(part * trace.motion.conditions.speed.value));
  return means;
}

std::vector<Experiment> experiments_for(const OpenQuestion& question, const Means& means) {
  const Motion& motion = question.own().motion;
  // What is recorded as a force, or without a load, is not known to follow the load.
  const bool load_known = motion.friction_kind == FrictionKind::coefficient && motion.conditions.load.known();
  return ExperimentMaker(question, means).make(load_known);
}

}  // namespace tribofit
