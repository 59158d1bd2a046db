#pragma once

#include <cstdint>
#include <vector>

#include "tribofit/fit/observations.hpp"
#include "tribofit/friction/model.hpp"

namespace tribofit {

/// Bounds of every parameter in SI; levels of friction scale with the data where friction is a force.
struct Bounds {
  std::vector<double> lower, upper;
};
Bounds bounds_of(const FrictionModel& model, const Observations& observations);

/// Start from the data: mu_s, mu_k and the decay factor from the best of a grid of decay factors, for each of which the
/// two levels follow linearly from mean friction over speed; effects from their catalogue start.
std::vector<double> start_from_data(const FrictionModel& model, const Observations& observations, const Bounds& bounds);

/// `count` starts: the one from the data, then seeded ones: decay factors log-uniform over what the data can
/// resolve, effects over their bounds.
std::vector<std::vector<double>> make_starts(const FrictionModel& model, const Observations& observations,
                                             const Bounds& bounds, int count, std::uint64_t seed);

}  // namespace tribofit
