#include "tribofit/segmentation/force_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "counts.hpp"
#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// A fall, from its highest to its lowest sample.
struct Fall {
  std::size_t peak = 0, end = 0;
};

SlipSpread spread_of(const std::vector<double>& values) {
  return {segmentation::mean_over_slips(values), standard_deviation(values)};
}

/// The same of all samples, the error from means of blocks: neighbours hold the same friction.
SlipSpread spread_of_whole(const std::vector<double>& values) {
  constexpr std::size_t kBlocks = 100;
  Estimate mean = mean_with_error(block_means(values, values.size() / kBlocks, 1).mean);
  mean.value = mean_of(values);
  return {mean, standard_deviation(values)};
}

/// Standard deviation of the noise, from sample to sample.
double noise_of(const std::vector<double>& friction) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < friction.size(); ++i) steps.push_back(friction[i] - friction[i - 1]);
  const double centre = median(steps);
  return kSigmaPerMad * median_absolute_deviation(steps, centre) / std::sqrt(2.0);
}

/// Falls of at least `least`, by turning points that are at least that far apart.
std::vector<Fall> falls_of(const std::vector<double>& friction, double least) {
  std::vector<Fall> falls;
  std::size_t high = 0, low = 0;
  bool falling = false;
  for (std::size_t i = 1; i < friction.size(); ++i) {
    if (falling ? friction[i] < friction[low] : friction[i] > friction[high]) (falling ? low : high) = i;
    if (std::abs(friction[i] - friction[falling ? low : high]) < least) continue;
    if (falling) falls.push_back({high, low});
    (falling ? high : low) = i;
    falling = !falling;
  }
  return falls;
}

/// What a line through samples [begin, end) says of its first or last.
double at_end_of_line(const std::vector<double>& friction, std::size_t begin, std::size_t end, bool last) {
  const StraightLine line = fit_line(std::span(friction).subspan(begin, end - begin));
  return line.at(last ? static_cast<double>(end - begin - 1) : 0);
}

/// A quarter of a rise from sample `begin` to `end`, both in it.
std::size_t quarter(std::size_t begin, std::size_t end) {
  return std::max<std::size_t>(2, (end - begin + 1) / 4);
}

bool changes_sign(const std::vector<double>& friction, std::size_t begin, std::size_t end) {
  const std::span<const double> part = std::span(friction).subspan(begin, end - begin + 1);
  return std::adjacent_find(part.begin(), part.end(), [](double a, double b) { return a * b < 0; }) != part.end();
}

/// Falls that are quicker than the rises between them; none where most are not.
std::vector<Fall> slips_among(const std::vector<Fall>& falls) {
  std::vector<double> down, up;
  for (std::size_t k = 0; k < falls.size(); ++k) {
    down.push_back(static_cast<double>(falls[k].end - falls[k].peak));
    if (k > 0) up.push_back(static_cast<double>(falls[k].peak - falls[k - 1].end));
  }
  if (up.size() < 2 || median(down) > segmentation::kQuickFall * median(up)) return {};
  return falls;
}

void measure_slips(const Motion& motion, const std::vector<double>& size, const std::vector<Fall>& slips,
                   ForceStatistics& out) {
  std::vector<double> peaks, drops, periods, times;
  for (std::size_t k = 0; k < slips.size(); ++k) {
    const std::size_t rise = k > 0 ? slips[k - 1].end : 0, peak = slips[k].peak, end = slips[k].end;
    const std::size_t next = k + 1 < slips.size() ? slips[k + 1].peak : size.size() - 1;
    if (changes_sign(motion.friction, peak, end)) continue;
    ++out.slips;
    const double level = at_end_of_line(size, peak + 1 - std::min(peak + 1, quarter(rise, peak)), peak + 1, true);
    const double rest = at_end_of_line(size, end, std::min(size.size(), end + quarter(end, next)), false);
    peaks.push_back(level);
    drops.push_back(level - rest);
    times.push_back(motion.time[end] - motion.time[peak]);
    if (k > 0 && !changes_sign(motion.friction, slips[k - 1].peak, peak))
      periods.push_back(motion.time[peak] - motion.time[slips[k - 1].peak]);
  }
  out.peak = spread_of(peaks);
  out.drop = spread_of(drops);
  out.period = spread_of(periods);
  out.slip_time = spread_of(times);
}

}  // namespace

ForceStatistics force_statistics(const Motion& motion) {
  ForceStatistics out;
  std::vector<double> size = motion.friction;
  const auto negative =
      static_cast<std::size_t>(std::count_if(size.begin(), size.end(), [](double x) { return x < 0; }));
  const double part = static_cast<double>(negative) / static_cast<double>(std::max<std::size_t>(1, size.size()));
  out.both_directions = std::min(part, 1 - part) > segmentation::kOtherDirection;
  const double sign = part > 0.5 ? -1 : 1;
  for (double& x : size) x = out.both_directions ? std::abs(x) : sign * x;
  out.whole = spread_of_whole(size);
  if (size.size() < 16) return out;
  const double range = quantile(size, 0.99) - quantile(size, 0.01);
  const double least = std::max(segmentation::kFallOverNoise * noise_of(size), segmentation::kFallOverRange * range);
  if (!(least > 0)) return out;
  measure_slips(motion, size, slips_among(falls_of(size, least)), out);
  return out;
}

}  // namespace tribofit
