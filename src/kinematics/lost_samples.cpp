#include "lost_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "limits.hpp"
#include "recording_faults.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/execution/parallel.hpp"
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

namespace {

struct Jumps {
  std::size_t looked_at = 0, from_rest = 0, to_rest = 0, others = 0;
};

/// Of the intervals after the samples `first` to `last` (not itself), all of which have two samples more on either
/// side.
Jumps jumps_between(std::size_t first, std::size_t last, const Trace& trace, const PlateauSearch& search,
                    const Disc& disc, double noise, double step) {
  Jumps jumps;
  const std::vector<double>& v = trace.velocity;
  const double least = kJumpNoise * noise;
  const auto at_rest = [&](std::size_t i) {
    return std::abs(v[i] - (disc.varying.empty() ? 0 : disc.varying[i]) - search.plateaus.level) <= least;
  };
  const auto smooth = [](double a, double b) {
    return std::abs(a - b) < kJumpSmooth * std::max(std::abs(a), std::abs(b));
  };
  for (std::size_t i = first; i < last; ++i) {
    const double here = v[i + 1] - v[i];
    if (!(std::abs(here) > least) || trace.time[i + 1] - trace.time[i] > 1.5 * step) continue;
    const std::array<double, 4> beside = {v[i - 1] - v[i - 2], v[i] - v[i - 1], v[i + 2] - v[i + 1],
                                          v[i + 3] - v[i + 2]};
    double most = 0;
    for (const double change : beside) most = std::max(most, std::abs(change));
    const bool moves_on = most > least && smooth(beside[0], beside[1]) && smooth(beside[2], beside[3]);
    jumps.looked_at += moves_on ? 1U : 0U;
    if (!(std::abs(here) > kJumpOver * std::max(most, 0.5 * least))) continue;
    ++(at_rest(i) ? jumps.from_rest : at_rest(i + 1) ? jumps.to_rest : jumps.others);
  }
  return jumps;
}

}  // namespace

LostSamples find_lost_samples(const Trace& trace, const PlateauSearch& search, const Disc& disc, double noise,
                              double step, int threads) {
  constexpr std::size_t kPart = 1 << 18, kBefore = 2, kAfter = 3;
  const std::size_t end = std::max(kBefore, trace.size() - std::min(trace.size(), kAfter));
  std::vector<Jumps> parts((end - kBefore + kPart - 1) / kPart);
  run_tasks(parts.size(), threads, [&](std::size_t k) {
    const std::size_t first = kBefore + k * kPart;
    parts[k] = jumps_between(first, std::min(end, first + kPart), trace, search, disc, noise, step);
  });
  Jumps all;
  for (const Jumps& part : parts) {
    all.looked_at += part.looked_at;
    all.from_rest += part.from_rest;
    all.to_rest += part.to_rest;
    all.others += part.others;
  }
  LostSamples lost{all.others, 0};
  const double usual = kUsualJump * static_cast<double>(search.plateaus.runs.size());
  for (const std::size_t jumps : {all.from_rest, all.to_rest})
    lost.jumps += static_cast<double>(jumps) > usual ? 0 : jumps;
  if (all.looked_at > 0)
    lost.part = std::min(1.0, static_cast<double>(lost.jumps) / static_cast<double>(all.looked_at));
  return lost;
}

}  // namespace tribofit::kinematics
