#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "batch.hpp"
#include "memory.hpp"
#include "tribofit/campaign/batch.hpp"
#include "tribofit/report/csv.hpp"
#include "typed_values.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

void check_usage(const Settings& s, const std::vector<Input>& inputs) {
  const auto in_batch = [](bool given, const std::string& needs) {
    if (given) throw UsageError(needs + " a folder of runs, or with --out");
  };
  in_batch(s.again, "--again needs");
  in_batch(!s.share.empty() || !s.vary.empty(), "--share and --vary need");
  in_batch(!s.compare.empty(), "--compare needs");
  const auto alone = [&](bool given, const std::string& name) {
    if (given && inputs.size() > 1) throw UsageError(name + " needs one trace at a time");
  };
  alone(!s.json.empty(), "--json");
  alone(!s.csv.empty(), "--csv");
  alone(!s.report.empty(), "--report");
  alone(!s.figures.empty(), "--figures");
  alone(!s.identify.read.second_file.empty(), "--with");
  alone(!s.identify.read.continued_in.empty(), "--continue");
  std::vector<std::string> files = input_files(s);
  for (const Input& input : inputs) files.push_back(input.trace.path);
  refuse_overwriting(s, files);
}

ExitStatus run_one(const Settings& s, const Input& input, const IdentifyOptions& options,
                   const std::vector<std::string>& arguments) {
  IdentifyOptions own = options;
  own.read = input.trace.read;
  Identification result = identify(input.trace.path, own);
  add_remarks(input, result);
  const std::vector<std::string> alone = arguments_for(input, arguments);
  deliver(s,
          {[&] { return report_of(result, terminal_options(s, alone)); }, [&] { return to_json(result, {arguments}); },
           [&](const std::string& folder) { write_csv_folder(folder, result); }});
  const std::string failure = result.force_statistics ? "" : failure_of(result);
  if (failure.empty()) return ExitStatus::done;
  print_error(input.trace.path + ": the analysis could not be done: " + failure);
  return ExitStatus::failed;
}

ExitStatus run_all(const Settings& s, const std::vector<Input>& inputs, const IdentifyOptions& options,
                   const std::vector<std::string>& arguments) {
  if (inputs.size() == 1) return run_one(s, inputs.front(), options, arguments);
  std::size_t unreadable = 0;
  ExitStatus status = ExitStatus::done;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    progress("[" + std::to_string(k + 1) + "/" + std::to_string(inputs.size()) + "] " + inputs[k].trace.path);
    if (k > 0 && !s.quiet) print("\n");
    try {
      status = worse(status, run_one(s, inputs[k], options, arguments));
    } catch (const InputError& error) {
      print_error(error.what());
      ++unreadable;
    }
  }
  if (unreadable == inputs.size()) return ExitStatus::bad_input;
  return unreadable > 0 ? ExitStatus::failed : status;
}

void add_batch_options(const Command& app, Settings& s) {
  const Command in = app.in(section::kBatch);
  in.add_option("--out", s.out, "Folder of the results of many traces (default FOLDER-results)");
  in.add_option("--pattern", s.pattern, "How file names state the conditions: 'r{radius}mm_{repeat}.csv'");
  in.add_option("--shard", s.shard, "Only every N-th run, from the I-th: I/N; `identify merge` combines them");
  in.add_flag("--again", s.again, "Fit runs that already have a result, too");
  add_compare_option(app, s);
}

void add_fit_options(const Command& app, Settings& s) {
  add_model_options(app, s);
  add_parameter_options(app, s);
  const Command in = app.in(section::kFit);
  in.add_option("--protocol", s.protocol, "joint, published (per-cycle extremes), or both (default)")
      .one_of({"both", "joint", "published"});
  in.add_flag("--profile", s.identify.fit.profile, "Profile likelihood intervals as well");
}

/// Usage error: a verb that is misspelt is taken for a trace, and no file has its name.
void refuse_misspelt_verb(const Command& app, const std::vector<std::string>& traces) {
  if (traces.empty() || traces.front().find_first_of("./") != std::string::npos) return;
  if (std::error_code ignored; std::filesystem::exists(traces.front(), ignored)) return;
  const std::string verb = app.likely_verb(traces.front());
  if (!verb.empty())
    throw UsageError(
        fmt::format("'{}' is neither a verb nor a file; did you mean `identify {}`?", traces.front(), verb));
}

ExitStatus run_identify(const Settings& s, const std::vector<std::string>& arguments) {
  const IdentifyOptions options = options_from(s);  // says first where an option has taken the trace for its value
  if (s.traces.empty()) throw UsageError("no trace given; try `identify --radius 15mm trace.csv`");
  FindOptions find;
  find.errors = ManifestErrors::collect;
  if (!s.pattern.empty()) find.pattern = as_usage([&] { return NamePattern(s.pattern); });
  Campaign campaign = find_runs(s.traces, options.read, find);
  if (is_batch(s, campaign)) return run_as_batch(s, std::move(campaign), options, arguments);
  std::vector<Input> inputs = std::move(campaign.runs);
  const bool doubtful = std::any_of(inputs.begin(), inputs.end(), [](const Input& i) { return !i.problem.empty(); });
  if (doubtful || !campaign.problems.empty()) {  // refuses them with their place
    find.errors = ManifestErrors::refuse;
    inputs = find_runs(s.traces, options.read, find).runs;
  }
  if (inputs.size() == 1 && !inputs.front().problem.empty()) throw InputError(inputs.front().problem, "");
  check_usage(s, inputs);
  set_memory(Memory::of_one_heap);
  return run_all(s, inputs, options, arguments);
}

}  // namespace

void add_identify(const Command& app) {
  const auto settings = std::make_shared<Settings>();
  add_input_options(app, *settings);
  add_spring_options(app, *settings);
  add_driven_options(app, *settings);
  add_fit_options(app, *settings);
  add_output_options(app, *settings, true);
  add_batch_options(app, *settings);
  add_pooling_options(app, *settings);
  app.before_verb([settings, app](const std::string& verb) {
    if (app.own_options().empty() && settings->traces.empty()) return;
    throw UsageError("put the options after '" + verb + "': identify " + verb + " [OPTIONS]");
  });
  app.on_run([settings, app] {
    refuse_misspelt_verb(app, settings->traces);
    return run_identify(*settings, app.own_options());
  });
}
