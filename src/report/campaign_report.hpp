#pragma once

#include <span>
#include <string>
#include <vector>

#include "tribofit/report/campaign.hpp"

namespace tribofit {

/// Pooled values with the parts of their errors; those of the joint fit alone, or all with the measures.
ReportTable repeats_table(std::span<const PooledGroup> groups, bool joint_alone);

/// The runs with their status and best fit: a table without rows, and the row of a run.
ReportTable runs_table(const std::string& friction_unit);
std::vector<std::string> run_row(const RunResult& run);

}  // namespace tribofit
