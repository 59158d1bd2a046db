#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "campaign_tables.hpp"
#include "report/charts/campaign_parts.hpp"
#include "report_parts.hpp"
#include "tribofit/report/campaign.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kMostRows = 1000, kMostWarnings = 200;

/// A table of at most kMostRows; `file` has all. Many rows are folded away.
void add_table(ReportTable table, const char* file, std::size_t most_open, ReportSection& section) {
  if (table.rows.empty()) return;
  if (table.rows.size() > kMostRows) {
    table.caption += fmt::format("; the first {} of {} rows, {} has all", kMostRows, table.rows.size(), file);
    table.rows.resize(kMostRows);
  }
  table.folded = table.rows.size() > most_open;
  section.items.emplace_back(std::move(table));
}

/// Published values beside ours, and what [D] says in words.
ReportSection comparison_section(const DrawnCampaign& of) {
  ReportSection section{"comparison", "Beside earlier values", {}};
  if (of.comparison == nullptr) return section;
  ReportTable table = comparison_table(*of.comparison, of.groups());
  table.caption = "This campaign beside " + of.earlier_name();
  add_table(std::move(table), "comparison.csv", kMostRows, section);
  for (const std::string& unmatched : of.comparison->values.unmatched) section.items.emplace_back(soft_text(unmatched));
  return section;
}

ReportSection statements_section(const DrawnCampaign& of) {
  ReportSection section{"statements", "Which law predicts better", {}};
  const Statements statements =
      of.comparison != nullptr ? of.comparison->statements : statements_of(of.results, of.runs, of.groups());
  for (const std::string& sentence : preference_sentences(statements, of.groups())) {
    section.items.emplace_back(item_text(sentence));
  }
  add_table(error_table(statements, of.groups()), "summary.json", kMostRows, section);
  return section;
}

ReportSection pooled_section(const DrawnCampaign& of) {
  ReportSection section{"pooled", "All values", {}};
  add_table(groups_table(of.groups()), "pooled.csv", 60, section);
  for (const SharedFit& fit : of.pooled.shared) {
    add_table(shared_table(fit), "shared.csv", kMostRows, section);
    for (const std::string& note : fit.notes) section.items.emplace_back(soft_text(note));
  }
  return section;
}

ReportSection trends_section(const DrawnCampaign& of) {
  ReportSection section{"trends", "Trends", {}};
  for (const std::string& sentence : trend_sentences(of.pooled.trends)) section.items.emplace_back(item_text(sentence));
  add_table(trends_table(of.pooled.trends), "trends.csv", 20, section);
  return section;
}

std::vector<std::string> laws_of(const DrawnCampaign& of) {
  std::vector<std::string> laws;
  for (const PooledGroup& group : of.groups()) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      if (fit.protocol == "joint" && std::find(laws.begin(), laws.end(), fit.law) == laws.end())
        laws.push_back(fit.law);
    }
  }
  return laws;
}

ReportSection runs_section(const DrawnCampaign& of) {
  ReportSection section{"runs", "The runs", {}};
  for (const std::string& law : laws_of(of)) {
    Chart chart = scatter_chart(of, law);
    if (!chart.lines.empty()) section.items.emplace_back(std::move(chart));
  }
  ReportTable runs = runs_table(of.friction_unit());
  runs.caption = fmt::format("{} runs", of.results.size());
  std::size_t next = 0;
  for (std::size_t k = 0; k < of.results.size(); ++k) {
    const bool there = next < of.runs.size() && of.runs[next].position == k;
    runs.rows.push_back(there ? run_row(of.runs[next++]) : run_row(of.results.missing(k)));
  }
  add_table(std::move(runs), "summary.csv", 60, section);
  ReportTable warnings("Warnings of the runs");
  warnings.text({"run", "warning"});
  std::size_t count = 0;
  for (const RunResult& r : of.runs) {
    for (const std::string& warning : r.warnings) {
      if (++count <= kMostWarnings) warnings.rows.push_back({r.run.name, warning});
    }
  }
  if (count > kMostWarnings) {
    warnings.caption += fmt::format("; {} of {}, summary.json has all", kMostWarnings, count);
  }
  add_table(std::move(warnings), "summary.json", 20, section);
  return section;
}

std::size_t count_of_fitted(const DrawnCampaign& of) {
  return static_cast<std::size_t>(
      std::count_if(of.runs.begin(), of.runs.end(), [](const RunResult& r) { return r.run.status == RunStatus::ok; }));
}

std::string lead_of(const DrawnCampaign& of) {
  constexpr std::size_t kLong = 300;
  std::string text = fmt::format("{} of {} runs fitted, under {} condition{}.", count_of_fitted(of), of.results.size(),
                                 of.groups().size(), of.groups().size() == 1 ? "" : "s");
  if (of.comparison != nullptr) {
    std::size_t inside = 0, all = 0;
    for (const ComparedValue& v : of.comparison->values.values) {
      if (v.protocol == "published") continue;
      ++all;
      inside += static_cast<std::size_t>(v.inside95);
    }
    if (all > 0) {
      text += fmt::format(" {} of {} values of {} lie in our 95 % intervals.", inside, all, of.earlier_name());
    }
  }
  if (significant_trends(of.pooled.trends).empty()) return text;
  for (const std::string& trend : trend_sentences(of.pooled.trends)) {
    text += " Trend: " + trend + ".";
    if (text.size() > kLong) break;
  }
  return text;
}

}  // namespace

Report report_of(const ResultReader& results, std::span<const RunResult> runs, const Pooled& pooled,
                 const std::optional<ComparisonReport>& comparison, const ReportOptions& options) {
  const DrawnCampaign of = drawn_campaign(results, runs, pooled, comparison);
  const std::string folder = results.traces().empty() ? results.folder() : results.traces();
  const std::string input = options.inputs.empty() ? folder : options.inputs.front();
  Report report = titled_report("campaign", file_name(folder), "Campaign", lead_of(of));
  const std::size_t fitted = count_of_fitted(of);
  report.facts = {{"runs", std::to_string(results.size())},
                  {"fitted", std::to_string(fitted)},
                  {"failed", std::to_string(runs.size() - fitted)},
                  {"missing", std::to_string(results.size() - runs.size())},
                  {"conditions", std::to_string(of.groups().size())}};
  report.warnings = pooled.trends.warnings;
  for (std::size_t k = 0; k < std::min(results.problems().size(), kMostWarnings); ++k) {
    report.warnings.push_back(results.problems()[k]);
  }
  for (ReportSection section : {comparison_section(of), motion_figures(of), law_figures(of), statements_section(of),
                                pooled_section(of), trends_section(of), runs_section(of)}) {
    if (!section.items.empty()) report.sections.push_back(std::move(section));
  }
  report.sections.push_back(run_section(command_line(terminal_like(options), {}, input),
                                        "Checksums of the traces stand in the results of the runs."));
  return report;
}

}  // namespace tribofit
