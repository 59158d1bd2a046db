#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit {

/// What a diagnosis comes to: the same for everybody who reports it.

/// Effects that were found: the rungs above the base law, then what shows in the motion and is no rung. Effects that
/// fit as well as one of the latter stand with the last of them.
std::vector<Rung> found_effects(const Diagnosis& diagnosis);

/// Shares worth naming, in their order: large enough, and not chance.
std::vector<Share> worth_naming(const std::vector<Share>& shares);

/// The largest of the shares worth naming; nullptr where there is none.
const Share* largest_share(const std::vector<Share>& shares);

/// A share of which one says "most of the error".
bool is_most(const Share& share);

/// The finding about an effect; nullptr where there is none.
const EffectFinding* finding_of(const Diagnosis& diagnosis, std::string_view key);

/// The error that goes with a share of the squares above the noise floor [as the errors]; 0 where none is above it.
double error_of_share(double share, double held_out_rmse, double floor_rmse);

/// How a held-out error stands to the noise floor.
enum class FloorComparison { unknown, below, at, above };
FloorComparison against_floor(double held_out_rmse, double floor_rmse);

/// Share of the squares of the base law above the noise floor that is gone at a rung; NaN where none is above it.
double removed_at(const Diagnosis& diagnosis, std::size_t rung);

/// The last rung predicts the run that was not used in the fit better than the base law, and not by chance.
bool is_confirmed(const Confirmation& confirmation);

/// What the last rung leaves on the run that was not used in the fit is clearly above the noise floor of that run.
bool contradicts_law(const Confirmation& confirmation);

}  // namespace tribofit
