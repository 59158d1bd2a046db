#include "inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "console.hpp"
#include "results.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/pipeline.hpp"
#include "typed_values.hpp"

using namespace tribofit;

namespace {

constexpr const char* kManifest = "manifest";  // the source of what it says (see read_manifest)

/// Whether one of two runs repeats the other. Runs of which too little is stated may differ in what is not.
bool repeats(const ManifestRow& a, const ManifestRow& b) {
  const bool stated = a.conditions.radius.known() && a.conditions.speed.known();
  return (stated || (a.repeat && b.repeat)) && same_conditions(a, b);
}

/// Which inputs are the last repeats of their conditions: of the highest number, then the last in order.
std::vector<bool> last_repeats(const std::vector<Input>& inputs) {
  const auto rank = [&](std::size_t k) { return std::pair(inputs[k].known.repeat.value_or(-1), k); };
  std::vector<bool> kept(inputs.size(), false);
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    bool is_last = true;
    for (std::size_t other = 0; other < inputs.size(); ++other) {
      if (other == k || !repeats(inputs[k].known, inputs[other].known)) continue;
      kept[k] = true;
      is_last = is_last && rank(other) < rank(k);
    }
    kept[k] = kept[k] && is_last;
  }
  return kept;
}

/// The runs named are kept (those not among the inputs are read with `read`). Where none is named, the last repeat of
/// each condition is, as long as another run of that condition is diagnosed; runs repeat each other where all that is
/// stated of them is the same and radius and speed, or a number of the repeat, are stated.
Split keep_for_confirmation(std::vector<Input> inputs, const std::vector<std::string>& named, const ReadOptions& read) {
  std::vector<bool> kept(inputs.size(), false);
  Split split;
  for (const std::string& name : named) {
    bool found = false;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (!same_file(inputs[k].trace.path, name)) continue;
      found = kept[k] = true;
    }
    if (!found) split.kept.push_back(run_of(name, read));
  }
  if (named.empty()) kept = last_repeats(inputs);
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    if (kept[k] && named.empty()) {
      split.notes.push_back(
          fmt::format("{} repeats the conditions of another run: it is not used in the diagnosis but to "
                      "confirm the finding",
                      inputs[k].trace.path));
    }
    (kept[k] ? split.kept : split.diagnosed).push_back(std::move(inputs[k]));
  }
  return split;
}

void check_usage(const Settings& s, const Split& split) {
  if (split.diagnosed.empty())
    throw UsageError("every trace is held back to confirm the finding; leave one to diagnose");
  const ReadOptions& read = s.identify.read;
  if (split.diagnosed.size() > 1 && (!read.second_file.empty() || !read.continued_in.empty())) {
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

/// Reads a record; whether it can be diagnosed. Adds to `left_out` where it cannot.
bool is_usable(Input& input, const IdentifyOptions& options, LeftOut& left_out) {
  std::string reason = input.problem;
  try {
    if (reason.empty()) {
      input.trace.trace = read_input(input.trace, options);
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

}  // namespace

Input only_input(const Settings& s, const ReadOptions& read, const std::string& verb) {
  if (s.traces.empty()) {
    throw UsageError("no trace given; try `identify " + verb + " --radius 15mm --load 50N trace.csv`");
  }
  std::vector<Input> inputs = find_runs(s.traces, read).runs;
  if (inputs.size() != 1) throw UsageError("`identify " + verb + "` takes one trace at a time");
  std::vector<std::string> files = input_files(s);
  files.push_back(inputs.front().trace.path);
  refuse_overwriting(s, files);
  return std::move(inputs.front());
}

void add_remarks(const Input& input, TracePart& trace) {
  trace.notes.insert(trace.notes.end(), input.notes.begin(), input.notes.end());
  trace.warnings.insert(trace.warnings.begin(), input.warnings.begin(), input.warnings.end());
}

std::vector<std::string> arguments_for(const Input& input, std::vector<std::string> arguments) {
  const Conditions& conditions = input.trace.read.conditions;
  const auto add = [&](const char* option, const Condition& condition, double unit, const char* name) {
    if (condition.source != kManifest) return;
    arguments.emplace_back(option);
    arguments.push_back(general(condition.value / unit) + name);
  };
  add("--radius", conditions.radius, 1e-3, "mm");
  add("--speed", conditions.speed, kRpm, "rpm");
  add("--load", conditions.load, 1, "N");
  return arguments;
}

std::vector<TraceInput> traces_of(const std::vector<Input>& inputs) {
  std::vector<TraceInput> traces;
  for (const Input& input : inputs) traces.push_back(input.trace);
  return traces;
}

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

TerminalOptions shown_as(const Split& split, const Settings& s, const std::vector<std::string>& arguments) {
  const bool alone = split.diagnosed.size() == 1;
  TerminalOptions out = terminal_options(s, alone ? arguments_for(split.diagnosed.front(), arguments) : arguments);
  out.inputs = alone ? std::vector{split.diagnosed.front().trace.path} : s.traces;
  return out;
}

Split usable_runs(const Settings& s, const IdentifyOptions& options, const std::string& verb, LeftOut& left_out) {
  if (s.traces.empty()) throw UsageError("no trace given; try `identify " + verb + " --radius 15mm trace.csv`");
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
  const auto leave_unusable_out = [&](std::vector<Input>& inputs) {
    std::vector<Input> usable;
    for (Input& input : inputs) {
      if (input.trace.trace || is_usable(input, options, left_out)) usable.push_back(std::move(input));
    }
    inputs = std::move(usable);
  };
  if (runs.size() > 1) leave_unusable_out(runs);
  Split split;
  if (!runs.empty()) split = keep_for_confirmation(std::move(runs), s.confirm, options.read);
  if (!s.confirm.empty()) leave_unusable_out(split.kept);
  for (const std::string& reason : left_out.reasons) print_error("left out: " + reason);
  if (split.diagnosed.empty()) print_error("no record is left to " + verb + (verb == "plan" ? " from" : ""));
  return split;
}

std::optional<std::chrono::steady_clock::time_point> end_of(const std::string& time_limit) {
  using Clock = std::chrono::steady_clock;
  if (time_limit.empty()) return std::nullopt;
  const std::chrono::duration<double> seconds(positive_value(time_limit, Quantity::time, "--time-limit"));
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(seconds);
}
