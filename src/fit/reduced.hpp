#pragma once

#include <cstddef>
#include <optional>

#include "tribofit/fit/observations.hpp"
#include "tribofit/friction/model.hpp"

namespace tribofit {

/// The same slips in means over `per_value` neighbouring values each, weighted, with the variance of v_r within each
/// mean; what is known of a slip beside its values stays. Cost: one pass.
Observations reduced(const Observations& observations, std::size_t per_value);

/// Fewer values on which the search for the parameters of a model may run, about so many a slip; nothing where there
/// are not twice as many, or where means would hide what the model looks for (a spectral line, a function of time that
/// a user wrote).
std::optional<Observations> reduced_for_search(const FrictionModel& model, const Observations& observations,
                                               double values_per_slip);

}  // namespace tribofit
