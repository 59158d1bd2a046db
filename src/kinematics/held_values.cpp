#include "held_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "limits.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit::kinematics {
namespace {

/// Every `hold.samples`-th value, from the first fresh one on.
void thin_out(const Hold& hold, std::vector<double>& channel) {
  std::size_t kept = 0;
  for (std::size_t i = hold.first; i < channel.size(); i += hold.samples) channel[kept++] = channel[i];
  channel.resize(kept);
}

/// The sample that has become of one.
std::size_t place_of(const Hold& hold, std::size_t sample) {
  return sample <= hold.first ? 0 : (sample - hold.first + hold.samples - 1) / hold.samples;
}

}  // namespace

Hold find_hold(std::span<const double> channel) {
  std::vector<std::size_t> changes;
  std::map<std::size_t, std::size_t> spacings;
  for (std::size_t i = 1; i < channel.size(); ++i) {
    if (channel[i] == channel[i - 1]) continue;
    if (!changes.empty()) ++spacings[i - changes.back()];
    changes.push_back(i);
  }
  if (changes.size() < kFewestDistributed) return {};
  const auto most = std::ranges::max_element(spacings, {}, [](const auto& spacing) { return spacing.second; });
  const std::size_t k = most->first;
  if (k < 2) return {};
  std::vector<std::size_t> phases(k, 0);
  for (const std::size_t i : changes) ++phases[i % k];
  const auto phase = std::ranges::max_element(phases);
  if (static_cast<double>(*phase) < kHeldAlike * static_cast<double>(changes.size())) return {};
  return {k, static_cast<std::size_t>(phase - phases.begin())};
}

void keep_fresh_values(Trace& trace, std::vector<std::string>& notes) {
  const Hold friction = find_hold(trace.friction), velocity = find_hold(trace.velocity);
  const Hold& hold = velocity.samples > friction.samples ? velocity : friction;
  if (hold.samples == 1 || trace.size() / hold.samples < kFewestDistributed) return;
  const char* which = friction.samples == velocity.samples ? "friction and velocity hold"
                      : &hold == &velocity                 ? "the velocity holds"
                                                           : "friction holds";
  notes.push_back(fmt::format("{} each value for {} samples; the first of each is used, the record is one at {}", which,
                              hold.samples, frequency_text(trace.rate() / static_cast<double>(hold.samples))));
  for (auto* channel :
       {&trace.time, &trace.friction, &trace.velocity, &trace.block_position, &trace.drive_position,
        &trace.friction_std_error, &trace.velocity_std_error, &trace.acceleration, &trace.velocity_variance,
        &trace.load, &trace.temperature, &trace.disc_speed, &trace.disc_angle}) {
    thin_out(hold, *channel);
  }
  for (Step& step : trace.steps) step.begin = place_of(hold, step.begin), step.end = place_of(hold, step.end);
  if (!trace.steps.empty()) trace.steps.back().end = trace.size();
}

}  // namespace tribofit::kinematics
