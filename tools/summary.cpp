#include "summary.hpp"

#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include "inputs.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/report/comparison.hpp"
#include "tribofit/report/figures.hpp"
#include "tribofit/report/pooled.hpp"
#include "tribofit/report/whole_file.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

namespace fs = std::filesystem;

constexpr const char* kComparison = "comparison.csv";

std::optional<ComparisonReport> comparison_of(const Settings& s, const ResultReader& results,
                                              std::span<const RunResult> runs, std::span<const PooledGroup> groups) {
  if (s.compare.empty()) return std::nullopt;
  return ComparisonReport{compare_with(read_earlier(s.compare, groups), groups), statements_of(results, runs, groups)};
}

}  // namespace

Sharing sharing_from(const Settings& s) {
  Sharing sharing;
  try {
    for (const std::string& text : s.share) sharing.common.push_back(share_from(text));
    for (const std::string& text : s.vary) sharing.common.push_back(vary_from(text));
  } catch (const InputError& error) {
    throw CLI::ValidationError(error.what());
  }
  return sharing;
}

void check_comparison(const Settings& s, const std::string& results) {
  if (s.compare.empty()) return;
  for (const char* name : {kComparison, "pooled.csv", "summary.csv"}) {
    if (!same_file(s.compare, (fs::path(results) / name).string())) continue;
    throw CLI::ValidationError("--compare names a file that these results overwrite; copy it elsewhere");
  }
  if (std::error_code ignored; fs::is_directory(s.compare, ignored) || !std::ifstream(s.compare)) {
    throw InputError("--compare: the file cannot be read", "name a table as data/published/table4.csv",
                     {s.compare, 0, ""});
  }
}

CampaignSummary summarise(const Settings& s, const ResultReader& results) {
  const std::vector<RunResult> runs = read_results(results.folder());
  const Pooled pooled = pool_campaign(runs, sharing_from(s));
  const std::vector<PooledGroup>& groups = pooled.groups;
  const auto comparison = comparison_of(s, results, runs, groups);
  write_pooled(results.folder(), runs, pooled);
  write_figures(results, runs, groups);
  const fs::path table = fs::path(results.folder()) / kComparison;
  std::string json;
  if (comparison) {
    write_whole(table.string(), comparison_csv(*comparison, groups));
    json = comparison_json(*comparison, groups);
  } else {
    std::error_code ignored;
    fs::remove(table, ignored);  // of an earlier summary; it would not fit this one
  }
  const TerminalOptions options = terminal_options(s, {});
  CampaignSummary summary = write_summary(results, options, json);
  summary.table += pooled_table(pooled, options);
  if (comparison) summary.table += render_comparison(*comparison, groups, options);
  return summary;
}
