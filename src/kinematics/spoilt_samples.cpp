#include "spoilt_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit::kinematics {
namespace {

std::size_t samples_of(const std::vector<SampleSpan>& spans) {
  std::size_t samples = 0;
  for (const SampleSpan& span : spans) samples += span.size();
  return samples;
}

std::string counted(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// A pause of the disc is no fault: the block is at rest, the spring still pulls, and without noise neither changes.
SampleSpan longest_still_of(const ChannelOutlines& channels) {
  const std::span<const double> friction = channels.friction.x, velocity = channels.velocity.x;
  SampleSpan longest;
  if (friction.size() != velocity.size()) return longest;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < friction.size(); ++i) {
    const std::size_t change = i - 1, chunk = change / Chunks::length;
    const auto changes_throughout = [&](const ChannelOutline& channel) { return channel.repeats[chunk] == 0; };
    if (change % Chunks::length == 0 && longest.size() > 0 &&
        (changes_throughout(channels.friction) || changes_throughout(channels.velocity))) {
      begin = i = std::min(i + Chunks::length - 1, friction.size() - 1);
      continue;
    }
    if (friction[i] != friction[i - 1] || velocity[i] != velocity[i - 1]) begin = i;
    const bool pauses = velocity[i] == 0 && friction[i] != 0;
    if (!pauses && i + 1 - begin > longest.size()) longest = {begin, i + 1};
  }
  return longest;
}

}  // namespace

SpoiltSamples::SpoiltSamples(Trace& trace, ChannelOutlines& channels, int threads) : size_(trace.size()) {
  still_ = longest_still_of(channels);
  // Both as recorded: what one shows says what the other is.
  const bool made = trace.kind == RecordKind::motion_only, made_velocity = !trace.velocity_std_error.empty();
  const bool rests_at_zero = trace.velocity_kind == VelocityKind::relative;
  ChannelFaults friction, velocity, lost;
  run_tasks(2, threads, [&](std::size_t k) {
    if (k == 0 && !made) friction = find_channel_faults(channels.friction, channels.velocity, false);
    if (k == 1 && !made_velocity) velocity = find_channel_faults(channels.velocity, channels.friction, rests_at_zero);
  });
  clean(trace.friction, channels.friction, friction, "friction", SampleFault::friction);
  clean(trace.velocity, channels.velocity, velocity, "velocity", SampleFault::velocity);
  if (!made_velocity) lost.excursions = find_excursions(channels.velocity, channels.friction);
  clean(trace.velocity, channels.velocity, lost, "velocity", SampleFault::velocity);
  const auto clean_markers = [&](std::vector<double>& channel, const char* name) {
    const std::vector<SampleSpan> markers = find_marker_values(channel);
    if (markers.empty()) return;
    bridge(markers, channel);
    mark(markers, SampleFault::friction | SampleFault::velocity);
    sentences_.push_back(fmt::format("{} has {} (left out)", name, counted(samples_of(markers), "marker value")));
  };
  clean_markers(trace.load, "load");
  clean_markers(trace.temperature, "temperature");
  clean_markers(trace.disc_speed, "speed");
}

void SpoiltSamples::clean(std::vector<double>& channel, ChannelOutline& outline, const ChannelFaults& faults,
                          const std::string& name, std::uint8_t kind) {
  if (!faults.markers.empty()) {
    const double value = channel[faults.markers.front().begin];
    const bool is_velocity = kind == SampleFault::velocity;
    sentences_.push_back(fmt::format("{} has {}, the first {}{} (left out)", name,
                                     counted(samples_of(faults.markers), "marker value"),
                                     general(is_velocity ? 1e3 * value : value, 4), is_velocity ? " mm/s" : ""));
  }
  if (!faults.spikes.empty()) {
    spikes_ += faults.spikes.size();
    sentences_.push_back(fmt::format("{} has {} far from both neighbours (left out)", name,
                                     counted(faults.spikes.size(), "lone sample")));
  }
  if (!faults.frozen.empty()) {
    const std::size_t samples = samples_of(faults.frozen);
    frozen_ += samples;
    sentences_.push_back(
        fmt::format("{} repeats one value in {} ({} % of the record, left out)", name,
                    faults.frozen.size() == 1 ? "a stretch" : fmt::format("{} stretches", faults.frozen.size()),
                    general(100 * static_cast<double>(samples) / static_cast<double>(size_), 3)));
  }
  if (!faults.excursions.empty()) {
    const std::size_t samples = samples_of(faults.excursions);
    frozen_ += samples;
    sentences_.push_back(fmt::format(
        "{} jumps away and back {} times within few samples, as a laser does that loses its "
        "reflection ({} % of the record, left out)",
        name, faults.excursions.size(), general(100 * static_cast<double>(samples) / static_cast<double>(size_), 3)));
  }
  for (const auto* spans : {&faults.markers, &faults.spikes, &faults.frozen, &faults.excursions}) {
    bridge(*spans, channel);
    mark(*spans, kind);
    for (const SampleSpan& span : *spans) {
      if (span.size() >= kShortestStretch) mark({span}, SampleFault::stretch);
    }
  }
  if (faults.any()) outline = ChannelOutline(channel);
}

void SpoiltSamples::mark(const std::vector<SampleSpan>& spans, std::uint8_t kind) {
  if (spans.empty()) return;
  if (faults_.empty()) faults_.assign(size_, 0);
  for (const SampleSpan& span : spans) {
    for (std::size_t i = span.begin; i < span.end; ++i) faults_[i] |= kind;
  }
}

void SpoiltSamples::add_standstill(const PlateauSearch& search, double plateau, const Trace& trace) {
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
      mark({{span.begin - std::min(span.begin, beside), std::min(size_, span.end + beside)}}, SampleFault::any);
      sentences_.push_back(fmt::format("the machine stands still from {} s to {} s (left out)",
                                       general(trace.time[span.begin], 4), general(trace.time[span.end - 1], 4)));
    }
    begin = end + 1;
  }
}

double SpoiltSamples::frozen_part() const {
  return static_cast<double>(frozen_) / static_cast<double>(size_);
}

}  // namespace tribofit::kinematics
