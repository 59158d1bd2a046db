#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "limits.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// What fits come to once they are made: how good one is, which of several predicts better, what it says of each
/// sample.

/// How well a fit describes its record.
enum class FitQuality {
  unusable,          ///< it did not converge, or has no parameters
  floor_too_high,    ///< it leaves less than the noise floor, so nothing can be judged by that
  not_transferable,  ///< its error on held-out cycles is far above that on the cycles it was fitted to
  at_floor,          ///< nothing worth naming is left
  close,             ///< a few per cent off
  outline,           ///< within what [D] calls good
  poor,
};
FitQuality quality_of(const Fit& fit);

/// Held-out error over the noise floor: 1 where both are rounding, NaN where no floor is known.
double over_floor(const Fit& fit);

/// The held-out error is more than noise and the cost of the parameters explain; false where no floor is known.
bool is_above_floor(const Fit& fit);

/// It is so far above the noise floor that the ratio says nothing more.
bool is_far_above_floor(const Fit& fit);

/// [D] Eq 5, |(measured - model)/measured|; NaN where nothing was measured to compare with.
double relative_error(double measured, double model);

/// It is so far above the noise floor that no noise makes it so: the law lacks something, whatever else is known.
bool is_clearly_above_floor(const Fit& fit);

/// The fit leaves clearly more than the noise floor, so that a mean that agrees may hide what it misses.
bool well_above_floor(const Fit& fit);

/// Whether errors and intervals assume a law that does not hold.
bool is_conditional(const Fit& fit);

/// What residuals are measured in: the noise floor, or what they are themselves where none is known.
double residual_unit(const Fit& fit);

/// The joint fit of the same law beside one from per-cycle extremes, which know no effects; nullptr: none.
const Fit* joint_partner(std::span<const Fit> fits, const Fit& fit);

/// A parameter from the per-cycle extremes lies outside the 95 % interval of the joint fit.
bool is_outside(const FitParameter& extreme, const FitParameter& joint);

/// The data fix the parameter to better than its own size.
bool is_fixed(const FitParameter& parameter);

/// The best fit against another of the same protocol, on held-out cycles.
struct LawComparison {
  std::size_t first = 0, second = 0;  ///< indices of fits; `first` is the better one
  Comparison comparison;
  bool clear = false;  ///< significant at the 5 % level
};

/// The best fit against each other fit of the same protocol; empty where there is nothing to compare.
std::vector<LawComparison> compare_laws(std::span<const Fit> fits, std::size_t best);

/// The law of a fit with its band at `points` speeds from rest to a quarter beyond the fastest slip, so that the
/// extrapolation is seen as such. threads: as in law_curve().
Curve curve_of(const Fit& fit, std::size_t points, int threads = 1);

/// Cycle and held-out fold of every sample.
struct Membership {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> cycle;  ///< index in Segmentation::cycles; none outside
  std::vector<std::size_t> fold;   ///< in which the fit held the sample's cycle out; none where it was not fitted
};
/// `before`: cycles of the traces that the fit holds before this one.
Membership membership(const Motion& motion, const Segmentation& segmentation, const Fit* fit, std::size_t before = 0);

/// Units of evidence that a record gives to a fit: slips, or pieces of one where nothing sticks.
std::size_t evidence_of(const Motion& motion, const Segmentation& segmentation);

}  // namespace tribofit
