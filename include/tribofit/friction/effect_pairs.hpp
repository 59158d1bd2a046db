#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// The experiment that distinguishes two effects which look alike in most records, as one imperative sentence without a
/// full stop; empty where the catalogue knows of none. The order of the keys does not matter. Where records can
/// distinguish them, what to record comes first, with speeds, loads and times; all records are then given to the
/// diagnosis together. What a hand measures goes into the instruments file, and is corrected from then on.
std::string discriminating_experiment(std::string_view key_a, std::string_view key_b);

/// Every effect that looks like the one of that key, with the experiment that distinguishes the two.
std::vector<LookAlike> look_alikes(std::string_view key);

}  // namespace tribofit
