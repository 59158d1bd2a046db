#include "recorded_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "limits.hpp"
#include "resolution.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

using Status = HealthItem::Status;

/// A pause of the disc is no fault: the block is at rest, the spring still pulls, and without noise neither changes.
SampleSpan longest_still(std::span<const double> friction, std::span<const double> velocity) {
  SampleSpan longest;
  if (friction.size() != velocity.size()) return longest;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < friction.size(); ++i) {
    if (friction[i] != friction[i - 1] || velocity[i] != velocity[i - 1]) begin = i;
    const bool pauses = velocity[i] == 0 && friction[i] != 0;
    if (!pauses && i + 1 - begin > longest.size()) longest = {begin, i + 1};
  }
  return longest;
}

double percent(std::size_t part, std::size_t whole) {
  return 100 * static_cast<double>(part) / static_cast<double>(whole);
}

std::string counted(std::size_t count, const char* noun, const char* plural = "s") {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : plural);
}

/// Adds to what a check says: the first finding takes the place of "ok".
void add_finding(Status status, const std::string& sentence, HealthItem& item) {
  item.message = item.status == Status::ok ? sentence : item.message + "; " + sentence;
  item.status = std::max(item.status, status);
}

struct Gaps {
  std::size_t count = 0;
  double longest = 0;  // [s]
};

Gaps gaps_of(std::span<const double> time, double step) {
  Gaps gaps;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double interval = time[i] - time[i - 1];
    gaps.count += interval > kGapInterval * step ? 1U : 0U;
    gaps.longest = std::max(gaps.longest, interval);
  }
  return gaps;
}

/// Whether the block moves in these stretches: friction without noise at a limit may be that of a block at rest.
bool moves_in(const std::vector<SampleSpan>& spans, const Trace& trace, const ChannelSamples& velocity) {
  if (trace.velocity_kind != VelocityKind::relative || trace.velocity.size() != trace.size()) return true;
  std::vector<double> speeds;
  for (const SampleSpan& span : spans) {
    for (std::size_t i = span.begin; i < span.end; ++i) speeds.push_back(std::abs(trace.velocity[i]));
  }
  const double usual = std::max(std::abs(velocity.usual.low), std::abs(velocity.usual.high));
  return speeds.empty() || median(std::move(speeds)) > kOfUsualSpeed * usual;
}

/// An end of the velocity's range at which it rests in stick; where that is not known, what gathers may rest there.
bool is_rest(const RangeEnd& end, double range, const std::optional<LevelRange>& plateau) {
  if (!plateau) return !end.is_quiet || end.spans.empty();
  const double off = kSettled * std::max(std::abs(plateau->low), std::abs(plateau->high)) +
                     range / static_cast<double>(kNarrowestRange);
  return end.level >= plateau->low - off && end.level <= plateau->high + off;
}

}  // namespace

bool LostSamples::are_significant(std::size_t plateaus) const {
  return jumps >= kFewestJumps && static_cast<double>(jumps) > kJumpsPerPlateau * static_cast<double>(plateaus);
}

RecordedSamples::RecordedSamples(Trace& trace, int threads) : size_(trace.size()) {
  const bool made = trace.kind == RecordKind::motion_only, made_velocity = !trace.velocity_std_error.empty();
  still_ = longest_still(trace.friction, trace.velocity);
  run_tasks(2, threads, [&](std::size_t k) {
    (k == 0 ? friction_ : velocity_) = ChannelSamples(k == 0 ? trace.friction : trace.velocity);
    (k == 0 ? friction_repeats_ : velocity_repeats_) = repeats_unevenly(k == 0 ? trace.friction : trace.velocity);
  });
  run_tasks(2, threads, [&](std::size_t k) {
    if (k == 0 && !made) find_outliers_and_held(friction_, velocity_, false);
    if (k == 1 && !made_velocity)
      find_outliers_and_held(velocity_, friction_, trace.velocity_kind == VelocityKind::relative);
  });
  const std::array bridged = {friction_.held, velocity_.held};
  leave_out(trace.friction, friction_, "friction", SampleFault::friction);
  leave_out(trace.velocity, velocity_, "velocity", SampleFault::velocity);
  const auto leave_out_markers = [&](std::vector<double>& channel, const char* name) {
    ChannelSamples found(channel);
    find_outliers_and_held(found, {}, false);
    found.held.clear();  // a drive may hold a value, and leave it for a while
    std::erase_if(found.outliers, [&](const SampleSpan& span) { return !found.is_beyond(channel[span.begin]); });
    leave_out(channel, found, name, SampleFault::friction | SampleFault::velocity);
  };
  leave_out_markers(trace.load, "load");
  leave_out_markers(trace.temperature, "temperature");
  leave_out_markers(trace.disc_speed, "speed");
  const bool is_block = trace.velocity_kind == VelocityKind::block;
  run_tasks(2, threads, [&](std::size_t k) {
    ChannelSamples& channel = k == 0 ? friction_ : velocity_;
    if (channel.x.empty()) return;
    find_ends(channel, k == 1, bridged[k]);
    (k == 0 ? friction_range_ : velocity_range_) = extremes(channel.x);
    if (!made_velocity) (k == 0 ? friction_slew_ : velocity_slew_) = find_slew_limit(channel);
    for (std::size_t end = 0; k == 0 && end < 2 && is_block && !made_velocity && channel.is_noisy; ++end) {
      // Friction gathers at break-away too, where it is the same every time: the block slips there already.
      if (channel.ends[end].count == 0) {
        const RangeEnd found = find_end_in_stick(channel, trace.velocity, end == 1);
        if (found.count > 0) channel.ends[end] = found;
      }
    }
  });
}

void RecordedSamples::leave_out(std::vector<double>& channel, ChannelSamples& found, const char* name,
                                std::uint8_t kind) {
  const bool is_velocity = kind == SampleFault::velocity;
  const std::size_t outliers = samples_in(found.outliers), held = samples_in(found.held);
  if (outliers > 0) {
    const double first = (is_velocity ? 1e3 : 1) * channel[found.outliers.front().begin];
    sentences_.push_back(
        fmt::format("{} jumps away and back {} within few samples, first to {}{} ({} % of the record, left out)", name,
                    counted(found.outliers.size(), "time"), general(first, 4), is_velocity ? " mm/s" : "",
                    general(percent(outliers, size_), 3)));
  }
  if (held > 0) {
    sentences_.push_back(fmt::format("{} repeats one value in {} ({} % of the record, left out)", name,
                                     counted(found.held.size(), "stretch", "es"), general(percent(held, size_), 3)));
  }
  for (const auto* spans : {&found.outliers, &found.held}) {
    bridge(*spans, channel);
    mark(*spans, kind);
    for (const SampleSpan& span : *spans) {
      if (span.size() >= kShortestStretch) mark({span}, SampleFault::stretch);
    }
  }
  if (outliers + held > 0) found = ChannelSamples(channel);
  left_out_ = static_cast<std::size_t>(std::ranges::count_if(faults_, [](std::uint8_t fault) { return fault != 0; }));
}

void RecordedSamples::mark(const std::vector<SampleSpan>& spans, std::uint8_t kinds) {
  if (spans.empty()) return;
  if (faults_.empty()) faults_.assign(size_, 0);
  for (const SampleSpan& span : spans) {
    for (std::size_t i = span.begin; i < span.end; ++i) faults_[i] |= kinds;
  }
}

void RecordedSamples::add_standstill(const PlateauSearch& search, double plateau, const Trace& trace) {
  const auto& runs = search.plateaus.runs;
  if (runs.size() < kFewestPeriods) return;
  const double period =
      static_cast<double>(runs.back().begin - runs.front().begin) / static_cast<double>(runs.size() - 1);
  const std::vector<double>& v = search.blocks.mean;
  const auto stands = [&](double mean) { return std::abs(mean) < kStandstillPart * std::abs(plateau); };
  const std::size_t length = search.blocks.length;
  for (std::size_t begin = 0; begin < v.size();) {
    std::size_t end = begin;
    while (end < v.size() && stands(v[end])) ++end;
    if (static_cast<double>(end - begin) > kStandstillPeriods * period) {
      const SampleSpan span{begin * length, end == v.size() ? size_ : end * length};
      // The machine stops and starts again over a cycle or so.
      const auto beside = static_cast<std::size_t>(period) * length;
      add_unknown({span.begin - std::min(span.begin, beside), std::min(size_, span.end + beside)});
      sentences_.push_back(fmt::format("the machine stands still from {} s to {} s (left out)",
                                       general(trace.time[span.begin], 4), general(trace.time[span.end - 1], 4)));
    }
    begin = end + 1;
  }
}

void RecordedSamples::find_lost(const Trace& trace, const PlateauSearch& search, const Disc& disc) {
  const std::vector<double>& v = trace.velocity;
  const double least = std::max(velocity_.reach, kStepsOfOutlier * velocity_.step), step = trace.interval();
  const auto at_rest = [&](std::size_t i) {
    return std::abs(v[i] - (disc.varying.empty() ? 0 : disc.varying[i]) - search.plateaus.level) <= least;
  };
  const auto smooth = [](double a, double b) {
    return std::abs(a - b) < kJumpSmooth * std::max(std::abs(a), std::abs(b));
  };
  std::size_t looked_at = 0, from_rest = 0, to_rest = 0, others = 0;
  for (std::size_t i = 2; i + 3 < v.size(); ++i) {
    const double here = v[i + 1] - v[i];
    if (!(std::abs(here) > least) || trace.time[i + 1] - trace.time[i] > 1.5 * step) continue;
    const std::array<double, 4> beside = {v[i - 1] - v[i - 2], v[i] - v[i - 1], v[i + 2] - v[i + 1],
                                          v[i + 3] - v[i + 2]};
    double most = 0;
    for (const double change : beside) most = std::max(most, std::abs(change));
    looked_at += most > least && smooth(beside[0], beside[1]) && smooth(beside[2], beside[3]) ? 1U : 0U;
    if (std::abs(here) > kJumpOver * most && std::abs(here) - most > least)
      ++(at_rest(i) ? from_rest : at_rest(i + 1) ? to_rest : others);
  }
  const double usual = kUsualJump * static_cast<double>(search.plateaus.runs.size());
  lost_.jumps = others;
  for (const std::size_t jumps : {from_rest, to_rest}) lost_.jumps += static_cast<double>(jumps) > usual ? 0 : jumps;
  if (looked_at > 0) lost_.fraction = std::min(1.0, static_cast<double>(lost_.jumps) / static_cast<double>(looked_at));
}

bool RecordedSamples::clips_slips(const Plateaus& plateaus) const {
  return std::ranges::any_of(velocity_.ends, [&](const RangeEnd& end) {
    return end.count > 0 && std::abs(end.level - plateaus.level) > 0.5 * plateaus.depth;
  });
}

HealthItem RecordedSamples::check_clipping(const Trace& trace, const Instruments& instruments, const Resting& resting) {
  HealthItem item{health_check::kClipping, Status::ok, "no channel is cut off at an end of its range"};
  const std::string newton = trace.friction_kind == FrictionKind::force ? " N" : "";
  const auto add_end = [&](const RangeEnd& end, const std::string& name, double factor, const std::string& unit,
                           std::uint8_t kind, const char* unreliable) {
    const double part = percent(end.count, size_);
    add_finding(part > 100 * kMuchClipped ? Status::problem : Status::warning,
                fmt::format("{} stays at {}{} for {} samples ({} %): the range was too small; they are not used, {} "
                            "unreliable",
                            name, general(factor * end.level, 4), unit, end.count, general(part, 3), unreliable),
                item);
    mark(end.spans, kind);
  };
  for (std::size_t k = 0; k < 2; ++k) {
    const RangeEnd& end = friction_.ends[k];
    const double limit = k == 0 ? friction_range_.low : friction_range_.high;
    if (end.count == 0 || (k == 0 ? limit > 0 : limit < 0) || !moves_in(end.spans, trace, velocity_)) continue;
    const bool is_static = k == 1 || friction_range_.high <= 0;
    add_end(end, "friction", 1, newton, SampleFault::friction, is_static ? "mu_s is" : "the lowest friction is");
  }
  const double range = velocity_range_.high - velocity_range_.low;
  for (const RangeEnd& end : velocity_.ends) {
    const bool is_held = end.is_quiet || resting.sticks;
    if (end.count > 0 && is_held && !is_rest(end, range, resting.plateau))
      add_end(end, "velocity", 1e3, " mm/s", SampleFault::velocity, "mu_k and the law's decay (alpha) are");
  }
  const auto add_slew = [&](const char* name, double rate, const std::string& unit) {
    if (rate == 0 || !resting.sticks) return;
    add_finding(Status::problem,
                fmt::format("{} changes by at most {}{} per second: the slew rate of its amplifier limits it; mu_s, "
                            "mu_k and the law's decay (alpha) are unreliable",
                            name, general(rate / trace.interval(), 3), unit),
                item);
  };
  add_slew("friction", friction_slew_, newton);
  add_slew("velocity", 1e3 * velocity_slew_, " mm/s");
  const auto& declared = instruments.vibrometer.range;
  const double largest = std::max(std::abs(velocity_range_.low), std::abs(velocity_range_.high));
  if (item.status == Status::ok && declared && largest > kAtDeclaredRange * declared->value) {
    add_finding(Status::warning,
                fmt::format("velocity reaches {} mm/s, the declared range is {} mm/s", general(1e3 * largest, 4),
                            general(1e3 * declared->value, 4)),
                item);
  }
  return item;
}

HealthItem RecordedSamples::check_drop_outs(const Trace& trace, std::size_t plateaus) const {
  if (size_ < kFewestSamples) return {health_check::kDropOuts, Status::warning, fmt::format("only {} samples", size_)};
  HealthItem item{health_check::kDropOuts, Status::ok,
                  fmt::format("none in {} samples, {} s", size_, general(trace.duration(), 4))};
  if (still_.size() >= kShortestStretch && percent(still_.size(), size_) > 100 * kMuchFrozen && still_.size() < size_) {
    add_finding(Status::problem,
                fmt::format("both channels do not change from {} s for {} s ({} % of the record)",
                            general(trace.time[still_.begin], 4),
                            general(trace.time[still_.end - 1] - trace.time[still_.begin], 4),
                            general(percent(still_.size(), size_), 3)),
                item);
  }
  const double step = trace.interval();
  if (const Gaps gaps = gaps_of(trace.time, step); gaps.count > 0) {
    add_finding(percent(gaps.count, size_) > 100 * kMuchFaulty ? Status::problem : Status::warning,
                fmt::format("{} gaps in time (longest {} ms at a sampling interval of {} ms)", gaps.count,
                            general(1e3 * gaps.longest, 3), general(1e3 * step, 3)),
                item);
  }
  for (const std::string& sentence : sentences_)
    add_finding(percent(left_out_, size_) > 100 * kMuchFrozen ? Status::problem : Status::warning, sentence, item);
  if (lost_.are_significant(plateaus)) {
    add_finding(Status::problem,
                fmt::format("the velocity jumps {} times without a gap in time ({} % of the fast intervals): samples "
                            "were lost and the time column was regenerated; the frequency and all times are unreliable",
                            lost_.jumps, general(100 * lost_.fraction, 3)),
                item);
  }
  return item;
}

HealthItem RecordedSamples::check_resolution(FrictionKind kind, double noise) const {
  HealthItem item{health_check::kResolution, Status::ok, "the steps of both channels are finer than noise"};
  if (velocity_.step > 2 * noise && velocity_.step > 0) {
    const double largest = std::max(std::abs(velocity_range_.low), std::abs(velocity_range_.high));
    const bool is_too_coarse = velocity_.step > kTooCoarse * largest;
    add_finding(
        is_too_coarse ? Status::problem : Status::warning,
        fmt::format(
            "velocity is recorded in steps of {} mm/s, coarser than its noise: the rounding is carried "
            "as noise, and a smaller gap between plateau and omega r is not named{}",
            general(1e3 * velocity_.step, 3),
            is_too_coarse ? "; the law's decay (alpha) is unreliable, use a smaller range of the vibrometer" : ""),
        item);
  }
  const double range = friction_range_.high - friction_range_.low;
  if (friction_.step > kCoarseStep * range) {
    const bool is_too_coarse = friction_.step > kTooCoarseFriction * range;
    add_finding(is_too_coarse ? Status::problem : Status::warning,
                fmt::format("friction is recorded in steps of {}{}: the rounding is part of the noise floor{}",
                            general(friction_.step, 3), kind == FrictionKind::force ? " N" : "",
                            is_too_coarse ? "; mu_k and the law's decay (alpha) are unreliable" : ""),
                item);
  }
  return item;
}

}  // namespace tribofit::kinematics
