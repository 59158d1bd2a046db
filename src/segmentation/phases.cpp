#include "phases.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/reductions.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::segmentation {
namespace {

// Peak that is typical of the record: median of the largest excursions of its parts that have one.
double typical_peak(const Motion& motion) {
  constexpr std::size_t parts = 512;
  const std::size_t n = motion.size(), length = std::max<std::size_t>(1, (n + parts - 1) / parts);
  std::vector<double> peaks;
  const double plateau = motion.plateau_velocity;
  const std::span<const double> velocity(motion.relative_velocity);
  for (std::size_t begin = 0; begin < n; begin += length) {
    const auto [low, high] = extremes(velocity.subspan(begin, std::min(length, n - begin)));
    peaks.push_back(std::max(high - plateau, plateau - low));
  }
  std::sort(peaks.begin(), peaks.end());
  // One lone outlier must not set the scale: the largest only counts when the next ones come near it.
  const double largest = peaks[peaks.size() - 1 - std::min<std::size_t>(2, (peaks.size() - 1) / 8)];
  const auto first = std::lower_bound(peaks.begin(), peaks.end(), 0.2 * largest);
  return median(std::vector<double>(first, peaks.end()));
}

std::vector<RawSlip> hysteresis(const Motion& motion, const Thresholds& t) {
  std::vector<RawSlip> slips;
  const std::size_t n = motion.size();
  const double* v = motion.relative_velocity.data();
  const double plateau = motion.plateau_velocity;
  std::size_t i = 0;
  // A record that begins between the thresholds, or above, may begin in slip.
  bool slipping = n > 0 && std::abs(v[0] - plateau) > t.stick;
  while (i < n) {
    if (!slipping) {
      while (i < n && std::abs(v[i] - plateau) <= t.slip) ++i;
      if (i == n) break;
    }
    RawSlip slip;
    slip.direction = v[i] > plateau ? 1 : -1;
    slip.samples.begin = i;
    slip.begins_within = !slipping;
    slipping = false;
    double peak = 0;
    for (; i < n; ++i) {
      const double u = slip.direction * (v[i] - plateau);
      if (u < t.stick) break;
      peak = u > peak ? u : peak;
    }
    slip.peak = peak;
    slip.samples.end = i;
    slip.ends_within = i < n;
    if (peak > t.slip) slips.push_back(slip);
  }
  return slips;
}

// Ringing after a re-stick and spikes are lower and much shorter than the slips.
void drop_chatter(std::vector<RawSlip>& slips, double peak) {
  std::vector<double> durations;
  for (const RawSlip& slip : slips) {
    if (slip.peak > 0.4 * peak) durations.push_back(static_cast<double>(slip.samples.size()));
  }
  const double usual = durations.empty() ? 0 : median(std::move(durations));
  std::erase_if(slips, [&](const RawSlip& slip) {
    const auto duration = static_cast<double>(slip.samples.size());
    const bool whole = slip.begins_within && slip.ends_within;
    return (whole && slip.peak < 0.2 * peak && duration < 0.35 * usual) || (duration < 3 && duration < 0.1 * usual);
  });
}

}  // namespace

Thresholds thresholds_of(const Motion& motion) {
  Thresholds t;
  if (motion.size() == 0) return t;
  const double noise = motion.velocity_noise;
  const double peak = typical_peak(motion);
  // Rounding of omega r - v_b is no motion.
  double fastest = std::abs(motion.plateau_velocity);
  for (const double v : motion.disc_velocity) fastest = std::max(fastest, std::abs(v));
  fastest = std::max(fastest, std::abs(motion.constant_disc_velocity));
  if (peak <= std::max(8 * noise, 1e-12 * fastest)) return {8 * noise, 5 * noise, 0};
  t.peak = peak;
  t.slip = std::max(0.06 * peak, std::min(8 * noise, 0.15 * peak));
  t.stick = std::max(0.03 * peak, std::min(5 * noise, 0.075 * peak));
  return t;
}

std::vector<RawSlip> find_slips(const Motion& motion, const Thresholds& thresholds) {
  if (thresholds.peak == 0) return {};
  std::vector<RawSlip> slips = hysteresis(motion, thresholds);
  drop_chatter(slips, thresholds.peak);
  return slips;
}

bool only_reverses(const Motion& motion, const RawSlip& before, const RawSlip& after, const Thresholds& thresholds) {
  if (before.direction == after.direction) return false;
  const std::size_t begin = before.samples.end, end = after.samples.begin, n = end - begin;
  if (n < 6) return true;
  const std::size_t third = n / 3;
  double first = 0, last = 0;
  for (std::size_t k = 0; k < third; ++k) {
    first += above_plateau(motion, begin + k);
    last += above_plateau(motion, end - 1 - k);
  }
  return std::abs(last - first) / static_cast<double>(third) > thresholds.stick;
}

}  // namespace tribofit::segmentation
