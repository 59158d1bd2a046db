#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis_options.hpp"
#include "console.hpp"
#include "inputs.hpp"
#include "options.hpp"
#include "results.hpp"
#include "stated_value.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/report/csv.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/terminal.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

constexpr const char* kDiagnoseFooter =
    "Several traces are diagnosed together, with shared parameters; a folder stands for the runs of its\n"
    "manifest.csv (columns file, radius, speed, load, repeat), or for every .csv in it. The last repeat of\n"
    "each condition is held back to confirm the finding.\n"
    "Every effect of the catalogue is tested; --effect KEY adds one to the law from the start, --formula\n"
    "adds one of your own to those tested.\n\n"
    "Examples:\n"
    "  identify diagnose --radius 15mm trace.csv\n"
    "  identify diagnose --radius 15mm --formula @mine.txt --json found.json trace.csv\n"
    "  identify diagnose --confirm runs/r4.csv runs/";

void check_usage(const Settings& s, const Split& split) {
  if (split.diagnosed.empty())
    throw UsageError("every trace is held back to confirm the finding; leave one to diagnose");
  if (split.diagnosed.size() > 1 && (!s.second_file.empty() || !s.continued_in.empty())) {
    throw UsageError("--with and --continue need one trace at a time");
  }
  for (std::size_t k = 0; k < split.diagnosed.size(); ++k) {  // the same evidence may not count twice
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      const std::string& path = split.diagnosed[k].trace.path;
      if (same_file(split.diagnosed[earlier].trace.path, path)) throw UsageError(path + " is given twice");
    }
  }
  std::vector<std::string> files = input_files(s);
  for (const auto* inputs : {&split.diagnosed, &split.kept}) {
    for (const Input& input : *inputs) files.push_back(input.trace.path);
  }
  refuse_overwriting(s, files);
}

std::vector<TraceInput> traces_of(const std::vector<Input>& inputs) {
  std::vector<TraceInput> traces;
  for (const Input& input : inputs) traces.push_back(input.trace);
  return traces;
}

/// What is known of the inputs besides the data stands with the trace it is about, or with the first.
void add_remarks(const Split& split, DiagnosedTraces& result) {
  for (const Input& input : split.diagnosed) {
    for (Identification& trace : result.traces) {  // copies of a run are not among them
      if (trace.path != input.trace.path) continue;
      const bool is_first = &trace == &result.traces.front();
      if (is_first) trace.notes.insert(trace.notes.end(), input.notes.begin(), input.notes.end());
      trace.warnings.insert(trace.warnings.begin(), input.warnings.begin(), input.warnings.end());
    }
  }
  if (result.traces.empty()) return;
  std::vector<std::string>& notes = result.traces.front().notes;
  notes.insert(notes.end(), split.notes.begin(), split.notes.end());
  for (const Input& input : split.kept) {
    std::vector<std::string>& warnings = result.traces.front().warnings;
    warnings.insert(warnings.end(), input.warnings.begin(), input.warnings.end());
  }
}

std::string reason_of(const DiagnosedTraces& result) {
  for (const Identification& trace : result.traces) {
    if (!trace.analysed && !trace.warnings.empty()) return trace.path + ": " + trace.warnings.back();
  }
  if (!result.diagnosis.messages.empty()) return result.diagnosis.messages.front();
  return "there are too few cycles to hold any out";
}

/// Records that are not used, and why.
struct LeftOut {
  std::vector<std::string> reasons;
  bool any_read = false;  ///< one could be read, but not analysed
};

/// Whether a record can be diagnosed; adds to `left_out` where it cannot.
bool is_usable(const Input& input, const IdentifyOptions& options, LeftOut& left_out) {
  std::string reason = input.problem;
  try {
    if (reason.empty()) {
      const Identification trace = prepare_trace(input.trace, options);
      if (trace.analysed) return true;
      left_out.any_read = true;
      reason = input.trace.path + ": " + (trace.warnings.empty() ? "it cannot be analysed" : trace.warnings.back());
    }
  } catch (const InputError& error) {
    reason = error.what();
  }
  std::vector<std::string>& reasons = left_out.reasons;  // a run of --confirm may be among the traces, too
  if (std::find(reasons.begin(), reasons.end(), reason) == reasons.end()) reasons.push_back(std::move(reason));
  return false;
}

/// The runs that can be used. A single one is taken as it is: the diagnosis itself says what stops it.
Split usable_runs(const Settings& s, const IdentifyOptions& options, LeftOut& left_out) {
  FindOptions find;
  find.errors = ManifestErrors::collect;
  Campaign campaign = find_runs(s.traces, options.read, find);
  left_out.reasons = std::move(campaign.problems);
  std::vector<Input>& runs = campaign.runs;
  if (runs.size() == 1 && !runs.front().problem.empty()) {
    find_runs(s.traces, options.read);  // refuses it with its place
    throw InputError(runs.front().problem, "");
  }
  check_usage(s, keep_for_confirmation(runs, s.confirm, options.read));
  const auto unusable = [&](const Input& input) { return !is_usable(input, options, left_out); };
  if (runs.size() > 1) std::erase_if(runs, unusable);
  if (runs.empty()) return {};
  Split split = keep_for_confirmation(std::move(runs), s.confirm, options.read);
  if (!s.confirm.empty()) std::erase_if(split.kept, unusable);
  return split;
}

/// The moment at which a time that begins now is over.
std::optional<std::chrono::steady_clock::time_point> end_of(const std::string& time_limit) {
  using Clock = std::chrono::steady_clock;
  if (time_limit.empty()) return std::nullopt;
  constexpr double kLongest = 1e8;  // s, three years
  const double seconds = stated_value(time_limit, Quantity::time, "--time-limit");
  if (!(seconds > 0 && seconds < kLongest))
    throw InputError("--time-limit: '" + time_limit + "' is no time to work in", "give a time such as 10s or 2min");
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

ExitStatus run_diagnose(const Settings& s, const std::vector<std::string>& arguments) {
  const IdentifyOptions options = options_from(s);
  if (s.traces.empty()) throw UsageError("no trace given; try `identify diagnose --radius 15mm trace.csv`");
  LeftOut left_out;
  const Split split = usable_runs(s, options, left_out);
  for (const std::string& reason : left_out.reasons) print_error("left out: " + reason);
  if (split.diagnosed.empty()) {
    print_error("no record is left to diagnose");
    return left_out.any_read ? ExitStatus::failed : ExitStatus::bad_input;
  }
  DiagnoseOptions more;
  more.diagnosis.threads = s.threads;
  more.diagnosis.until = end_of(s.time_limit);
  more.confirm = traces_of(split.kept);
  DiagnosedTraces result;
  {
    ProgressLine line;
    more.diagnosis.progress = [&line](std::string_view what, double part) { line.show(what, part); };
    result = diagnose(traces_of(split.diagnosed), options, more);
  }
  add_remarks(split, result);
  const bool alone = split.diagnosed.size() == 1;
  const std::vector<std::string> own = alone ? arguments_for(split.diagnosed.front(), arguments) : arguments;
  const std::vector<std::string> inputs = alone ? std::vector{split.diagnosed.front().trace.path} : s.traces;
  TerminalOptions terminal = terminal_options(s, own);
  terminal.inputs = inputs;
  deliver(s, {[&] { return render_diagnosis(result, terminal); }, [&] { return to_json(result, {arguments}); },
              [&] {
                return report_of(result, {own, inputs, !s.instruments.empty()});
              },
              [&](const std::string& folder) { write_csv_folder(folder, result); }});
  if (result.analysed && result.diagnosis.verdict != Verdict::not_enough_data)
    return left_out.reasons.empty() ? ExitStatus::done : ExitStatus::failed;
  print_error("the diagnosis could not be done: " + reason_of(result));
  return ExitStatus::failed;
}

}  // namespace

void add_diagnose(const Command& app) {
  const Command verb = app.add_verb("diagnose", "Where a law fails, which effect explains it, what to measure next");
  verb.footer(kDiagnoseFooter);
  const auto settings = std::make_shared<Settings>();
  add_input_options(verb, *settings);
  add_spring_options(verb, *settings);
  verb.add_option("--confirm", settings->confirm,
                  "A run held back from the diagnosis to confirm the finding (repeatable)")
      .one_value_each()
      .group(section::kReading);
  verb.add_option("--time-limit", settings->time_limit,
                  "End the search for effects after this time (10s, 2min) and report what is known");
  add_model_options(verb, *settings);
  add_parameter_options(verb, *settings);
  add_selection_options(verb, *settings);
  add_output_options(verb, *settings);
  add_report_option(verb, *settings);
  verb.on_run([settings, verb] {
    verb.refuse_empty_values();
    check_seed(*settings);
    return run_diagnose(*settings, verb.own_options());
  });
}
