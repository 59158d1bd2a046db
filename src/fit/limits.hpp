#pragma once

#include <cstddef>

// The thresholds by which fits decide, with their reasons.

namespace tribofit {

/// A spread from cycle to cycle needs three of them: fewer leave no degree of freedom beside a mean and its trend.
inline constexpr std::size_t kFewestCycles = 3;

}  // namespace tribofit
