#pragma once

#include <vector>

#include "tribofit/fit/fit.hpp"

namespace tribofit {

/// Adds what a careful person would say of the parameters: at a bound, not moved by the data, strongly correlated,
/// beyond what the data reach. `unconstrained`: parameters with no influence on any residual; `groups`: see
/// undetermined().
void add_messages(const std::vector<bool>& unconstrained, const std::vector<std::vector<std::size_t>>& groups,
                  Fit& fit);

}  // namespace tribofit
