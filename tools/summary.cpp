#include "batch.hpp"

#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include "console.hpp"
#include "results.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/whole_file.hpp"
#include "typed_values.hpp"

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
  return as_usage([&] { return tribofit::sharing_from(s.share, s.vary); });
}

void check_comparison(const Settings& s, const std::string& results) {
  if (s.compare.empty()) return;
  for (const char* name : {kComparison, "pooled.csv", "summary.csv"}) {
    if (!same_file(s.compare, (fs::path(results) / name).string())) continue;
    throw UsageError("--compare names a file that these results would overwrite; copy it elsewhere");
  }
  if (std::error_code ignored; !fs::is_regular_file(s.compare, ignored) || !std::ifstream(s.compare)) {
    throw InputError("--compare: the file cannot be read", "name a table as data/published/table4.csv",
                     {s.compare, 0, ""});
  }
}

Summarised summarise(const Settings& s, const ResultReader& results, const ReportOptions& shown) {
  Summarised out;
  const std::vector<RunResult> runs = read_results(results.folder());
  Pooled pooled = pool_campaign(runs);
  const std::vector<PooledGroup>& groups = pooled.groups;
  // What is asked beyond the summary may not be possible; the summary is.
  const Sharing sharing = sharing_from(s);
  try {
    if (!sharing.common.empty()) pooled.shared = fit_shared(runs, sharing, &results);
  } catch (const InputError& error) {
    out.refused.push_back({groups.empty() ? ExitStatus::failed : ExitStatus::wrong_usage, error.what()});
  }
  std::optional<ComparisonReport> comparison;
  try {
    comparison = comparison_of(s, results, runs, groups);
  } catch (const InputError& error) {
    out.refused.push_back({ExitStatus::bad_input, error.what()});
  }
  write_pooled(results.folder(), runs, pooled);
  write_figures(results, runs, groups);
  const fs::path table = fs::path(results.folder()) / kComparison;
  std::string json;
  if (comparison) {
    write_whole(table.string(), comparison_csv(*comparison, groups));
    json = comparison_json(*comparison, groups);
  } else if (std::error_code ignored; fs::exists(table, ignored)) {
    out.note = table.string() + " is of an earlier run with --compare; give --compare again to renew it";
  }
  TerminalOptions options = terminal_options(s, shown.arguments);
  options.inputs = shown.inputs;
  const Report report = report_of(results, runs, pooled, comparison, options);
  ReportFiles drawn(s, report);
  out.summary = write_summary(results, json);
  out.summary.missing = results.size() - runs.size();  // as the table says: another batch may have written meanwhile
  drawn.commit();
  out.table = render_terminal(report, options);
  if (!out.note.empty()) out.table += folded(out.note) + "\n";
  return out;
}

ExitStatus print_refusals(const Summarised& all) {
  ExitStatus status = ExitStatus::done;
  for (const Summarised::Refusal& refusal : all.refused) {
    print_error(refusal.why);
    status = worse(status, refusal.status);
  }
  return status;
}
