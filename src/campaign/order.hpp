#pragma once

#include <span>

#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// Sets the order in time of runs whose conditions tell it, see read_campaign().
void put_in_order(std::span<RunResult> runs);

}  // namespace tribofit
