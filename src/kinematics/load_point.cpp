#include "load_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "channel_samples.hpp"
#include "limits.hpp"
#include "motion_channels.hpp"
#include "statistics/piecewise_lines.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {

namespace {

/// The integral of a recorded speed.
std::vector<double> displacement_from(const std::vector<double>& time, const std::vector<double>& speed) {
  std::vector<double> out(time.size(), 0.0);
  for (std::size_t i = 1; i < time.size(); ++i)
    out[i] = out[i - 1] + 0.5 * (speed[i - 1] + speed[i]) * (time[i] - time[i - 1]);
  return out;
}

/// Stretches of one speed.
std::vector<LoadPointPhase> phases_of(const std::vector<double>& time, const std::vector<double>& displacement) {
  std::vector<LoadPointPhase> out;
  for (const LinePiece& piece : piecewise_lines(time, displacement))
    out.push_back({piece.begin, piece.is_level ? 0 : piece.slope, piece.on_ramp && !piece.is_level});
  return out;
}

/// A phase with its samples of a recorded speed.
struct Recorded {
  LoadPointPhase phase;
  double sum = 0, count = 0;
  double mean() const { return count > 0 ? sum / count : phase.speed; }
};

/// The integral of a noisy speed wanders, and has corners where nobody set any: neighbours whose mean speeds differ by
/// no more than the noise does are one phase, the least different first.
std::vector<LoadPointPhase> without_corners_of_noise(const std::vector<double>& time, const std::vector<double>& speed,
                                                     const std::vector<LoadPointPhase>& phases) {
  std::vector<double> changes;
  for (std::size_t i = 1; i < speed.size(); ++i) changes.push_back(std::abs(speed[i] - speed[i - 1]));
  const double noise = changes.empty() ? 0 : kSigmaPerMad * median(std::move(changes)) / std::numbers::sqrt2;
  if (!(noise > 0)) return phases;
  std::vector<Recorded> all;
  for (const LoadPointPhase& phase : phases) all.push_back({phase});
  for (std::size_t i = 0, k = 0; i < speed.size() && !all.empty(); ++i) {
    while (k + 1 < all.size() && all[k + 1].phase.begin <= time[i]) ++k;
    all[k].sum += speed[i];
    all[k].count += 1;
  }
  while (all.size() > 1) {
    std::size_t faintest = 0;
    double least = kSpeedsOfNoise;
    for (std::size_t k = 1; k < all.size(); ++k) {
      const double error = noise * std::sqrt(1 / std::max(1.0, all[k - 1].count) + 1 / std::max(1.0, all[k].count));
      const double apart = std::abs(all[k].mean() - all[k - 1].mean()) / error;
      if (apart < least) least = apart, faintest = k;
    }
    if (faintest == 0) break;
    Recorded& kept = all[faintest - 1];
    kept.sum += all[faintest].sum;
    kept.count += all[faintest].count;
    kept.phase.speed = kept.mean();
    kept.phase.on_ramp = kept.phase.on_ramp && all[faintest].phase.on_ramp;
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(faintest));
  }
  std::vector<LoadPointPhase> out;
  for (const Recorded& r : all) out.push_back(r.phase);
  return out;
}

/// Phases of one direction, and how many samples lie before and behind them.
struct OneWay {
  std::vector<LoadPointPhase> phases;
  std::size_t head = 0, tail = 0;
};

/// Sliding has one direction, which counts as forwards. A machine goes back before or behind a test: what lies between
/// is used. Creep during a hold is no way back.
OneWay one_way(const Trace& trace, std::vector<LoadPointPhase> phases, std::vector<std::string>& notes) {
  const double end = trace.time.back();
  const auto end_of = [&](std::size_t i) { return i + 1 < phases.size() ? phases[i + 1].begin : end; };
  double on = 0, back = 0, fastest = 0;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    (phases[i].speed < 0 ? back : on) += phases[i].speed == 0 ? 0 : end_of(i) - phases[i].begin;
    fastest = std::max(fastest, std::abs(phases[i].speed));
  }
  std::vector<std::size_t> turns;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    if (back > on) phases[i].speed = -phases[i].speed;
    if (phases[i].speed < 0 && -phases[i].speed < kCreepOfHold * fastest) phases[i].speed = 0;
    if (phases[i].speed < 0) turns.push_back(i);
  }
  if (turns.empty()) return {std::move(phases), 0, 0};
  std::size_t first = 0, last = 0, begin = 0;
  turns.push_back(phases.size());
  const auto time_of = [&](std::size_t i) { return i < phases.size() ? phases[i].begin : end; };
  for (const std::size_t turn : turns) {
    if (turn > begin && time_of(turn) - time_of(begin) > time_of(last) - time_of(first)) first = begin, last = turn;
    begin = turn + 1;
  }
  const double turned = phases[turns.front()].begin;
  if (time_of(last) - time_of(first) < kLeastOneWay * (end - trace.time.front()))
    throw InputError(fmt::format("the load point turns round at {} s", general(turned, 6)),
                     "velocity steps have one direction: cut the record, or read it as --kind sliding",
                     {trace.path, 0, ""});
  OneWay out;
  const auto at = [&](double t) { return std::lower_bound(trace.time.begin(), trace.time.end(), t); };
  if (first > 0) out.head = static_cast<std::size_t>(at(time_of(first)) - trace.time.begin());
  if (last < phases.size()) out.tail = static_cast<std::size_t>(trace.time.end() - at(time_of(last)));
  out.phases.assign(phases.begin() + static_cast<std::ptrdiff_t>(first),
                    phases.begin() + static_cast<std::ptrdiff_t>(last));
  notes.push_back(
      fmt::format("the load point turns round at {} s: only the record from {} s to {} s, in "
                  "which it goes one way, is used",
                  general(turned, 6), general(time_of(first), 6), general(time_of(last), 6)));
  return out;
}

/// Whether the load point rests between two slides of the same speed, or for long beside one of them.
bool has_hold(const std::vector<LoadPointPhase>& phases, const std::vector<double>& time) {
  for (std::size_t i = 1; i + 1 < phases.size(); ++i) {
    const LoadPointPhase &before = phases[i - 1], &rest = phases[i], &behind = phases[i + 1];
    if (rest.speed != 0 || !(before.speed > 0) || !(behind.speed > 0)) continue;
    const double end = i + 2 < phases.size() ? phases[i + 2].begin : time.back();
    const double shorter = std::min(rest.begin - before.begin, end - behind.begin);
    const bool same = std::abs(std::log(behind.speed / before.speed)) < kSameSpeed;
    if (same || behind.begin - rest.begin > kPassageBeside * shorter) return true;
  }
  return false;
}

void drop_ends_of(Trace& trace, std::size_t head, std::size_t tail) {
  for (std::vector<double>* channel : {&trace.time, &trace.friction, &trace.load, &trace.temperature})
    drop_ends(*channel, head, tail);
  trace.steps = steps_within(trace.steps, head, trace.size());
}

/// Lone samples, marker values and what a loose plug leaves of friction take no part. Behind a change of speed a lone
/// sample may be the answer, of which few samples were taken. Few samples: nothing is known of what is usual.
void leave_out_faults(Trace& trace, Motion& motion) {
  ChannelSamples friction(trace.friction);
  find_outliers_and_held(friction, ChannelSamples(trace.velocity), false);
  const auto answers = [&](const SampleSpan& span) {
    return std::any_of(motion.load_point.begin(), motion.load_point.end(), [&](const LoadPointPhase& phase) {
      const auto at = std::upper_bound(trace.time.begin(), trace.time.end(), phase.begin) - trace.time.begin();
      const auto first = static_cast<std::size_t>(at);
      return span.end + kAnswerOfStep > first && span.begin < first + kAnswerOfStep;
    });
  };
  std::vector<SampleSpan> spans;
  for (const auto* found : {&friction.outliers, &friction.held})
    std::copy_if(found->begin(), found->end(), std::back_inserter(spans), [&](const auto& s) { return !answers(s); });
  if (spans.empty()) return;
  std::sort(spans.begin(), spans.end(), [](const auto& a, const auto& b) { return a.begin < b.begin; });
  bridge(spans, trace.friction);
  motion.faults.assign(trace.size(), 0);
  std::size_t samples = 0;
  for (const SampleSpan& span : spans) {
    samples += span.size();
    std::fill(motion.faults.begin() + static_cast<std::ptrdiff_t>(span.begin),
              motion.faults.begin() + static_cast<std::ptrdiff_t>(span.end), SampleFault::friction);
  }
  motion.notes.push_back(fmt::format(
      "friction: {} {} left out, the first at {} s: far from all beside {}, or one value again and again", samples,
      samples == 1 ? "sample" : "samples", general(trace.time[spans.front().begin], 6), samples == 1 ? "it" : "them"));
}

/// Friction that opposes sliding is positive.
void settle_sign(std::vector<double>& friction, std::vector<std::string>& notes) {
  const auto below = std::count_if(friction.begin(), friction.end(), [](double mu) { return mu < 0; });
  if (2 * static_cast<std::size_t>(below) <= friction.size()) return;
  for (double& mu : friction) mu = -mu;
  notes.emplace_back("friction: sign reversed so that it opposes sliding");
}

}  // namespace

Motion motion_of_load_point(Trace trace) {
  Motion motion;
  motion.step = trace.interval();
  std::vector<double> displacement;
  if (!trace.load_point.empty()) {
    motion.load_point = trace.load_point;
    motion.load_point_source = LoadPointSource::stated;
  } else if (!trace.load_point_speed.empty()) {
    displacement = displacement_from(trace.time, trace.load_point_speed);
    motion.load_point_source = LoadPointSource::speed;
  } else {
    displacement = std::move(trace.drive_position);
  }
  if (motion.load_point.empty()) motion.load_point = phases_of(trace.time, displacement);
  if (motion.load_point_source == LoadPointSource::speed)
    motion.load_point = without_corners_of_noise(trace.time, trace.load_point_speed, motion.load_point);
  if (trace.size() > 1) {
    OneWay used = one_way(trace, std::move(motion.load_point), motion.notes);
    motion.load_point = std::move(used.phases);
    drop_ends_of(trace, used.head, used.tail);
    settle_sign(trace.friction, motion.notes);
  }
  trace.velocity_kind = VelocityKind::relative;
  trace.velocity.assign(trace.size(), 0.0);
  for (std::size_t i = 0, phase = 0; i < trace.size() && !motion.load_point.empty(); ++i) {
    while (phase + 1 < motion.load_point.size() && motion.load_point[phase + 1].begin <= trace.time[i]) ++phase;
    trace.velocity[i] = motion.load_point[phase].speed;
  }
  leave_out_faults(trace, motion);
  if (has_hold(motion.load_point, trace.time) && trace.kind_source != "stated")
    trace.kind = RecordKind::slide_hold_slide;
  require_channels(trace);
  take_kinds(trace, {}, motion);
  take_channels(trace, motion);
  motion.normal_stress = trace.normal_stress;
  return motion;
}

}  // namespace tribofit::kinematics
