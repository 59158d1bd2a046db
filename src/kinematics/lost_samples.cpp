#include "lost_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "limits.hpp"
#include "recording_faults.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {

bool are_lost(const LostSamples& lost, std::size_t plateaus) {
  return lost.jumps >= kFewestJumps &&
         static_cast<double>(lost.jumps) > kJumpsPerPlateau * static_cast<double>(plateaus);
}

double noise_in_motion(std::span<const double> velocity) {
  std::vector<double> off;
  bool reads_zero = false;
  for (std::size_t i = 1; i + 1 < velocity.size(); ++i) {
    const bool moves = velocity[i - 1] != 0 && velocity[i] != 0 && velocity[i + 1] != 0;
    if (moves) off.push_back(std::abs(off_line(velocity, i)));
    reads_zero |= velocity[i] == 0 && velocity[i - 1] == 0;
  }
  constexpr double kOffLine = 1.5;  // variance of what white noise is off the line between its neighbours
  return off.empty() || !reads_zero ? 0 : kSigmaPerMad * median(std::move(off)) / std::sqrt(kOffLine);
}

LostSamples find_lost_samples(const Trace& trace, const PlateauSearch& search, const Disc& disc, double noise,
                              double step) {
  LostSamples lost;
  const std::vector<double>& v = trace.velocity;
  const double least = kJumpNoise * noise;
  const auto at_rest = [&](std::size_t i) {
    return std::abs(v[i] - (disc.varying.empty() ? 0 : disc.varying[i]) - search.plateaus.level) <= least;
  };
  std::size_t looked_at = 0, from_rest = 0, to_rest = 0;
  const auto smooth = [](double a, double b) {
    return std::abs(a - b) < kJumpSmooth * std::max(std::abs(a), std::abs(b));
  };
  for (std::size_t i = 2; i + 3 < v.size(); ++i) {
    const double here = v[i + 1] - v[i];
    if (!(std::abs(here) > least) || trace.time[i + 1] - trace.time[i] > 1.5 * step) continue;
    const std::array<double, 4> beside = {v[i - 1] - v[i - 2], v[i] - v[i - 1], v[i + 2] - v[i + 1],
                                          v[i + 3] - v[i + 2]};
    double most = 0;
    for (const double change : beside) most = std::max(most, std::abs(change));
    const bool moves_on = most > least && smooth(beside[0], beside[1]) && smooth(beside[2], beside[3]);
    looked_at += moves_on ? 1U : 0U;
    if (!(std::abs(here) > kJumpOver * std::max(most, 0.5 * least))) continue;
    ++(at_rest(i) ? from_rest : at_rest(i + 1) ? to_rest : lost.jumps);
  }
  const double usual = kUsualJump * static_cast<double>(search.plateaus.runs.size());
  for (const std::size_t jumps : {from_rest, to_rest}) lost.jumps += static_cast<double>(jumps) > usual ? 0 : jumps;
  if (looked_at > 0) lost.part = std::min(1.0, static_cast<double>(lost.jumps) / static_cast<double>(looked_at));
  return lost;
}

}  // namespace tribofit::kinematics
