#include "assessment.hpp"

#include <algorithm>
#include <cmath>

#include "observing.hpp"
#include "tribofit/fit/observations.hpp"

namespace tribofit {

double over_floor(const Fit& fit) {
  constexpr double kRounding = 1e-9;
  if (fit.error.held_out_rmse < kRounding) return 1;  // simulated without noise
  return fit.floor.rmse > 0 ? fit.error.held_out_rmse / fit.floor.rmse : std::nan("");
}

namespace {

/// What the parameters alone do to an error on held-out points, over the noise: where they are few, and as many
/// parameters, the true law is not at the noise floor.
double cost_of_parameters(const Fit& fit) {
  const auto count = static_cast<double>(fit.observations), parameters = static_cast<double>(fit.parameters.size());
  const bool points = fit.cycles == fit.observations;  // each is evidence of its own
  return points && count > parameters ? std::sqrt(1 + parameters / (count - parameters)) : 1;
}

}  // namespace

FitQuality quality_of(const Fit& fit) {
  if (!fit.converged || fit.parameters.empty()) return FitQuality::unusable;
  const double ratio = over_floor(fit), cost = cost_of_parameters(fit);
  if (ratio < 1 / kAtFloor) return fit.floor.sampling > 0 ? FitQuality::at_floor : FitQuality::floor_too_high;
  // The parameters lower the error of what they were fitted to by as much again.
  if (fit.error.held_out_rmse > kLearntByHeart * cost * cost * fit.error.rmse) return FitQuality::not_transferable;
  if (ratio <= kAtFloor * cost) return FitQuality::at_floor;
  if (fit.error.mean_relative <= kClose) return FitQuality::close;
  return fit.error.mean_relative <= kOutline ? FitQuality::outline : FitQuality::poor;
}

bool is_above_floor(const Fit& fit) {
  return over_floor(fit) > kAtFloor;
}

bool is_far_above_floor(const Fit& fit) {
  return over_floor(fit) > kFarAboveFloor;
}

bool is_clearly_above_floor(const Fit& fit) {
  return over_floor(fit) > kClearlyAbove;
}

double relative_error(double measured, double model) {
  return measured == 0 ? std::nan("") : std::abs((measured - model) / measured);
}

bool well_above_floor(const Fit& fit) {
  return fit.error.held_out_rmse > kWellAbove * fit.floor.rmse;
}

bool is_conditional(const Fit& fit) {
  return well_above_floor(fit) && over_floor(fit) > 1;
}

double residual_unit(const Fit& fit) {
  if (fit.floor.rmse > 0) return fit.floor.rmse;
  return fit.error.rmse > 0 ? fit.error.rmse : 1;
}

const Fit* joint_partner(std::span<const Fit> fits, const Fit& fit) {
  if (fit.protocol != Protocol::published) return nullptr;
  const auto at = std::find_if(fits.begin(), fits.end(), [&](const Fit& other) {
    return other.protocol == Protocol::joint && other.model.law() == fit.model.law();
  });
  return at == fits.end() ? nullptr : &*at;
}

bool is_outside(const FitParameter& extreme, const FitParameter& joint) {
  return extreme.value < joint.lower95 || extreme.value > joint.upper95;
}

bool is_fixed(const FitParameter& p) {
  return !p.at_bound && p.upper95 - p.lower95 < std::abs(p.value);
}

std::vector<LawComparison> compare_laws(std::span<const Fit> fits, std::size_t chosen) {
  std::vector<LawComparison> comparisons;
  if (fits.empty()) return comparisons;
  const Fit& best = fits[chosen];
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const Fit& other = fits[k];
    const bool comparable = k != chosen && other.protocol == best.protocol && other.converged &&
                            other.cycle_squares.size() == best.cycle_squares.size() && !best.cycle_squares.empty();
    if (!comparable) continue;
    const Comparison comparison = compare_held_out(best, other);
    comparisons.push_back({chosen, k, comparison, comparison.p_value < kClearlyBetter});
  }
  return comparisons;
}

std::size_t evidence_of(const Motion& motion, const Segmentation& segmentation) {
  return slip_ranges(motion, segmentation).size();
}

Curve curve_of(const Fit& fit, std::size_t points, int threads) {
  constexpr double kReach = 1.25;
  std::vector<double> velocity(points);
  for (std::size_t i = 0; i < points; ++i) {
    velocity[i] = kReach * fit.fastest * static_cast<double>(i) / static_cast<double>(points - 1);
  }
  return law_curve(fit, velocity, threads);
}

Membership membership(const Motion& motion, const Segmentation& segmentation, const Fit* fit, std::size_t before) {
  const std::vector<Cycle>& cycles = segmentation.cycles;
  Membership out;
  out.cycle.assign(motion.size(), Membership::none);
  out.fold.assign(motion.size(), Membership::none);
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    for (const SampleRange& span : {cycles[c].stick, cycles[c].slip}) {
      const std::size_t end = std::min(span.end, out.cycle.size());
      for (std::size_t i = span.begin; i < end; ++i) out.cycle[i] = c;
    }
  }
  if (fit == nullptr || fit->cycles == 0) return out;
  // The unit of evidence is a slip, or a piece of one where nothing sticks; stick goes with the slip after it.
  for (const Observations::SlipObservation& range : slip_ranges(motion, segmentation)) {
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
