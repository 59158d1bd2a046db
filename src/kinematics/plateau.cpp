#include "plateau.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limits.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

// Half-sample mode (Robertson and Cryer 1974; Bickel 2002): halve to the densest half until few remain.
double half_sample_mode(std::span<const double> sorted) {
  while (sorted.size() > 3) {
    const std::size_t half = (sorted.size() + 1) / 2;
    std::size_t best = 0;
    double width = sorted[half - 1] - sorted[0];
    for (std::size_t i = 1; i + half <= sorted.size(); ++i) {
      const double w = sorted[i + half - 1] - sorted[i];
      if (w < width) width = w, best = i;
    }
    // Of many identical values (quantised or noise-free data) all must stay, or the walk to the end would drift.
    if (width == 0) return sorted[best];
    sorted = sorted.subspan(best, half);
  }
  return std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(sorted.size());
}

/// How far the middle of a plateau stands out from its shoulders, and one shoulder from the other.
struct Shape {
  double curvature = 0, tilt = 0;
};

Shape shape_of(std::span<const double> run) {
  const std::size_t n = run.size(), eighth = std::max<std::size_t>(1, n / 8);
  const double middle = mean_of(run.subspan(n / 2 - std::min(n / 2, eighth), 2 * eighth));
  const double left = mean_of(run.subspan(eighth / 2, 2 * eighth));
  const double right = mean_of(run.subspan(n - eighth / 2 - 2 * eighth, 2 * eighth));
  return {std::abs(middle - 0.5 * (left + right)), std::abs(right - left)};
}

/// Noise of neighbours in the middle of runs.
double noise_within(std::span<const double> velocity, const std::vector<StickPlateau>& runs) {
  std::vector<double> curvatures;
  for (const StickPlateau& run : runs) {
    for (std::size_t i = run.inner_begin() + 1; i + 1 < run.inner_end(); ++i)
      curvatures.push_back(std::abs(velocity[i - 1] - 2 * velocity[i] + velocity[i + 1]));
  }
  return curvatures.empty() ? 0 : kSigmaPerMad * median(std::move(curvatures)) / std::sqrt(6.0);
}

/// Whether v_r swings back and forth in a run, however little beside other parts of the record.
bool swings(std::span<const double> velocity, const StickPlateau& run, double half_band) {
  double squares = 0;
  for (std::size_t i = run.inner_begin(); i < run.inner_end(); ++i) squares += std::pow(velocity[i] - run.level, 2);
  const double deviation = std::sqrt(squares / static_cast<double>(run.inner_end() - run.inner_begin()));
  return deviation > kSwings * half_band && deviation > kSwingsOverNoise * noise_within(velocity, {run});
}

/// What a plateau may be, over the band.
struct Flatness {
  double curvature = HUGE_VAL, tilt = HUGE_VAL;
};

/// Stretches within a band about the mode that are flat (unless any will do), how long the usual one is, and how far
/// its middle stands out, over the band.
struct FlatRuns {
  std::vector<StickPlateau> runs;
  double curvature = 0, length = 0;
  std::size_t level = 0, within = 0;  ///< blocks that are flat, of those within the band
};

FlatRuns flat_runs(std::span<const double> velocity, double mode, double half_band, const Flatness& most) {
  FlatRuns flat;
  std::vector<double> curvatures, lengths;
  for (std::size_t i = 0; i < velocity.size();) {
    if (std::abs(velocity[i] - mode) > half_band) {
      ++i;
      continue;
    }
    StickPlateau run{i, i, 0};
    while (i < velocity.size() && std::abs(velocity[i] - mode) <= half_band) ++i;
    run.end = i;
    if (run.size() < kFewestBlocks) continue;
    lengths.push_back(static_cast<double>(run.size()));
    flat.within += run.size();
    const Shape shape = shape_of(velocity.subspan(run.begin, run.size()));
    const double curvature = shape.curvature / (2 * half_band);
    if (curvature >= most.curvature || shape.tilt >= 2 * half_band * most.tilt) continue;
    run.level = mean_of(velocity.subspan(run.inner_begin(), run.inner_end() - run.inner_begin()));
    if (std::isfinite(most.tilt) && swings(velocity, run, half_band)) continue;
    flat.runs.push_back(run);
    flat.level += run.size();
    curvatures.push_back(curvature);
  }
  if (!curvatures.empty()) flat.curvature = median(std::move(curvatures));
  if (!lengths.empty()) flat.length = median(std::move(lengths));
  return flat;
}

/// In a band that is wide for a short stick the beginning of the slip belongs to the run: a narrower one leaves it out.
/// A stick then stays as long as it is; a turning point gets shorter with the root of the band, and a reversal, where
/// the velocity passes through it, with the band.
std::vector<StickPlateau> runs_about(std::span<const double> velocity, double mode, double half_band, double tilt) {
  FlatRuns wide = flat_runs(velocity, mode, half_band, {kFlatness, tilt});
  const bool are_long = static_cast<double>(wide.within) > kLongSticks * static_cast<double>(velocity.size());
  if (are_long || (2 * wide.level > wide.within && wide.curvature < kClearlyFlat)) return std::move(wide.runs);
  double length = wide.length;
  for (double band = kNarrower * half_band; band > kNarrowestBand * half_band; band *= kNarrower) {
    FlatRuns narrow = flat_runs(velocity, mode, band, {});
    if (band < kBandNoise * noise_within(velocity, narrow.runs)) break;
    if (narrow.length > kKeepsLength * length && 2 * narrow.runs.size() > wide.runs.size()) {
      return std::move(narrow.runs);
    }
    length = narrow.length;
  }
  return std::move(wide.runs);
}

double weighted_level(const std::vector<StickPlateau>& runs) {
  std::vector<const StickPlateau*> order;
  std::size_t total = 0;
  for (const StickPlateau& run : runs) order.push_back(&run), total += run.size();
  std::sort(order.begin(), order.end(),
            [](const StickPlateau* a, const StickPlateau* b) { return a->level < b->level; });
  std::size_t sum = 0;
  for (const StickPlateau* run : order) {
    sum += run->size();
    if (2 * sum >= total) return run->level;
  }
  return 0;
}

}  // namespace

Plateaus find_plateaus(std::span<const double> velocity, std::optional<LevelRange> range, bool reverses) {
  Plateaus plateaus;
  if (velocity.size() < kFewestBlocks) return plateaus;
  std::vector<double> sorted = thinned(velocity, std::size_t{1} << 15);
  std::sort(sorted.begin(), sorted.end());
  std::span<const double> candidates = sorted;
  if (range) {
    const auto first = std::lower_bound(sorted.begin(), sorted.end(), range->low);
    const auto last = std::upper_bound(first, sorted.end(), range->high);
    candidates =
        candidates.subspan(static_cast<std::size_t>(first - sorted.begin()), static_cast<std::size_t>(last - first));
  }
  if (candidates.size() < kFewestBlocks) return plateaus;
  const double mode = half_sample_mode(candidates);
  const std::size_t tail = sorted.size() / 1000;
  plateaus.depth = std::max(sorted[sorted.size() - 1 - tail] - mode, mode - sorted[tail]);
  plateaus.runs = runs_about(velocity, mode, kPlateauBand * plateaus.depth, reverses ? kPasses : HUGE_VAL);
  plateaus.level = weighted_level(plateaus.runs);
  return plateaus;
}

std::vector<double> spreads_about_parabolas(std::span<const double> signal, const std::vector<StickPlateau>& stretches,
                                            std::size_t factor) {
  constexpr std::size_t most_stretches = 256, parts = 4, least_samples = 8;
  std::vector<double> spreads;
  const std::size_t stride = std::max<std::size_t>(1, stretches.size() / most_stretches);
  for (std::size_t r = 0; r < stretches.size(); r += stride) {
    const std::size_t begin = stretches[r].inner_begin() * factor;
    const std::size_t end = std::min(signal.size(), stretches[r].inner_end() * factor);
    if (end < begin + least_samples) continue;
    const std::size_t length = std::max(least_samples, std::min<std::size_t>((end - begin) / parts, 4096));
    for (std::size_t i = begin; i + length <= end; i += std::max(length, (end - begin) / parts)) {
      const auto part = signal.subspan(i, length);
      spreads.push_back(
          std::sqrt(remainder_about(fit_parabola(part), part).squares / (static_cast<double>(length) - 3)));
    }
  }
  return spreads;
}

double spread_about_parabolas(std::span<const double> signal, const std::vector<StickPlateau>& stretches,
                              std::size_t factor) {
  std::vector<double> spreads = spreads_about_parabolas(signal, stretches, factor);
  return spreads.empty() ? 0 : median(std::move(spreads));
}

}  // namespace tribofit::kinematics
