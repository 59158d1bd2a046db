#include "tribofit/study/settled.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/steady_sliding.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/study/smoothed.hpp"

namespace tribofit {

namespace {

double natural_period(const Machine& machine) {
  return 2 * std::numbers::pi / machine.rig.natural_frequency();
}

/// Longest time of one stick and one slip: the spring is wound up from one static limit to the other.
double longest_cycle(const Machine& machine) {
  const double deflection = 2 * machine.parameters[0] * machine.load / machine.rig.stiffness;
  return natural_period(machine) + deflection / machine.disc_velocity();
}

/// One stick-slip cycle, from break-away to break-away.
struct SeenCycle {
  double begin = 0, period = 0, stick_time = 0, peak_to_peak = 0, peak_speed = 0;
};

std::vector<SeenCycle> cycles_of(const SimulatedMotion& motion) {
  std::vector<const SimulatedSlip*> begins;
  for (const SimulatedSlip& slip : motion.slips) {
    if (slip.stick_time > 0 && slip.break_away_time >= 0) begins.push_back(&slip);
  }
  std::vector<SeenCycle> cycles;
  auto turn = motion.turning_points.begin();
  for (std::size_t k = 0; k + 1 < begins.size(); ++k) {
    const double begin = begins[k]->break_away_time, end = begins[k + 1]->break_away_time;
    while (turn != motion.turning_points.end() && turn->time < begin) ++turn;
    Extremes swing{INFINITY, -INFINITY};
    for (; turn != motion.turning_points.end() && turn->time < end; ++turn) swing.take(turn->displacement);
    double fastest = 0;  // a stick may end in more than one slip
    for (const SimulatedSlip* slip = begins[k]; slip != begins[k + 1]; ++slip) {
      fastest = std::max(fastest, slip->peak_speed);
    }
    cycles.push_back({begin, end - begin, begins[k + 1]->stick_time, std::max(0.0, swing.high - swing.low), fastest});
  }
  return cycles;
}

/// The slip in which the record ends and its beginning [s]; nothing where it ends in stick.
std::optional<double> open_slip(const SimulatedMotion& motion) {
  if (motion.slips.empty() || !std::isnan(motion.slips.back().restick_time)) return std::nullopt;
  const double begin = motion.slips.back().break_away_time;
  return std::isnan(begin) ? 0 : std::max(0.0, begin);
}

/// From turning point to turning point between two times [m].
std::vector<double> swings_since(const SimulatedMotion& motion, double begin, double end = INFINITY) {
  std::vector<double> sizes;
  const TurningPoint* before = nullptr;
  for (const TurningPoint& turn : motion.turning_points) {
    if (turn.time < begin || turn.time > end) continue;
    if (before != nullptr) sizes.push_back(std::abs(turn.displacement - before->displacement));
    before = &turn;
  }
  return sizes;
}

/// Whether a motion that slid for `length` [s] without swinging has come to steady sliding: that is stable, and the
/// time was several times that in which deviations from it fall by e.
bool creeps_to_rest(const Machine& machine, double length) {
  return length * steady_sliding(machine).growth_rate() < -kTimesToRest;
}

bool alike(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance * std::max(std::abs(a), std::abs(b));
}

class Settling {
 public:
  Settling(const Machine& machine, const SettleOptions& options)
      : machine_(machine), options_(options), period_(natural_period(machine)) {}

  Settled run() {
    const bool winds_up = options_.start != StartFrom::sliding;
    const double cycle = longest_cycle(machine_), most_cycles = options_.longest_cycles * cycle;
    for (double duration = winds_up ? 4 * cycle + 4 * period_ : 20 * period_;; duration *= 4) {
      SimulatedMotion motion;
      try {
        motion = motion_of(machine_, {.duration = duration, .rate = 0, .start = start_of(machine_, options_.start)},
                           options_.sharpness);
      } catch (const InputError& error) {
        out_.seen = error.problem();
        return out_;
      }
      out_ = {};
      out_.simulated = duration;
      const std::optional<double> since = open_slip(motion);
      out_.sticks = !since || duration - *since <= kLongestSlip * period_;
      if (out_.sticks ? judge_cycles(cycles_of(motion)) : judge_swings(motion, *since)) return out_;
      if (duration >= (out_.sticks ? most_cycles : options_.longest_swings * period_)) return out_;
    }
  }

 private:
  void measure(const SeenCycle& cycle) {
    out_.frequency = 1 / cycle.period;
    out_.stick_time = cycle.stick_time;
    out_.peak_to_peak = cycle.peak_to_peak;
    out_.energy = 0.5 * machine_.rig.stiffness * cycle.peak_to_peak * cycle.peak_to_peak;
    out_.peak_speed = cycle.peak_speed;
    out_.begin = cycle.begin;
  }
  bool slides() {
    out_.regime = Regime::sliding;
    out_.peak_to_peak = out_.energy = 0;
    out_.peak_speed = machine_.disc_velocity();
    return true;
  }
  bool judge_cycles(const std::vector<SeenCycle>& cycles);
  bool judge_swings(const SimulatedMotion& motion, double since);
  double fastest_of_vibration(const TurningPoint& from) const;

  const Machine& machine_;
  const SettleOptions& options_;
  double period_;
  Settled out_;
};

bool Settling::judge_cycles(const std::vector<SeenCycle>& cycles) {
  if (cycles.size() < 3) {
    out_.seen = fmt::format("{} break-aways in {} s", cycles.size(), general(out_.simulated, 3));
    return false;
  }
  const SeenCycle& last = cycles.back();
  measure(last);
  const bool settled = std::all_of(cycles.end() - 3, cycles.end(), [&](const SeenCycle& c) {
    return alike(c.period, last.period, options_.tolerance) &&
           alike(c.peak_to_peak, last.peak_to_peak, options_.tolerance);
  });
  if (settled) {
    out_.regime = Regime::stick_slip;
    return true;
  }
  const std::span<const SeenCycle> late = std::span(cycles).subspan(cycles.size() / 2);
  SeenCycle mean{.begin = last.begin};
  Extremes period{last.period, last.period}, size{last.peak_to_peak, last.peak_to_peak};
  for (const SeenCycle& c : late) {
    const double share = 1 / static_cast<double>(late.size());
    mean.period += share * c.period;
    mean.stick_time += share * c.stick_time;
    mean.peak_to_peak += share * c.peak_to_peak;
    mean.peak_speed += share * c.peak_speed;
    period.take(c.period);
    size.take(c.peak_to_peak);
  }
  measure(mean);
  out_.seen = fmt::format(
      "stick-slip that does not repeat itself: over the last {} cycles of {} s the period goes from {} to {} s, "
      "peak-to-peak from {} to {} mm",
      late.size(), general(out_.simulated, 3), general(period.low), general(period.high), general(1e3 * size.low),
      general(1e3 * size.high));
  return false;
}

/// Largest |v_r| of a vibration that begins at a turning point.
double Settling::fastest_of_vibration(const TurningPoint& from) const {
  const SimulatedMotion motion = motion_of(
      machine_, {.duration = 2 * period_, .rate = 0, .start = BlockStart{from.displacement, 0}}, options_.sharpness);
  return motion.slips.empty() ? machine_.disc_velocity() : motion.slips.back().peak_speed;
}

bool Settling::judge_swings(const SimulatedMotion& motion, double since) {
  const std::vector<double> swings = swings_since(motion, since);
  // Swings below this are rounding of the displacement [m].
  const double still =
      kRoundings * std::numeric_limits<double>::epsilon() * std::abs(steady_sliding(machine_).displacement);
  if (swings.size() < 5 || *std::max_element(swings.begin(), swings.end()) < still) {
    // What does not swing creeps to its place, unless it runs away from it.
    if (creeps_to_rest(machine_, out_.simulated - since)) return slides();
    out_.seen = fmt::format("sliding without a stick, {} swings in {} s", swings.size(), general(out_.simulated, 3));
    return false;
  }
  const std::vector<TurningPoint>& turns = motion.turning_points;
  const double first = *std::max_element(swings.begin(), swings.end());
  const double last = swings.back(), change = last / swings[swings.size() - 3] - 1;
  const bool dies_out = (change < 0 && last < kSmallSwing * first) || last < std::max(kGoneSwing * first, still);
  const TurningPoint& end = turns.back();
  if (dies_out && steady_sliding(machine_).is_stable()) {
    out_.begin = end.time;
    return slides();
  }
  measure({.begin = end.is_maximum ? end.time : turns[turns.size() - 2].time,
           .period = end.time - turns[turns.size() - 3].time,
           .peak_to_peak = last,
           .peak_speed = std::numeric_limits<double>::quiet_NaN()});
  if (std::abs(change) < kSteadySwing * options_.tolerance) {
    out_.regime = Regime::vibration;
    out_.peak_speed = fastest_of_vibration(end);
    return true;
  }
  out_.seen = fmt::format("vibration without a stick whose peak-to-peak of {} mm still {} by {} % a cycle after {} s",
                          general(1e3 * last, 4), change < 0 ? "falls" : "grows", general(1e2 * std::abs(change), 2),
                          general(out_.simulated, 3));
  return false;
}

/// Whether these cycles of a motion that still sticks go on for ever: a bare law begins each at the same break-away,
/// others must not shrink one after the other, as those do in which a fast disc has set the block swinging and it comes
/// near the speed of the disc for a while.
bool goes_on(const std::vector<SeenCycle>& cycles, bool bare) {
  if (bare) return !cycles.empty();
  const std::size_t n = cycles.size();
  if (n < 4) return false;
  for (std::size_t k = n - 3; k < n; ++k) {
    if (cycles[k].peak_to_peak > (1 - kShrinks) * cycles[k - 1].peak_to_peak) return true;
  }
  return false;
}

}  // namespace

std::string_view to_string(Regime regime) {
  constexpr std::string_view kNames[] = {"stick-slip", "vibration", "sliding", "not-settled"};
  return kNames[static_cast<std::size_t>(regime)];
}

SimulatedMotion motion_of(const Machine& machine, const SimulationOptions& options, double sharpness) {
  if (sharpness == 0) return simulate(machine.rig, machine.drive(), machine.model, machine.parameters, options);
  const SmoothedLaw law = smoothed_law(machine.model, machine.parameters, sharpness);
  return simulate_smoothed(machine.rig, machine.drive(), law,
                           {.duration = options.duration,
                            .rate = options.rate,
                            .settle = options.settle,
                            .start = options.start.value_or(BlockStart{0, machine.disc_velocity()})});
}

std::optional<BlockStart> start_of(const Machine& machine, StartFrom start) {
  if (start == StartFrom::stick) return std::nullopt;
  if (start == StartFrom::rest) return BlockStart{};
  constexpr double kPush = 1e-3;
  return BlockStart{steady_sliding(machine).displacement, kPush * machine.disc_velocity()};
}

namespace {

/// Refuses machines that cannot be, or that creep to steady sliding for too long, by their damping or by friction that
/// rises with speed; what cannot be integrated afterwards does not settle.
void require_machine(const Machine& machine) {
  const SteadySliding sliding = steady_sliding(machine);
  const bool creeps = sliding.is_stable() && sliding.eigenvalues.front().imag() == 0;
  const double ratio = creeps ? machine.rig.natural_frequency() / (-2 * sliding.growth_rate()) : 0;
  if (ratio <= kMostDampingRatio) return;
  throw InputError(fmt::format("the block creeps as by a damping ratio of {}; motions are studied up to {}",
                               general(ratio, 3), general(kMostDampingRatio)),
                   "give less damping, or friction that rises less with speed");
}

}  // namespace

Settled settle(const Machine& machine, const SettleOptions& options) {
  require_machine(machine);
  if (options.sharpness > 0) smoothed_law(machine.model, machine.parameters, options.sharpness);
  return Settling(machine, options).run();
}

bool keeps_sticking(const Machine& machine, double sharpness) {
  require_machine(machine);
  const double period = natural_period(machine), cycle = longest_cycle(machine);
  const bool bare = machine.model.effects().empty();
  const double most = std::max(kCyclesThatStick * cycle, (bare ? 2000 : 500) * period);
  // The first slip shows it for most machines.
  double duration = bare ? 2 * cycle : 0.5 * cycle + (kLongestSlip + 1) * period;
  while (true) {
    const SimulatedMotion motion = motion_of(machine, {.duration = duration, .rate = 0}, sharpness);
    const std::optional<double> since = open_slip(motion);
    if (since && duration - *since > kLongestSlip * period) {
      const std::vector<double> swings = swings_since(motion, *since);
      const std::size_t n = swings.size();
      // Without memory the flow is planar: swings that shrink always will, and those that grow may reach the disc yet.
      const bool dies_out =
          n >= 4 ? swings[n - 1] < (1 + kSameSwing) * swings[n - 3] : creeps_to_rest(machine, duration - *since);
      if (dies_out) return false;
      if (bare && goes_on(cycles_of(motion), bare)) return true;
      if (duration >= most) return false;
    } else if (goes_on(cycles_of(motion), bare) ||
               (duration >= kCyclesThatStick * cycle && (bare || duration >= most))) {
      return true;
    }
    duration = std::max(kCyclesThatStick * cycle, 4 * duration);
  }
}

Swings swings_from(const Machine& machine, double velocity, double periods) {
  const SimulatedMotion motion =
      motion_of(machine, {.duration = periods * natural_period(machine),
                          .rate = 0,
                          .start = BlockStart{steady_sliding(machine).displacement, velocity}});
  Swings out;
  const double first_stick = motion.slips.empty() ? 0 : motion.slips.front().restick_time;
  out.sticks = !std::isnan(first_stick);
  out.sizes = swings_since(motion, 0, out.sticks ? first_stick : INFINITY);
  return out;
}

SimulatedMotion settled_motion(const Machine& machine, const Settled& settled, std::size_t cycles, std::size_t samples,
                               const SettleOptions& options) {
  const double period = std::isnan(settled.frequency) ? natural_period(machine) : 1 / settled.frequency;
  return motion_of(machine,
                   {.duration = static_cast<double>(cycles) * period,
                    .rate = static_cast<double>(samples) / period,
                    .settle = settled.begin,
                    .start = start_of(machine, options.start)},
                   options.sharpness);
}

}  // namespace tribofit
