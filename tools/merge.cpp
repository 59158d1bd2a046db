#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

#include "batch.hpp"
#include "console.hpp"
#include "options.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

constexpr int kDone = 0, kFailed = 1;

constexpr const char* kFooter =
    "The shards of a campaign need only see the same folders:\n"
    "  identify runs/ --out results/ --shard 1/2      (on one machine)\n"
    "  identify runs/ --out results/ --shard 2/2      (on another)\n"
    "  identify merge results/\n"
    "The summary is the same to the last byte as that of one batch. Runs without a whole result are named, and the\n"
    "status is 1; doing a shard again does only those.";

int merge(const Settings& s, const std::string& folder) {
  const CampaignResults results = read_campaign(folder);
  try {
    summarise(s, folder, results);
  } catch (const InputError& error) {
    complain(error.what());
    return kFailed;
  }
  for (const std::string& problem : results.problems) complain(problem);
  std::size_t failed = 0;
  for (const RunResult& result : results.runs) {
    if (result.run.status == RunStatus::ok) continue;
    ++failed;
    complain(result.run.file + ": " + std::string(to_string(result.run.status)) + ": " + result.run.message);
  }
  for (const MissingRun& run : results.missing) complain(run.file + ": there is no result of it yet");
  if (!s.quiet) {
    print(fmt::format("{} fitted, {} failed, {} missing; summary in {}summary.csv\n", results.runs.size() - failed,
                      failed, results.missing.size(), as_folder(folder)));
    const bool again = !results.missing.empty() && !results.folder.empty();
    print(again ? fmt::format("\nNext, to do what is missing:\n  identify {} --out {}\n",
                              shell_quoted(as_folder(results.folder)), shell_quoted(as_folder(folder)))
                : "\nNext, to see what can be done with a trace:\n  identify --help\n");
  }
  return failed > 0 || !results.missing.empty() || !results.problems.empty() ? kFailed : kDone;
}

}  // namespace

void add_merge(CLI::App& app, int& status) {
  const auto settings = std::make_shared<Settings>();
  const auto folder = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("merge", "Put the results of the shards of a campaign together");
  verb->footer(kFooter);
  verb->add_option("RESULTS", *folder, "Folder of results, as given to --out")->required();
  verb->add_flag("--quiet", settings->quiet, "Do not print the table")->group("Output");
  verb->callback([settings, folder, verb, &status] {
    refuse_empty_values(*verb);
    status = merge(*settings, *folder);
  });
}
