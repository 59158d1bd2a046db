#pragma once

#include <optional>
#include <span>
#include <string>

#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// Whether a column of that name can mean nothing but when a run was made.
bool tells_order(const std::string& name);

/// The number that a cell holds, and nothing else.
std::optional<double> number_in(const std::string& text);

/// Sets the order in time of runs whose conditions state it, see read_results().
void put_in_order(std::span<RunResult> runs);

}  // namespace tribofit
