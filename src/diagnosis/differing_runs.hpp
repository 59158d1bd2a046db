#pragma once

#include <functional>
#include <span>
#include <vector>

#include "diagnose_traces.hpp"

namespace tribofit::diagnosis {

/// Diagnoses records together, as the options say.
using DiagnoseRecords = std::function<Diagnosed(std::span<const Record>)>;

/// Says that the law differs from run to run, where each run by itself is described down to its noise floor and all
/// together are not. Effects that a single run could show and none does are withdrawn: they follow what differs between
/// the runs. What only several runs show together (ageing over speeds, a load law) stays.
/// Costs a diagnosis of each of the longest runs, only where that of all leaves an error well above the noise floor.
void withhold_of_differing_runs(const std::vector<PreparedTrace>& traces, const DiagnoseRecords& diagnose_records,
                                Diagnosed& diagnosed);

}  // namespace tribofit::diagnosis
