#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "campaign_tables.hpp"
#include "report/charts/campaign_figures.hpp"
#include "report_parts.hpp"
#include "tribofit/report/campaign.hpp"

namespace tribofit {
namespace {

/// A page shows the first rows of long tables, and folds many rows away.
void limit_tables(Report& report) {
  constexpr std::size_t kMostRows = 1000, kMostOpen = 60;
  for (ReportSection& section : report.sections) {
    for (ReportItem& item : section.items) {
      auto* table = std::get_if<ReportTable>(&item);
      if (table == nullptr || item.medium == Medium::terminal || section.medium == Medium::terminal) continue;
      table->folded |= table->rows.size() > kMostOpen;
      if (table->rows.size() <= kMostRows) continue;
      table->caption +=
          fmt::format("; the first {} of {} rows, {} has all", kMostRows, table->rows.size(), table->file);
      table->rows.resize(kMostRows);
    }
  }
}

ReportTable listed_runs(const DrawnCampaign& campaign) {
  ReportTable runs = runs_table(campaign.friction_unit());
  std::size_t next = 0;
  for (std::size_t k = 0; k < campaign.results.size(); ++k) {
    const bool there = next < campaign.runs.size() && campaign.runs[next].position == k;
    runs.rows.push_back(there ? run_row(campaign.runs[next++]) : run_row(campaign.results.plan()[k]));
  }
  return runs;
}

ReportSection runs_section(const DrawnCampaign& campaign, ReportTable runs) {
  ReportSection section{"runs", "The runs", {}, Medium::page};
  for (const ResultFit* fit : joint_fits(campaign.runs)) section.add(scatter_chart(campaign, fit->law));
  runs.caption = fmt::format("{} runs", campaign.results.size());
  section.add(std::move(runs));
  ReportTable warnings("Warnings of the runs", "summary.json");
  warnings.text({"run", "warning"});
  for (const RunResult& r : campaign.runs) {
    for (const std::string& warning : r.warnings) warnings.rows.push_back({r.run.name, warning});
  }
  section.add(std::move(warnings));
  return section;
}

std::string lead_of(const DrawnCampaign& campaign, std::size_t fitted, const Trends& trends) {
  constexpr std::size_t kLong = 300;
  std::string text = fmt::format("{} of {} runs fitted, under {} condition{}.", fitted, campaign.results.size(),
                                 campaign.groups.size(), campaign.groups.size() == 1 ? "" : "s");
  if (campaign.earlier != nullptr) {
    const EarlierComparison::Agreement agreement = campaign.earlier->agreement();
    if (agreement.values > 0) {
      text += fmt::format(" {} of {} values of {} lie in our 95 % intervals.", agreement.inside, agreement.values,
                          campaign.earlier_name());
    }
  }
  if (significant_trends(trends).empty()) return text;
  for (const std::string& trend : trend_sentences(trends)) {
    text += " Trend: " + trend + ".";
    if (text.size() > kLong) break;
  }
  return text;
}

}  // namespace

Report report_of(const ResultReader& results, std::span<const RunResult> runs, const Pooled& pooled,
                 const std::optional<ComparisonReport>& comparison, const ReportOptions& options) {
  const DrawnCampaign campaign(results, runs, pooled, comparison);
  const std::string folder = results.traces().empty() ? results.folder() : results.traces();
  const std::string input = options.inputs.empty() ? folder : options.inputs.front();
  const auto fitted = static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const RunResult& r) { return r.run.status == RunStatus::ok; }));
  Report report = titled_report("campaign", file_name(folder), "Campaign", lead_of(campaign, fitted, pooled.trends));
  report.facts = {{"runs", std::to_string(results.size())},
                  {"fitted", std::to_string(fitted)},
                  {"failed", std::to_string(runs.size() - fitted)},
                  {"missing", std::to_string(results.size() - runs.size())},
                  {"conditions", std::to_string(campaign.groups.size())}};
  constexpr std::size_t kMostWarnings = 200;
  report.warnings = pooled.trends.warnings;
  for (std::size_t k = 0; k < std::min(results.problems().size(), kMostWarnings); ++k) {
    report.warnings.push_back(results.problems()[k]);
  }
  ReportTable listed = listed_runs(campaign);
  report.add(
      {{"first-runs",
        "",
        {listed, ReportText{"+/- is one standard error of the run, from its cycles; held-out error and noise floor "
                            "are RMSE"}},
        Medium::terminal}});
  if (comparison) report.add({comparison_section(comparison->values, campaign.groups)});
  if (options.charts) report.add({motion_figures(campaign), law_figures(campaign)});
  if (comparison || options.charts) {
    ReportSection section = statements_section(
        comparison ? comparison->statements : statements_of(results, runs, campaign.groups), campaign.groups);
    if (!comparison) section.medium = Medium::page;
    report.add({std::move(section)});
  }
  report.add({pooled_section(pooled), trends_section(pooled.trends)});
  if (options.charts) report.add({runs_section(campaign, std::move(listed))});
  report.add({run_section(report, command_line(options, {}, input), {},
                          " Checksums of the traces stand in the results of the runs.")});
  limit_tables(report);
  return report;
}

}  // namespace tribofit
