#include "inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <system_error>
#include <utility>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/own_files.hpp"

using namespace tribofit;

namespace {

namespace fs = std::filesystem;

constexpr const char* kManifest = "manifest";  // the source of what it says (see read_manifest)
constexpr double kRpm = 2 * std::numbers::pi / 60;

bool is_trace_name(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  // The manifest of a folder of runs holds their conditions, not a run.
  return (extension == ".csv" || extension == ".tsv") && path.filename() != manifest_name &&
         path.filename().string().front() != '.';
}

/// Traces of a folder; `left_out`: tables that --csv wrote there.
std::vector<std::string> traces_in(const std::string& folder, std::string& left_out) {
  std::vector<std::string> found;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string path = it->path().string();
    if (!is_trace_name(it->path()) || it->is_directory(error)) continue;
    if (!is_own_file(path)) {
      found.push_back(path);
    } else {
      left_out += (left_out.empty() ? "" : ", ") + it->path().filename().string();
    }
  }
  if (error) {
    throw InputError("the folder cannot be read: " + error.message(), "check the permission to read", {folder, 0, ""});
  }
  if (found.empty()) {
    throw InputError(
        "the folder has no traces" + (left_out.empty() ? "" : ", only tables that --csv wrote (" + left_out + ")"),
        "name a folder with .csv files, or a trace itself", {folder, 0, ""});
  }
  std::sort(found.begin(), found.end());
  return found;
}

Input plain_input(const std::string& path, const ReadOptions& read) {
  Input input;
  input.trace = {path, read};
  input.known.path = path;
  input.known.conditions = read.conditions;
  return input;
}

/// The manifest's condition where the command line says nothing; where both speak and differ, a warning.
void merge(const Condition& manifest, Condition& merged, const char* option, double unit, const char* unit_name,
           const std::string& place, std::vector<std::string>& warnings) {
  if (!manifest.known()) return;
  if (!merged.known()) {
    merged = manifest;
    return;
  }
  constexpr double kSame = 1e-6;
  if (std::abs(merged.value - manifest.value) <= kSame * std::abs(manifest.value)) return;
  warnings.push_back(fmt::format("{} {:.4g} {} is used, not the {:.4g} {} of {}", option, merged.value / unit,
                                 unit_name, manifest.value / unit, unit_name, place));
}

Input manifest_input(const Manifest& manifest, const ManifestRow& row, const ReadOptions& read) {
  Input input = plain_input(row.path, read);
  Conditions& merged = input.trace.read.conditions;
  const std::string place = fmt::format("{}:{}", manifest.path, row.line);
  if (read.step_radii.empty()) {
    merge(row.conditions.radius, merged.radius, "--radius", 1e-3, "mm", place, input.warnings);
  } else if (row.conditions.radius.known()) {
    input.warnings.push_back("the radii of the steps given with --radius are used, not the radius of " + place);
  }
  merge(row.conditions.speed, merged.speed, "--speed", kRpm, "rpm", place, input.warnings);
  merge(row.conditions.load, merged.load, "--load", 1, "N", place, input.warnings);
  input.known = row;
  input.known.conditions = merged;
  input.notes = manifest.notes;
  return input;
}

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

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return a == b || fs::equivalent(a, b, ignored);
}

std::vector<Input> inputs_from(const std::vector<std::string>& names, const ReadOptions& read) {
  std::vector<Input> inputs;
  for (const std::string& name : names) {
    std::error_code error;
    if (!fs::is_directory(name, error)) {
      inputs.push_back(plain_input(name, read));
    } else if (fs::exists(fs::path(name) / manifest_name, error)) {
      const Manifest manifest = read_manifest(name);
      for (const ManifestRow& row : manifest.rows) inputs.push_back(manifest_input(manifest, row, read));
    } else {
      std::string left_out;
      for (const std::string& path : traces_in(name, left_out)) {
        inputs.push_back(plain_input(path, read));
        if (left_out.empty()) continue;
        inputs.back().notes.push_back("left out of " + name + ", because --csv wrote them: " + left_out);
        left_out.clear();  // said once
      }
    }
  }
  return inputs;
}

std::vector<std::string> arguments_for(const Input& input, std::vector<std::string> arguments) {
  const Conditions& conditions = input.trace.read.conditions;
  const auto add = [&](const char* option, const Condition& condition, double unit, const char* name) {
    if (condition.source != kManifest) return;
    arguments.emplace_back(option);
    arguments.push_back(fmt::format("{:.6g}{}", condition.value / unit, name));
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
    if (!found) split.kept.push_back(plain_input(name, read));
  }
  if (named.empty()) kept = last_repeats(inputs);
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    if (kept[k] && named.empty()) {
      split.notes.push_back(
          fmt::format("{} repeats the conditions of another run: it takes no part and the finding is "
                      "tried on it",
                      inputs[k].trace.path));
    }
    (kept[k] ? split.kept : split.diagnosed).push_back(std::move(inputs[k]));
  }
  return split;
}
