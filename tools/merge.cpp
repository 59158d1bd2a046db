#include <fmt/format.h>

#include <filesystem>

#include "batch.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/report/campaign.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

ExitStatus merge(const Settings& s, const std::string& folder, const ReportOptions& shown) {
  check_comparison(s, folder);
  refuse_overwriting(s, {s.compare});
  const ResultReader results(folder);
  Summarised all;
  try {
    all = summarise(s, results, shown);
  } catch (const std::runtime_error& error) {  // it cannot be written
    print_error(error.what());
    return ExitStatus::failed;
  }
  const CampaignSummary& summary = all.summary;
  for (const std::string& problem : results.plan().problems) print_error(problem);
  for (const std::string& error : summary.errors) print_error(error);
  if (!s.quiet) {
    print(all.table);
    print(fmt::format("{} fitted, {} failed, {} missing; summary in {}summary.csv\n", summary.fitted, summary.failed,
                      summary.missing, as_folder(folder)));
    const std::filesystem::path traces = std::filesystem::path(folder) / results.plan().folder;
    print(summary.missing > 0 && !results.plan().folder.empty()
              ? fmt::format("\nNext, to do what is missing, with the same options:\n  identify {} --out {}\n",
                            shell_quoted(as_folder(std::filesystem::proximate(traces).string())),
                            shell_quoted(as_folder(folder)))
              : "\nNext, to see the options for one trace:\n  identify --help\n");
  }
  const bool whole = summary.failed == 0 && summary.missing == 0 && results.plan().problems.empty();
  return worse(whole ? ExitStatus::done : ExitStatus::failed, print_refusals(all));
}

}  // namespace

void add_merge(const Command& app) {
  const auto settings = std::make_shared<Settings>();
  const auto folder = std::make_shared<std::string>();
  const Command verb = app.add_verb(
      "merge", "Combine the results of the shards of a campaign",
      "The shards of a campaign need only see the same folders:\n"
      "  identify runs/ --out results/ --shard 1/2      (on one machine)\n"
      "  identify runs/ --out results/ --shard 2/2      (on another)\n"
      "  identify merge results/\n"
      "The summary is the same to the last byte as that of one batch. Runs without a whole result are named, and the\n"
      "status is 1; running a shard again does only those.");
  verb.add_option("RESULTS", *folder, "Folder of results, as given to --out").required();
  add_pooling_options(verb, *settings);
  add_compare_option(verb, *settings);
  add_report_option(verb, *settings);
  verb.in(section::kOutput).add_flag("--quiet", settings->quiet, "Do not print the table");
  verb.on_run([settings, folder, verb] {
    std::vector<std::string> arguments = pooling_arguments(*settings);
    arguments.insert(arguments.begin(), "merge");
    return merge(*settings, *folder, {arguments, {as_folder(*folder)}});
  });
}
