#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "styles.hpp"
#include "tribofit/campaign/group_values.hpp"
#include "tribofit/campaign/over_conditions.hpp"
#include "tribofit/report/campaign.hpp"

namespace tribofit {

/// The campaign that is drawn.
struct DrawnCampaign {
  const ResultReader& results;
  std::span<const RunResult> runs;
  const Pooled& pooled;
  const ComparisonReport* comparison;  ///< null: none
  std::vector<std::size_t> shown;      ///< groups of which single runs are drawn

  std::span<const PooledGroup> groups() const { return pooled.groups; }
  std::string name_of(std::size_t group) const;
  /// "1", or "N" where friction is a force.
  std::string friction_unit() const { return runs.empty() ? "1" : runs.front().friction_unit; }
  /// How values of the table named by --compare are called.
  std::string earlier_name() const;
};

DrawnCampaign drawn_campaign(const ResultReader& results, std::span<const RunResult> runs, const Pooled& pooled,
                             const std::optional<ComparisonReport>& comparison);

/// The abscissa of charts over the conditions.
ChartAxis axis_over(const OverConditions& over);

/// Adds a line of a value with its error for each series; value: of a group, nothing where there is none.
void add_over_conditions(const OverConditions& over, const std::string& name, const Stroke& stroke, std::size_t panel,
                         const std::function<std::optional<ResultMeasure>(std::size_t group)>& value, Chart& chart);

/// Adds the earlier values of that name, one for each of the conditions.
void add_earlier(const DrawnCampaign& of, const OverConditions& over, const std::string& name, std::size_t panel,
                 Chart& chart);

/// Fig 5 to 9 of [D]: a section of charts.
ReportSection motion_figures(const DrawnCampaign& of);
/// Fig 10 to 12 of [D].
ReportSection law_figures(const DrawnCampaign& of);

/// A parameter of every run, beside the mean of its group: what repeats scatter by.
Chart scatter_chart(const DrawnCampaign& of, const std::string& law);

}  // namespace tribofit
