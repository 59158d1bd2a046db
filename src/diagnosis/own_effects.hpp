#pragma once

#include <string>
#include <vector>

#include "tribofit/fit/fit.hpp"

namespace tribofit::diagnosis {

/// Refuses effects that a user gives twice, and formulas named as an effect of the catalogue is. Throws InputError.
void refuse_same(const std::vector<Effect>& given);

/// Where an effect has no finite value at its starting values, as a sentence; empty where it is finite everywhere.
std::string not_finite(const Effect& effect, const Record& record);

}  // namespace tribofit::diagnosis
