#pragma once

#include <span>
#include <string>
#include <vector>

#include "tribofit/report/campaign.hpp"

namespace tribofit {

/// The campaign that is drawn.
struct DrawnCampaign {
  const ResultReader& results;
  std::span<const RunResult> runs;
  std::span<const PooledGroup> groups;
  const EarlierComparison* earlier;  ///< null: none
  std::vector<std::size_t> shown;    ///< groups of which single runs are drawn

  DrawnCampaign(const ResultReader& all_results, std::span<const RunResult> all_runs, const Pooled& pooled,
                const std::optional<ComparisonReport>& comparison);
  /// "1", or "N" where friction is a force.
  std::string friction_unit() const { return runs.empty() ? "1" : runs.front().friction_unit; }
  /// How values of the table named by --compare are called.
  std::string earlier_name() const;
};

/// Fig 5 to 9 of [D]: a section of charts.
ReportSection motion_figures(const DrawnCampaign& campaign);
/// Fig 10 to 12 of [D].
ReportSection law_figures(const DrawnCampaign& campaign);

/// The parameters of every run, beside those of its repeats: what repeats scatter by.
Chart scatter_chart(const DrawnCampaign& campaign, const std::string& law);

/// Pooled values with the parts of their errors; those of the joint fit alone, or all with the measures.
ReportTable repeats_table(std::span<const PooledGroup> groups, bool joint_alone);

/// The runs with their status and best fit: a table without rows, and the row of a run.
ReportTable runs_table(const std::string& friction_unit);
std::vector<std::string> run_row(const RunResult& run);

}  // namespace tribofit
