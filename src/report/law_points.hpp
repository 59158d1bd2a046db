#pragma once

#include <vector>

#include "json_parts.hpp"
#include "page_charts.hpp"

namespace tribofit {

/// Adds what the slips of a trace say of friction over speed: "branches" (mu while speeding up and while slowing down,
/// as bands over cycles), "residuals" of each model in the same bins and in units of the floor, "errors" ([D] Eq 5) of
/// each model over speed and time, "map" (residual of the first model over cycle and phase of the slip).
/// predictions: of each model at every sample, NaN outside slips.
void add_law_points(const Identification& trace, const std::vector<std::vector<double>>& predictions,
                    const std::vector<DrawnModel>& models, Json& json);

}  // namespace tribofit
