#include "measures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribofit/fit/observations.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

Interval interval_of(const Estimate& measure) {
  const double half = t_quantile_95(measure.degrees_of_freedom) * measure.std_error;
  return {measure.value - half, measure.value + half};
}

LongSticks long_sticks(const Segmentation& segmentation) {
  LongSticks out{0, std::nan("")};
  for (const Cycle& cycle : segmentation.cycles) {
    if (!(cycle.stick_time > 0)) continue;
    if (cycle.stick_time > 1) ++out.count;
    if (!(out.longest >= cycle.stick_time)) out.longest = cycle.stick_time;
  }
  return out;
}

std::size_t count_of_cycles(const Segmentation& segmentation) {
  return static_cast<std::size_t>(
      std::count_if(segmentation.cycles.begin(), segmentation.cycles.end(),
                    [](const Cycle& c) { return c.stick.size() > 0 && c.slip.size() > 0; }));
}

std::vector<LawComparison> compare_laws(std::span<const Fit> fits, std::size_t chosen) {
  std::vector<LawComparison> comparisons;
  if (fits.empty()) return comparisons;
  const Fit& best = fits[chosen];
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const Fit& other = fits[k];
    const bool comparable = k != chosen && other.protocol == best.protocol && other.converged &&
                            other.cycle_squares.size() == best.cycle_squares.size() && !best.cycle_squares.empty();
    if (comparable) comparisons.push_back({chosen, k, compare_held_out(best, other)});
  }
  return comparisons;
}

std::size_t evidence_of(const Identification& trace) {
  return observe(trace.motion, trace.segmentation, {}, 1).cycles;
}

Curve curve_of(const Fit& fit, std::size_t points) {
  constexpr double kReach = 1.25;
  std::vector<double> velocity(points);
  for (std::size_t i = 0; i < points; ++i) {
    velocity[i] = kReach * fit.fastest * static_cast<double>(i) / static_cast<double>(points - 1);
  }
  return law_curve(fit, velocity);
}

Membership membership(const Identification& trace, const Fit* fit, std::size_t before) {
  const std::vector<Cycle>& cycles = trace.segmentation.cycles;
  Membership out;
  out.cycle.assign(trace.motion.size(), Membership::none);
  out.fold.assign(trace.motion.size(), Membership::none);
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    for (const SampleRange& span : {cycles[c].stick, cycles[c].slip}) {
      const std::size_t end = std::min(span.end, out.cycle.size());
      for (std::size_t i = span.begin; i < end; ++i) out.cycle[i] = c;
    }
  }
  if (fit == nullptr || fit->cycles == 0) return out;
  // The unit of evidence is a slip, or a piece of one where nothing sticks; stick goes with the slip after it.
  for (const Observations::SlipObservation& range : observe(trace.motion, trace.segmentation, {}, 1).slips) {
    const std::size_t fold = fit->fold_of(before + range.cycle);
    std::size_t begin = range.samples.begin;
    const std::size_t c = out.cycle[begin];
    if (c != Membership::none && cycles[c].slip.begin == begin && cycles[c].stick.size() > 0) {
      begin = cycles[c].stick.begin;
    }
    for (std::size_t i = begin; i < range.samples.end; ++i) {
      if (out.cycle[i] == c) out.fold[i] = fold;
    }
  }
  return out;
}

}  // namespace tribofit
