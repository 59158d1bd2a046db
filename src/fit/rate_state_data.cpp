#include "rate_state_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "kinematics/limits.hpp"
#include "limits.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::fit {

namespace {

/// A stretch of sliding at one speed, or nearly one.
struct Sliding {
  std::size_t phase = 0, last_phase = 0;  ///< the first and the last of it
  std::size_t longest = 0;                ///< phase, whose speed is that of all
  double begin = 0, end = 0, speed = 0;
  bool behind_rest = false;  ///< and not behind another sliding
  double duration() const { return end - begin; }
  double length() const { return speed * duration(); }
};

/// Whether what lies between two slidings is short beside both, in time and in length.
bool is_short(std::span<const Sliding> between, const Sliding& before, const Sliding& behind) {
  double duration = 0, length = 0;
  for (const Sliding& s : between) duration += s.duration(), length += s.length();
  return duration < kinematics::kPassageBeside * std::min(before.duration(), behind.duration()) &&
         length < kinematics::kPassageBeside * std::min(before.length(), behind.length());
}

/// Last of the stretches from `first` on through which a drive passes, without a rest, from the speed before to the one
/// behind; none: `first` is sliding of its own.
std::optional<std::size_t> end_of_passage(const std::vector<Sliding>& all, std::size_t first) {
  const Sliding& before = all[first - 1];
  std::optional<std::size_t> last;
  for (std::size_t i = first; i + 1 < all.size() && !all[i].behind_rest; ++i) {
    if (all[i].end - all[first].begin > before.duration()) break;
    if (!all[i + 1].behind_rest && is_short(std::span(all).subspan(first, i + 1 - first), before, all[i + 1])) last = i;
  }
  return last;
}

/// Sliding between rests and ramps; neighbours of nearly the same speed are one.
std::vector<Sliding> slidings_of(const std::vector<LoadPointPhase>& phases, double end) {
  std::vector<Sliding> out;
  bool behind_rest = false;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const double until = i + 1 < phases.size() ? phases[i + 1].begin : end;
    behind_rest = behind_rest || !(phases[i].speed > 0);
    if (!(phases[i].speed > 0) || phases[i].on_ramp) continue;
    const bool goes_on = !out.empty() && out.back().last_phase + 1 == i &&
                         std::abs(std::log(phases[i].speed / out.back().speed)) < kNoStep;
    if (!goes_on) out.push_back({i, i, i, phases[i].begin, until, phases[i].speed, behind_rest});
    behind_rest = false;
    Sliding& sliding = out.back();
    if (goes_on && until - phases[i].begin > phases[sliding.longest + 1].begin - phases[sliding.longest].begin)
      sliding.longest = i, sliding.speed = phases[i].speed;
    sliding.last_phase = i;
    sliding.end = until;
  }
  return out;
}

/// Stretches of sliding that last.
std::vector<Sliding> lasting(const std::vector<Sliding>& all) {
  std::vector<Sliding> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::optional<std::size_t> passage = i == 0 ? std::nullopt : end_of_passage(all, i);
    if (!passage)
      out.push_back(all[i]);
    else
      i = *passage;
  }
  return out;
}

double rest_between(const std::vector<LoadPointPhase>& phases, double from, double to) {
  double rest = 0;
  for (std::size_t i = 0; i + 1 < phases.size(); ++i) {
    if (phases[i].speed == 0 && phases[i].begin >= from && phases[i + 1].begin <= to)
      rest += phases[i + 1].begin - phases[i].begin;
  }
  return rest;
}

/// Phases of the load point within a window, in which sliding begins.
std::vector<LoadPointPhase> phases_within(const std::vector<LoadPointPhase>& all, double from) {
  std::vector<LoadPointPhase> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i + 1 < all.size() && all[i + 1].begin <= from) continue;
    if (out.empty() && !(all[i].speed > 0)) continue;
    out.push_back(all[i]);
    if (out.size() == 1) out.front().begin = std::max(out.front().begin, from);
  }
  return out;
}

/// Steps between neighbouring stretches of sliding, with the times between which their samples lie. starts: the record
/// begins at rest.
void find_steps(const std::vector<Sliding>& slidings, bool starts, RateStateData& data) {
  for (std::size_t j = 0; j + 1 < slidings.size(); ++j) {
    const Sliding &from = slidings[j], &to = slidings[j + 1];
    VelocityStep step;
    step.time = step.recorded = from.end;
    step.before = from.speed;
    step.after = to.speed;
    const double rest = rest_between(data.phases, from.end, to.begin);
    const bool same_speed = std::abs(std::log(to.speed / from.speed)) < kinematics::kSameSpeed;
    // A drive that changes its speed may pause for it.
    step.hold = same_speed || rest > kinematics::kPassageBeside * std::min(from.duration(), to.duration()) ? rest : 0;
    step.displacement = data.displacement_at(step.time);
    // What was recorded from its begin on slides steadily; behind a run-up or a rest it has yet to.
    const double own = j == 0 && from.phase == 0 && !starts ? 1 : 1 - kPartOfSlidingBehind;
    const double as_long = (1 - kPartOfSlidingBehind) * std::min(from.duration(), to.duration()) * from.speed;
    const double before = std::min(own * from.length(), std::max(as_long, to.length()));
    step.from = from.end - before / from.speed;
    step.to = to.end - (j + 2 < slidings.size() ? (1 - kPartOfSlidingBehind) * to.duration() : 0);
    data.steps.push_back(step);
    data.before.push_back(from.longest);
    data.leaving.push_back(from.last_phase + 1);
    data.behind.push_back(to.phase);
  }
}

bool is_excluded(const RateStateOptions& options, double t) {
  return std::any_of(options.excluded.begin(), options.excluded.end(),
                     [t](const Selection::Stretch& s) { return t >= s.from && t <= s.to; });
}

/// Samples of one step, or values that stand for several each.
struct Samples {
  std::vector<double> time, friction, count, scatter;
};

/// Puts neighbours together so that about `most` values are left: a value holds the samples of a part of the time since
/// the last change of speed.
void add_values(const RateStateData& data, const Samples& samples, std::size_t most, RateStateData& out) {
  const auto last_change = [&](double t) {
    double at = data.phases.front().begin;
    for (const LoadPointPhase& phase : data.phases) {
      if (phase.begin <= t) at = phase.begin;
    }
    return at;
  };
  const std::size_t n = samples.time.size();
  double growth = n > most ? 1e-3 : 0;
  const auto pass = [&](double part, bool write) {
    std::size_t values = 0;
    for (std::size_t i = 0; i < n;) {
      const double change = last_change(samples.time[i]), width = part * (samples.time[i] - change);
      double time = 0, friction = 0, count = 0, scatter = 0;
      const double begin = samples.time[i];
      do {
        const double both = count + samples.count[i], further = samples.friction[i] - friction;
        scatter += samples.scatter[i] + count * samples.count[i] / both * further * further;
        friction += samples.count[i] / both * further;
        time += samples.count[i] * samples.time[i];
        count = both;
        ++i;
      } while (i < n && samples.time[i] - begin < width && last_change(samples.time[i]) == change);
      ++values;
      if (!write) continue;
      out.time.push_back(time / count);
      out.friction.push_back(friction);
      out.count.push_back(count);
      out.scatter.push_back(scatter);
    }
    return values;
  };
  while (growth > 0 && growth < 1 && pass(growth, false) > most) growth *= 1.5;
  pass(growth, true);
}

void set_displacement(RateStateData& data) {
  data.displacement.clear();
  for (const double t : data.time) data.displacement.push_back(data.displacement_at(t));
}

}  // namespace

double shorter_beside(const VelocityStep& step) {
  return std::min(step.time - step.from, step.to - step.time - step.hold);
}

void RateStateData::set_phase_displacements() {
  phase_displacement.assign(phases.size(), 0.0);
  for (std::size_t i = 1; i < phases.size(); ++i)
    phase_displacement[i] = phase_displacement[i - 1] + phases[i - 1].speed * (phases[i].begin - phases[i - 1].begin);
}

double RateStateData::displacement_at(double t) const {
  std::size_t i = 0;
  while (i + 1 < phases.size() && phases[i + 1].begin <= t) ++i;
  return phase_displacement[i] + phases[i].speed * (t - phases[i].begin);
}

RateStateData rate_state_data(const Motion& motion, const RateStateOptions& options, std::size_t most,
                              std::vector<std::string>& messages) {
  RateStateData data;
  data.is_force = motion.friction_kind == FrictionKind::force;
  if (motion.size() < 2) return data;
  const double begin = std::max(options.from, motion.time.front()), end = std::min(options.to, motion.time.back());
  data.phases = phases_within(motion.load_point, begin);
  if (data.phases.empty()) return data;
  while (data.phases.size() > 1 && data.phases.back().begin >= end) data.phases.pop_back();
  data.set_phase_displacements();
  find_steps(lasting(slidings_of(data.phases, end)), data.phases.front().begin > begin, data);
  data.reference_speed = options.reference_speed > 0 ? options.reference_speed
                         : data.steps.empty()        ? data.phases.front().speed
                                                     : data.steps.front().before;

  std::vector<VelocityStep> steps = std::exchange(data.steps, {});
  const std::vector<std::size_t> before = std::exchange(data.before, {}), leaving = std::exchange(data.leaving, {}),
                                 behind = std::exchange(data.behind, {});
  for (std::size_t s = 0; s < steps.size(); ++s) {
    VelocityStep& step = steps[s];
    step.from = std::max(step.from, begin);
    step.to = std::min(step.to, end);
    Samples samples;
    std::size_t earlier = 0;
    const auto first = std::lower_bound(motion.time.begin(), motion.time.end(), step.from) - motion.time.begin();
    std::vector<double> intervals;
    double around = 0;  // longest sampling interval at the step
    for (auto i = static_cast<std::size_t>(first); i < motion.size() && motion.time[i] <= step.to; ++i) {
      if (is_excluded(options, motion.time[i]) || motion.has_fault(i, SampleFault::any)) continue;
      if (motion.time[i] < step.time) ++earlier;
      if (!samples.time.empty()) {
        const double last = samples.time.back(), interval = motion.time[i] - last;
        if (motion.time[i] > step.time) intervals.push_back(interval);
        if (last <= step.time && motion.time[i] >= step.time - interval) around = std::max(around, interval);
      }
      samples.time.push_back(motion.time[i]);
      samples.friction.push_back(motion.friction[i]);
    }
    step.samples = samples.time.size();
    if (2 * earlier < kFewestBehindStep || step.samples - earlier < kFewestBehindStep) {
      messages.push_back(fmt::format("the step at {} s was not used: {} samples before and {} behind it",
                                     general(step.time, 6), earlier, step.samples - earlier));
      continue;
    }
    step.interval = quantile(std::move(intervals), 0.1);
    if (motion.load_point_source == LoadPointSource::stated) step.slack = kSlackOfStated * shorter_beside(step);
    if (motion.load_point_source == LoadPointSource::speed) step.slack = around;
    data.begins.push_back(data.time.size());
    data.steps.push_back(step);
    data.before.push_back(before[s]);
    data.leaving.push_back(leaving[s]);
    data.behind.push_back(behind[s]);
    samples.count.assign(samples.time.size(), 1.0);
    samples.scatter.assign(samples.time.size(), 0.0);
    add_values(data, samples, most, data);
  }
  set_displacement(data);
  return data;
}

RateStateData thinned(const RateStateData& data, std::size_t most) {
  RateStateData out = data;
  out.time.clear();
  out.friction.clear();
  out.count.clear();
  out.scatter.clear();
  out.begins.clear();
  for (std::size_t s = 0; s < data.begins.size(); ++s) {
    const auto begin = static_cast<std::ptrdiff_t>(data.begins[s]), end = static_cast<std::ptrdiff_t>(data.end_of(s));
    const auto part = [&](const std::vector<double>& all) {
      return std::vector<double>(all.begin() + begin, all.begin() + end);
    };
    const Samples samples = {part(data.time), part(data.friction), part(data.count), part(data.scatter)};
    out.begins.push_back(out.time.size());
    add_values(data, samples, most, out);
  }
  set_displacement(out);
  return out;
}

}  // namespace tribofit::fit
