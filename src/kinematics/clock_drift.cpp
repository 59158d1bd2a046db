#include "clock_drift.hpp"

#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// The largest change of friction from one sample to the next.
struct Jump {
  double at = 0;     ///< [samples]
  double share = 0;  ///< of what it is over a few samples
};

Jump jump_beside(std::span<const double> friction, double place, double reach) {
  const auto begin = static_cast<std::size_t>(std::max(1.0, place - reach));
  const auto end = std::min(friction.size(), static_cast<std::size_t>(place + reach));
  double most = 0;
  std::size_t at = begin;
  for (std::size_t i = begin; i < end; ++i) {
    const double change = std::abs(friction[i] - friction[i - 1]);
    if (change > most) most = change, at = i;
  }
  const std::size_t last = friction.size() - 1;
  const double around = std::abs(friction[std::min(at + 2, last)] - friction[at - std::min<std::size_t>(at, 3)]);
  return {static_cast<double>(at) - 0.5, around > 0 ? most / around : 0};
}

/// Where a signal goes from one side of zero to the other [samples]: from where it last was beyond zero, between swings
/// that reach a part of its usual size, so that noise about zero is none.
std::vector<double> sign_changes(std::span<const double> x) {
  std::vector<double> sizes = thinned(x, kThinned), places;
  for (double& size : sizes) size = std::abs(size);
  if (sizes.empty()) return places;
  const double reached = kSlidesFreely * median(std::move(sizes));
  double side = 0;
  std::size_t last = 0;  // sample on the side that the signal leaves
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (side * x[i] > 0) last = i;
    if (std::abs(x[i]) < reached || side * x[i] > 0) continue;
    if (side != 0) places.push_back(static_cast<double>(last) + x[last] / (x[last] - x[last + 1]));
    side = x[i] > 0 ? 1 : -1;
    last = i;
  }
  return places;
}

}  // namespace

double delay_at_reversals(std::span<const double> friction, std::span<const double> velocity) {
  const std::vector<double> of_friction = sign_changes(friction), of_velocity = sign_changes(velocity);
  std::vector<double> delays;
  for (const double at : of_velocity) {
    const auto after = std::ranges::lower_bound(of_friction, at);
    double delay = after == of_friction.end() ? HUGE_VAL : *after - at;
    if (after != of_friction.begin() && at - *(after - 1) < delay) delay = *(after - 1) - at;
    if (std::isfinite(delay)) delays.push_back(delay);
  }
  return delays.size() < kFewestForMedian ? 0 : median(std::move(delays));
}

ClockDriftEstimate find_clock_drift(std::span<const double> friction, const std::vector<double>& resticks) {
  ClockDriftEstimate found;
  if (resticks.size() < 3 * kFewestPeriods) return found;
  std::vector<double> periods;
  for (std::size_t k = 1; k < resticks.size(); ++k) periods.push_back(resticks[k] - resticks[k - 1]);
  const double reach = kDriftReach * median(std::move(periods));
  std::vector<double> places, behind, shares;
  for (const double place : resticks) {
    if (place < reach || place + reach > static_cast<double>(friction.size())) continue;
    places.push_back(place);
    const Jump jump = jump_beside(friction, place, reach);
    behind.push_back(jump.at - place);
    shares.push_back(jump.share);
  }
  // What another edge of friction passed for is left out, twice: the line moves.
  StraightLine line = fit_line(places, behind);
  double scatter = 0;
  for (int round = 0; round < 3 && places.size() >= 3 * kFewestPeriods; ++round) {
    std::vector<double> off;
    for (std::size_t k = 0; k < places.size(); ++k) off.push_back(std::abs(behind[k] - line.at(places[k])));
    scatter = std::max(kSigmaPerMad * median(off), 1 / std::sqrt(12.0));
    std::size_t kept = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (off[k] > kSignificance * scatter) continue;
      places[kept] = places[k], behind[kept++] = behind[k];
    }
    places.resize(kept), behind.resize(kept);
    line = fit_line(places, behind);
  }
  if (places.size() < 3 * kFewestPeriods || scatter > kDriftScatter) return found;
  found.slips = places.size();
  const double std_error = scatter / std::sqrt(line.squares),
               gained = line.slope * static_cast<double>(friction.size());
  const bool drifts = std::abs(gained) > kDriftSamples && std::abs(line.slope) > kSignificance * std_error;
  if (drifts) found.drift = {line.slope, std_error};
  found.at_start = drifts ? line.at(0) : line.value;
  found.is_sharp = median(std::move(shares)) > kSharpJump;
  return found;
}

Ends follow_clock(std::vector<double>& velocity, double drift, double late, std::vector<double>& resticks) {
  const std::size_t n = velocity.size();
  if (n < 4) return {};
  const std::vector<double> read = velocity;
  const auto last = static_cast<double>(n - 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double at = std::clamp(static_cast<double>(i) * (1 - drift) - late, 0.0, last);
    const std::size_t k = std::clamp<std::size_t>(static_cast<std::size_t>(at), 1, n - 3);
    velocity[i] = interpolated(read[k - 1], read[k], read[k + 1], read[k + 2], at - static_cast<double>(k));
  }
  for (double& place : resticks) place = (place + late) / (1 - drift);
  const auto missing = [](double samples) {
    return samples > 0 ? static_cast<std::size_t>(std::ceil(samples)) + 2 : 0;
  };
  return {missing(late), missing(-drift * last - late)};
}

}  // namespace tribofit::kinematics
