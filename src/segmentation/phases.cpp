#include "phases.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/limits.hpp"
#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::segmentation {
namespace {

using kinematics::kMovesWithDisc;
using kinematics::kRestDepth;
using kinematics::kRestNoise;
using kinematics::kSlipsOverError;
using kinematics::kSlipsOverFastest;

// Peak that is typical of the record: median of the largest excursions of its parts that have one.
double typical_peak(const Motion& motion, int threads = 1) {
  constexpr std::size_t parts = kPartsOfRecord;
  const std::size_t n = motion.size(), length = std::max<std::size_t>(1, (n + parts - 1) / parts);
  std::vector<double> peaks((n + length - 1) / length);
  const double plateau = motion.plateau_velocity;
  const std::span<const double> velocity(motion.relative_velocity);
  run_tasks(peaks.size(), threads, [&](std::size_t k) {
    const auto [low, high] = extremes(velocity.subspan(k * length, std::min(length, n - k * length)));
    peaks[k] = std::max(high - plateau, plateau - low);
  });
  std::sort(peaks.begin(), peaks.end());
  // One lone outlier must not set the scale: the largest only counts when the next ones come near it.
  const double largest = peaks[peaks.size() - 1 - std::min(kOutlyingPeaks, (peaks.size() - 1) / kPartsPerOutlier)];
  const auto first = std::lower_bound(peaks.begin(), peaks.end(), kHasSlip * largest);
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

// Ringing after a re-stick and spikes are lower and much shorter than the slips. Of what the ends of the record cut,
// v_r does not show how high and long it was: what begins the record may be ringing or the end of a slip; what ends it
// is ringing where it follows a slip as closely as ringing does.
void drop_chatter(std::vector<RawSlip>& slips, double peak) {
  std::vector<double> durations;
  for (const RawSlip& slip : slips) {
    if (slip.peak > kShowsDuration * peak) durations.push_back(static_cast<double>(slip.samples.size()));
  }
  const double usual = durations.empty() ? 0 : median(std::move(durations));
  std::vector<RawSlip> kept;
  std::size_t end = 0;  // of the one before it, or of the ringing after that
  for (RawSlip& slip : slips) {
    const auto duration = static_cast<double>(slip.samples.size());
    const auto since = static_cast<double>(slip.samples.begin - end);
    const bool is_low = slip.peak < kChatterPeak * peak && duration < kChatterTime * usual;
    const bool follows = end > 0 && since < kChatterTime * usual;
    const bool is_spike = duration < kSpikeSamples && duration < kSpikeTime * usual;
    slip.may_be_ringing = is_low && !slip.begins_within;
    end = slip.samples.end;
    if (!is_spike && !(is_low && slip.begins_within && (slip.ends_within || follows))) kept.push_back(slip);
  }
  slips = std::move(kept);
}

/// Friction turns with the motion: a reversal in which it does not is noise of a slow velocity.
std::vector<RawSlip> without_turns_of_noise(const Motion& motion, const std::vector<RawSlip>& slides) {
  std::vector<RawSlip> real;
  for (const RawSlip& slide : slides) {
    double along = 0;
    for (std::size_t i = slide.samples.begin; i < slide.samples.end; ++i) along += slide.direction * motion.friction[i];
    if (!real.empty() && (along < 0 || slide.direction == real.back().direction)) {
      real.back().samples.end = slide.samples.end;
    } else {
      real.push_back(slide);
    }
  }
  return real;
}

/// Every sample, however slow, cut where v_r reverses by more than `band`.
std::vector<RawSlip> all_slides(const std::vector<double>& v, double band) {
  std::vector<RawSlip> slides;
  RawSlip slide;
  slide.direction = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (slide.direction == 0 && std::abs(v[i]) > band) slide.direction = v[i] > 0 ? 1 : -1;
    const double u = slide.direction * v[i];
    if (u < -band) {
      const std::size_t turned = slide.samples.end;
      slides.push_back(slide);
      slide = {{turned, turned}, -slide.direction, 0, false, false};
    }
    if (slide.direction * v[i] > 0) slide.samples.end = i + 1;
    slide.peak = std::max(slide.peak, slide.direction * v[i]);
  }
  if (slide.direction == 0) return slides;
  slide.samples.end = v.size();
  slides.push_back(slide);
  return slides;
}

}  // namespace

Thresholds thresholds_of(const Motion& motion, int threads) {
  Thresholds t;
  if (motion.size() == 0) return t;
  const double noise = motion.velocity_noise;
  const double peak = typical_peak(motion, threads);
  // Rounding of omega r - v_b is no motion.
  double fastest = std::abs(motion.plateau_velocity);
  for (const double v : motion.disc_velocity) fastest = std::max(fastest, std::abs(v));
  fastest = std::max(fastest, std::abs(motion.constant_disc_velocity));
  if (motion.stick.below > 0) return {motion.stick.below, motion.stick.below, peak > motion.stick.below ? peak : 0};
  if (peak <= std::max(kSlipsOverError * noise, kRoundingPart * fastest))
    return {kSlipsOverError * noise, kStickOverError * noise, 0};
  t.peak = peak;
  t.slip = std::max(kSlipsOverFastest * peak, std::min(kSlipsOverError * noise, kSlipAtMost * peak));
  t.stick = std::max(kStickOverPeak * peak, std::min(kStickOverError * noise, kStickAtMost * peak));
  return t;
}

std::vector<RawSlip> find_slips(const Motion& motion, const Thresholds& thresholds) {
  if (thresholds.peak == 0) return {};
  std::vector<RawSlip> slips = hysteresis(motion, thresholds);
  drop_chatter(slips, thresholds.peak);
  return slips;
}

Thresholds thresholds_without_stick(const Motion& motion) {
  // A filter before the recording leaves less noise than a reversal takes to get through rest.
  const double band = motion.stick.never
                          ? kRestNoise * motion.velocity_noise
                          : std::max(kRestNoise * motion.velocity_noise, kReversalPart * typical_peak(motion));
  return {band, band, 0};
}

std::vector<RawSlip> find_slides(const Motion& motion) {
  std::vector<RawSlip> slides;
  const double band = thresholds_without_stick(motion).slip;
  const std::vector<double>& v = motion.relative_velocity;
  if (motion.stick.never) return without_turns_of_noise(motion, all_slides(v, band));
  std::size_t i = 0;
  while (i < v.size() && std::abs(v[i]) <= band) ++i;  // nobody knows in which direction
  while (i < v.size()) {
    RawSlip slide;
    slide.direction = v[i] > 0 ? 1 : -1;
    slide.samples = {i, i + 1};
    for (; i < v.size() && slide.direction * v[i] >= -band; ++i) {
      const double u = slide.direction * v[i];
      if (u > band) slide.samples.end = i + 1;
      slide.peak = std::max(slide.peak, u);
    }
    slides.push_back(slide);
  }
  return slides;
}

std::vector<RawSlip> without_rests(const Motion& motion, const std::vector<RawSlip>& slides, double peak) {
  const double limit = std::max(motion.velocity_noise, kRestDepth * peak);
  std::vector<RawSlip> moving;
  for (const RawSlip& slide : slides) {
    std::size_t begin = slide.samples.begin, rest = begin, blocks = 0;
    const auto keep = [&](std::size_t end) {
      // What reads exactly zero at an end is rest that is shorter than a mean.
      std::size_t first = begin;
      while (first < end && motion.relative_velocity[first] == 0) ++first;
      while (end > first && motion.relative_velocity[end - 1] == 0) --end;
      if (end <= first) return;
      moving.push_back(slide);
      moving.back().samples = {first, end};
    };
    for (std::size_t i = begin; i < slide.samples.end; i += kRestOver) {
      const std::size_t count = std::min(kRestOver, slide.samples.end - i);
      const double mean = mean_of(std::span<const double>(motion.relative_velocity).subspan(i, count));
      if (std::abs(mean - motion.plateau_velocity) <= limit) {
        if (blocks++ == 0) rest = i;
        continue;
      }
      if (blocks >= kFewestRests) {
        keep(rest);
        begin = i;
      }
      blocks = 0;
    }
    keep(blocks >= kFewestRests ? rest : slide.samples.end);
  }
  return moving;
}

bool rests(const Motion& motion, const SampleRange& stick, const Thresholds& thresholds) {
  const std::size_t n = stick.size();
  if (n < kShortestStick) return false;
  const bool block = motion.velocity_kind == VelocityKind::block;
  if (block && motion.disc_velocity.empty()) return true;
  const auto mean = [&](double from, double to) {
    const auto begin = static_cast<std::size_t>(from * static_cast<double>(n));
    const auto end = std::max(begin + 1, static_cast<std::size_t>(to * static_cast<double>(n)));
    return mean_of(std::span<const double>(motion.relative_velocity).subspan(stick.begin + begin, end - begin));
  };
  const double middle = mean(kMiddleOfStick, 1 - kMiddleOfStick), noise = motion.velocity_noise;
  if (block && std::abs(middle) <= kMovesWithDisc * std::abs(motion.disc_velocity[stick.begin + n / 2])) return true;
  if (std::abs(middle) > std::max(kRestNoise * noise, kRestDepth * thresholds.peak)) return false;
  if (n < kShortestShape) return true;
  const double before = mean(kEndsOfStick, kMiddleOfStick), after = mean(1 - kMiddleOfStick, 1 - kEndsOfStick);
  return std::abs(0.5 * (before + after) - middle) <= noise;
}

bool only_reverses(const Motion& motion, const RawSlip& before, const RawSlip& after, const Thresholds& thresholds) {
  if (before.direction == after.direction) return false;
  const std::size_t begin = before.samples.end, end = after.samples.begin, n = end - begin;
  if (n < kShortestTurn) return true;
  const std::size_t third = n / 3;
  double first = 0, last = 0;
  for (std::size_t k = 0; k < third; ++k) {
    first += above_plateau(motion, begin + k);
    last += above_plateau(motion, end - 1 - k);
  }
  return std::abs(last - first) / static_cast<double>(third) > thresholds.stick;
}

bool keeps_speed(const Motion& motion, const SampleRange& slide) {
  if (slide.size() < kShortestSlide) return false;
  std::vector<double> speed(motion.relative_velocity.begin() + static_cast<std::ptrdiff_t>(slide.begin),
                            motion.relative_velocity.begin() + static_cast<std::ptrdiff_t>(slide.end));
  for (double& v : speed) v = std::abs(v);
  const double low = quantile(speed, 0.25), middle = quantile(speed, 0.5), high = quantile(std::move(speed), 0.75);
  return high - low < kKeptSpeed * middle;
}

}  // namespace tribofit::segmentation
