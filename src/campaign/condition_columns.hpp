#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// A condition over the runs of a campaign.
struct ConditionColumn {
  std::string name, unit;                     ///< "radius", "mm"; a further one without a unit
  std::vector<std::string> text;              ///< of each run, as stated; empty: not stated
  std::vector<std::optional<double>> number;  ///< the same in `unit`, where it is one
};

/// Radius, speed and load as stated beforehand (else as used), further columns, all that any run states.
std::vector<ConditionColumn> condition_columns(std::span<const RunResult> runs);

}  // namespace tribofit
