#pragma once

#include <string>

#include "tribofit/fit/fit.hpp"

namespace tribofit::diagnosis {

/// Why a formula cannot be fitted to a record, as a sentence: it is not finite at its starting values, or zero whatever
/// its parameters are. Empty where it can.
std::string trouble_with(const Formula& formula, const Record& record);

}  // namespace tribofit::diagnosis
