#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/friction/model.hpp"

namespace tribofit {

/// A parameter with bounds, start and neutral value on the scale of the record: levels of friction and what scales
/// with them where friction is a force, and what its BoundScaling says. Of several records a range that goes with
/// their extent holds that of each: a time constant that one of them shows is no less possible beside a longer one.
Parameter on_scale_of(Parameter parameter, const Observations& observations);

/// Bounds of every parameter in SI. Levels of friction, and what scales with them, grow with the data where friction is
/// a force; the steepness of a law with the speeds that were recorded.
struct Bounds {
  std::vector<double> lower, upper;
};
Bounds bounds_of(const FrictionModel& model, const Observations& observations);

/// Takes over the bounds that were given.
void apply_given(const FrictionModel& model, const std::vector<GivenParameter>& given, Bounds& bounds);
/// Takes over the starts that were given, within the bounds.
void apply_given(const FrictionModel& model, const std::vector<GivenParameter>& given, const Bounds& bounds,
                 std::vector<double>& start);

/// Distance since a reversal, between lower and upper [m], at which the level of the residual changes most: one value
/// for each of the observations.
double distance_of_change(const Observations& observations, std::span<const double> residual, double lower,
                          double upper);

/// Start from the data: the law from mean friction over speed (its start()), effects from their catalogue start.
std::vector<double> start_from_data(const FrictionModel& model, const Observations& observations, const Bounds& bounds);

/// At least `count` starts: the one from the data, the bare law with effects that hardly act, then seeded ones: the
/// steepness of the law log-uniform over what the data can resolve, effects over their bounds.
std::vector<std::vector<double>> make_starts(const FrictionModel& model, const Observations& observations,
                                             const Bounds& bounds, int count, std::uint64_t seed);

/// Friction about its mean over speed, one value for each of the observations, signed: what a law of speed leaves,
/// before any law is fitted.
std::vector<double> about_mean_curve(const Observations& observations);

}  // namespace tribofit
