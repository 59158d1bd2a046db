#include "inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exit_status.hpp"
#include "results.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/output/digits.hpp"

using namespace tribofit;

namespace {

constexpr const char* kManifest = "manifest";  // the source of what it says (see read_manifest)

/// Whether one of two runs repeats the other. Runs of which too little is stated may differ in what is not.
bool repeats(const ManifestRow& a, const ManifestRow& b) {
  const bool stated = a.conditions.radius.known() && a.conditions.speed.known();
  return (stated || (a.repeat && b.repeat)) && same_conditions(a, b);
}

/// The last of a group: the highest number of the repeat, then the last in order.
std::size_t last_of(const std::vector<Input>& inputs, const std::vector<std::size_t>& group) {
  return *std::max_element(group.begin(), group.end(), [&](std::size_t a, std::size_t b) {
    return inputs[a].known.repeat.value_or(-1) < inputs[b].known.repeat.value_or(-1) ||
           (inputs[a].known.repeat == inputs[b].known.repeat && a < b);
  });
}

/// Which inputs are the last repeats of their conditions.
std::vector<bool> last_repeats(const std::vector<Input>& inputs) {
  std::vector<bool> kept(inputs.size(), false), seen(inputs.size(), false);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (seen[i]) continue;
    std::vector<std::size_t> group;
    for (std::size_t k = i; k < inputs.size(); ++k) {
      if (seen[k] || (k > i && !repeats(inputs[i].known, inputs[k].known))) continue;
      seen[k] = true;
      group.push_back(k);
    }
    if (group.size() > 1) kept[last_of(inputs, group)] = true;
  }
  return kept;
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
