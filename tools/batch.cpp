#include "batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <sstream>
#include <system_error>
#include <utility>

#include "console.hpp"
#include "memory.hpp"
#include "results.hpp"
#include "tribofit/campaign/batch.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/text_of_file.hpp"
#include "tribofit/output/whole_file.hpp"
#include "tribofit/report/campaign.hpp"

using namespace tribofit;

namespace {

namespace fs = std::filesystem;

/// "3/16"
Shard shard_from(const std::string& text) {
  Shard shard;
  std::istringstream in(text);
  char slash = 0;
  if (text.empty()) return shard;
  const bool is_plain = text.find_first_not_of("0123456789/") == std::string::npos;
  in >> shard.index >> slash >> shard.count;
  if (in && in.eof() && is_plain && slash == '/' && shard.index >= 1 && shard.index <= shard.count) return shard;
  throw UsageError("--shard: '" + text + "' is not I/N with I from 1 to N, as in 1/4");
}

std::string default_results(const std::string& folder) {
  if (folder.empty()) throw UsageError("--shard of traces named one by one needs --out");
  std::error_code ignored;
  fs::path path = fs::weakly_canonical(folder, ignored);
  if (!path.has_filename()) path = path.parent_path();
  return path.filename().string() + "-results";
}

void refuse_overwriting_inputs(const Settings& s, const Campaign& campaign, const BatchOptions& batch) {
  std::map<fs::path, std::string> inputs;
  std::error_code ignored;
  const auto place_of = [&](const std::string& path) { return fs::weakly_canonical(path, ignored); };
  for (const std::string& companion : batch.companions) inputs.emplace(place_of(companion), companion);
  for (const Run& run : campaign.runs) inputs.emplace(place_of(run.trace.path), run.trace.path);
  const auto check = [&](const char* option, const std::string& output) {
    const auto found = inputs.find(place_of(output));
    if (found != inputs.end()) throw UsageError(option + std::string(" would overwrite ") + found->second);
  };
  check("--out", (fs::path(batch.results) / "summary.csv").string());
  if (!s.report.empty()) check("--report", s.report);
  for (const Run& run : campaign.runs) check("--out", result_path(batch.results, run.name));
}

void check_usage(const Settings& s, const Campaign& campaign, const BatchOptions& batch) {
  const auto refuse = [](bool given, const char* why) {
    if (given) throw UsageError(why);
  };
  const bool sharded = !s.shard.empty(), several = campaign.runs.size() > 1;
  refuse(sharded && !s.report.empty(), "--report needs `identify merge`");
  refuse(!s.json.empty(), "--json needs one trace at a time; --out has a file for each");
  refuse(!s.csv.empty(), "--csv needs one trace at a time");
  refuse(several && !s.identify.read.second_file.empty(), "--with needs one trace at a time");
  refuse(several && !s.identify.read.continued_in.empty(), "--continue needs one trace at a time");
  refuse(sharded && !s.figures.empty(), "--figures needs `identify merge`");
  refuse(!campaign.folder.empty() && same_file(batch.results, campaign.folder),
         "--out is the folder of the traces; name another");
  refuse(sharded && !(s.compare.empty() && s.share.empty() && s.vary.empty()),
         "--compare, --share and --vary need `identify merge`");
  check_comparison(s, batch.results);
  refuse_overwriting(s, {s.compare});
  refuse_overwriting_inputs(s, campaign, batch);
}

/// How the report says what was run.
ReportOptions shown_as(const Settings& s, const Campaign& campaign, std::vector<std::string> arguments) {
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {option, value});
  };
  add("--pattern", s.pattern);
  add("--out", s.out);
  const std::vector<std::string> pooling = pooling_arguments(s);
  arguments.insert(arguments.end(), pooling.begin(), pooling.end());
  return {std::move(arguments), campaign.folder.empty() ? s.traces : std::vector{as_folder(campaign.folder)},
          !s.instruments.empty()};
}

/// Makes the folder, or makes sure that it is one of this campaign.
void claim_results(const Campaign& campaign, const BatchOptions& batch) {
  const fs::path folder(batch.results);
  std::error_code error, ignored;
  fs::create_directories(folder, error);
  if (error) {
    throw InputError("the folder cannot be made: " + error.message(), "name a place you may write to with --out",
                     {batch.results, 0, ""});
  }
  if (fs::exists(folder / campaign_name, ignored)) {
    const auto known = folder_of_campaign(batch.results);
    const std::string own = folder_beside_results(campaign.folder, batch.results);
    if (!known || *known == own || batch.again) return;  // a damaged file is written anew
    const bool is_named = !own.empty() && !known->empty();
    if (is_named && !fs::exists(folder / *known, ignored)) return;  // one of the two was moved or mounted elsewhere
    const std::string other = known->empty() ? "other traces" : fs::weakly_canonical(folder / *known, ignored).string();
    throw InputError("holds the results of " + other, "name another folder with --out, or recompute them with --again",
                     {batch.results, 0, ""});
  }
  for (const Run& run : campaign.runs) {
    const std::string path = result_path(batch.results, run.name);
    if (!fs::exists(path, ignored)) continue;
    const auto known = read_record(path);  // of a batch that ran on while its folder was being removed
    if (known && known->file == run.file) continue;
    throw InputError("exists and is not a result of a campaign", "name another folder with --out", {path, 0, ""});
  }
}

void write_campaign(const Campaign& campaign, const BatchOptions& batch) {
  const std::string path = (fs::path(batch.results) / campaign_name).string();
  const std::string text = campaign_json(campaign, batch);
  std::error_code ignored;
  if (fs::exists(path, ignored) && text_of_file(path, std::uint64_t{1} << 30, "name another folder with --out") == text)
    return;
  write_whole(path, text);
}

/// Runs done and the time left, from the bytes fitted so far.
class Watch {
 public:
  void show(const BatchProgress& p) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
    std::string text = fmt::format("[{}/{}] {}", p.done, p.total, p.name);
    if (p.fitted_bytes > 0) {
      text +=
          "; " + time_left(elapsed.count() * static_cast<double>(p.left_bytes) / static_cast<double>(p.fitted_bytes));
    }
    line_.show(text, static_cast<double>(p.done) / static_cast<double>(p.total));
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  ProgressLine line_;
};

BatchOutcome fit_runs(const Campaign& campaign, const BatchOptions& batch) {
  Watch watch;
  BatchHooks hooks;
  hooks.keep = [&](const RunRecord& record, const Identification* result) {
    write_run(batch.results, record, result, {batch.arguments});
  };
  hooks.progress = [&](const BatchProgress& progress) { watch.show(progress); };
  return run_batch(campaign, batch, hooks);
}

std::string counts(const BatchOutcome& outcome) {
  return fmt::format("{} fitted, {} already there, {} failed", outcome.fitted, outcome.present, outcome.failed);
}

void print_problems(const Campaign& campaign, const BatchOutcome& outcome) {
  for (const std::string& problem : campaign.problems) print_error(problem);
  for (const RunEnd& end : outcome.ends) {
    if (!end.begun || end.message.empty()) continue;
    print_error(end.status == RunStatus::failed && end.kept
                    ? end.run->file + ": the analysis could not be done: " + end.message
                    : end.message);
  }
  if (outcome.stopped) print_error("results can no longer be written: the other runs remain to be done");
}

/// Says where results that were written are no longer there as they were.
ExitStatus refuse_replaced(std::size_t missing, const BatchOutcome& outcome, const std::string& results) {
  const auto unwritten = std::count_if(outcome.ends.begin(), outcome.ends.end(),
                                       [](const RunEnd& end) { return !end.begun || !end.kept; });
  if (missing <= static_cast<std::size_t>(unwritten)) return ExitStatus::done;
  print_error(
      fmt::format("{}: {} of the results were replaced meanwhile, by another batch with other options; give each "
                  "batch a folder of its own with --out",
                  results, missing - static_cast<std::size_t>(unwritten)));
  return ExitStatus::failed;
}

ExitStatus status_of(const Campaign& campaign, const BatchOutcome& outcome) {
  const bool none_read = !outcome.ends.empty() && std::all_of(outcome.ends.begin(), outcome.ends.end(), [](auto& end) {
    return end.kept && end.status == RunStatus::unreadable;
  });
  if (none_read) return ExitStatus::bad_input;
  return outcome.failed > 0 || outcome.stopped || !campaign.problems.empty() ? ExitStatus::failed : ExitStatus::done;
}

/// The next command with the options of this one; where nothing was fitted, what the first file holds.
std::string next_after(const Campaign& campaign, const BatchOutcome& outcome,
                       const std::vector<std::string>& arguments) {
  const std::string first = campaign.runs.front().trace.path;
  if (outcome.fitted + outcome.present == 0) {
    return fmt::format("\nNext, to see what the files hold:\n  identify columns {}\n", shell_quoted(first));
  }
  return fmt::format("\nNext, to see what the laws miss:\n  {}\n",
                     diagnose_command(arguments, campaign.folder.empty() ? first : as_folder(campaign.folder)));
}

}  // namespace

std::string as_folder(std::string name) {
  return name.ends_with('/') ? name : name + "/";
}

bool is_batch(const Settings& s, const Campaign& campaign) {
  return !s.out.empty() || !s.shard.empty() || (!campaign.folder.empty() && campaign.runs.size() > 1);
}

ExitStatus run_as_batch(const Settings& s, Campaign campaign, const IdentifyOptions& options,
                        const std::vector<std::string>& arguments) {
  BatchOptions batch;
  batch.identify = options;
  batch.arguments = arguments;
  batch.companions = input_files(s);
  std::erase(batch.companions, "");
  batch.results = s.out.empty() ? default_results(campaign.folder) : s.out;
  batch.shard = shard_from(s.shard);
  batch.again = s.again;
  batch.threads = options.threads;
  check_usage(s, campaign, batch);
  sharing_from(s);  // refused before anything is fitted
  set_memory(Memory::given_back);
  BatchOutcome outcome;
  ExitStatus refused = ExitStatus::done;
  try {
    claim_results(campaign, batch);
    remove_abandoned_files(batch.results);
    remove_abandoned_files((fs::path(batch.results) / kept_folder).string());
    const bool is_planned = !s.shard.empty() && !batch.again && follow_plan(batch, campaign);
    if (!is_planned) write_campaign(campaign, batch);
    outcome = fit_runs(campaign, batch);
    print_problems(campaign, outcome);
    if (s.shard.empty()) {
      const Summarised all = summarise(s, ResultReader(batch.results), shown_as(s, campaign, arguments));
      if (!s.quiet) print(all.table);
      refused = print_refusals(all);
      refused = worse(refused, refuse_replaced(all.summary.missing, outcome, batch.results));
    }
  } catch (const std::runtime_error& error) {  // the results cannot be written: the input may be as good as it likes
    print_error(error.what());
    return ExitStatus::failed;
  }
  if (!s.quiet) {
    for (const std::string& note : campaign.notes) print(folded(note) + "\n");
    const std::string folder = as_folder(batch.results);
    print(folded(fmt::format("{}; results in {}{}", counts(outcome), folder,
                             s.out.empty() ? " (name another folder with --out)" : "")) +
          "\n");
    print(s.shard.empty()
              ? next_after(campaign, outcome, arguments)
              : fmt::format("\nNext, when every shard is done:\n  identify merge {}\n", shell_quoted(folder)));
  }
  return worse(status_of(campaign, outcome), refused);
}
