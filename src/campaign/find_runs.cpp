#include "find_runs.hpp"
#include "limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "ingest/csv/encoding.hpp"
#include "tribofit/campaign/names.hpp"
#include "tribofit/campaign/run.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/output_tables.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

namespace fs = std::filesystem;

/// Traces of a folder by their names: text, or the binary formats where there is no text.
enum class Named { no, text, binary };

Named named_as(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  // The manifest of a folder of runs holds their conditions, not a run.
  if (path.filename() == manifest_name || path.filename().string().front() == '.') return Named::no;
  if (extension == ".csv" || extension == ".tsv") return Named::text;
  return is_one_of(extension, {".mat", ".uff", ".unv", ".tdms"}) ? Named::binary : Named::no;
}

/// The manifest's condition where the command line says nothing; where both speak and differ, a warning.
void merge(const ConditionInfo& info, const Conditions& in_manifest, Conditions& used, const std::string& place,
           std::vector<std::string>& warnings) {
  const Condition& manifest = in_manifest.*info.member;
  Condition& merged = used.*info.member;
  if (!manifest.known()) return;
  if (!merged.known()) {
    merged = manifest;
    return;
  }
  if (std::abs(merged.value - manifest.value) <= kSameStatement * std::abs(manifest.value)) return;
  warnings.push_back(fmt::format("--{} {} {} is used, not the {} {} of {}", info.name,
                                 general(merged.value / info.si, 4), info.unit, general(manifest.value / info.si, 4),
                                 info.unit, place));
}

/// What is stated of a run in `place`, under what the user says (`read`).
Run stated_run(const ManifestRow& row, const std::string& place, const ReadOptions& read) {
  Run run = run_of(row.path, read);
  Conditions& merged = run.trace.read.conditions;
  for (const ConditionInfo& info : condition_infos) {
    if (info.member != &Conditions::radius || read.step_radii.empty()) {
      merge(info, row.conditions, merged, place, run.warnings);
    } else if (row.conditions.radius.known()) {
      run.warnings.push_back("the radii of the steps given with --radius are used, not the radius of " + place);
    }
  }
  run.known = row;
  run.known.conditions = merged;
  run.problem = row.problem;
  return run;
}

/// `path` without the folder before it.
std::string inside(const std::string& folder, const std::string& path) {
  const std::string prefix = (fs::path(folder) / "").string();
  return path.starts_with(prefix) ? path.substr(prefix.size()) : path;
}

/// A run of which its name says something.
Run named_run(const std::string& path, const NamePattern& pattern, const ReadOptions& read) {
  const std::string file = fs::path(path).filename().string();
  const auto refused = [&](const std::string& problem, const std::string& advice) {
    Run run = run_of(path, read);
    run.problem = InputError(problem, advice, {file, 0, ""}).what();
    return run;
  };
  try {
    const auto fields = pattern.read(file);
    if (fields) return stated_run(row_from(*fields, path, "file name"), "its name", read);
  } catch (const InputError& error) {
    return refused(error.problem(), error.advice());
  }
  return refused("does not fit the pattern '" + pattern.text() + "'", "change the pattern or move the file");
}

void add_manifest(const std::string& folder, const ReadOptions& read, ManifestErrors errors, Campaign& campaign) {
  const Manifest manifest = read_manifest(folder, errors);
  for (const ManifestRow& row : manifest.rows) {
    campaign.runs.push_back(stated_run(row, fmt::format("{}:{}", manifest.path, row.line), read));
    campaign.runs.back().notes = manifest.notes;
    // Results do not depend on the way by which the folder was named.
    campaign.runs.back().problem = replaced(row.problem, manifest.path, manifest_name);
  }
  for (const std::string& problem : manifest.problems) {
    campaign.problems.push_back(replaced(problem, manifest.path, manifest_name));
  }
}

void add_folder(const std::string& folder, const ReadOptions& read, const FindOptions& options, Campaign& campaign) {
  const std::size_t first = campaign.runs.size();
  std::error_code error;
  const bool has_manifest = fs::exists(fs::path(folder) / manifest_name, error);
  if (has_manifest && options.pattern) {
    throw InputError("has a manifest.csv, which says what the runs are",
                     "leave out --pattern, or move the manifest away", {folder, 0, ""});
  }
  if (has_manifest) {
    add_manifest(folder, read, options.errors, campaign);
  } else {
    const FolderTraces traces = traces_in(folder);
    for (const std::string& path : traces.paths) {
      campaign.runs.push_back(options.pattern ? named_run(path, *options.pattern, read) : run_of(path, read));
    }
    if (!traces.left_out.empty()) {
      campaign.notes.push_back("not read from " + folder + ", because --csv wrote them: " + traces.left_out);
      campaign.runs[first].notes.push_back(campaign.notes.back());  // said once
    }
  }
  for (std::size_t k = first; k < campaign.runs.size(); ++k) {
    campaign.runs[k].file = inside(folder, campaign.runs[k].trace.path);
  }
}

/// A name that JSON can hold: bytes that are not UTF-8 and control characters become '_'.
std::string plain(std::string name) {
  const bool is_utf8 = guess_encoding(name + "\n") == Encoding::utf8;  // a letter may not be cut off at the end
  for (char& c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F || (byte > 0x7F && !is_utf8)) c = '_';
  }
  return name;
}

/// What a file name is called by, from short to long: "a" and "sub-a.csv" of sub/a.csv.
std::string short_name(const Run& run) {
  return plain(fs::path(run.file).stem().string());
}

std::string long_name(const Run& run) {
  std::string name = replaced(run.file, "/", "-");
  name.erase(0, name.find_first_not_of(".-"));
  return name.empty() ? "run" : plain(name);
}

/// The short name where it is the only one of its kind, else the long one, with a number where that is taken as well.
void name_runs(std::vector<Run>& runs) {
  std::map<std::string, std::size_t> count = {{"summary", 1}, {"campaign", 1}};  // files of the campaign itself
  for (const Run& run : runs) ++count[short_name(run)];
  std::map<std::string, std::size_t> taken;
  for (Run& run : runs) {
    run.name = count[short_name(run)] == 1 ? short_name(run) : long_name(run);
    ++taken[run.name];
  }
  std::map<std::string, std::size_t> number;
  for (Run& run : runs) {
    if (taken[run.name] == 1 || ++number[run.name] == 1) continue;
    std::string name;
    do {
      name = fmt::format("{}-{}", run.name, number[run.name]);
    } while (taken.contains(name) && ++number[run.name] > 0);
    ++taken[name];
    run.name = name;
  }
}

}  // namespace

FolderTraces traces_in(const std::string& folder) {
  FolderTraces found;
  std::vector<std::string> binary;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string path = it->path().string();
    const Named named = named_as(it->path());
    if (named == Named::no || it->is_directory(error)) continue;
    if (named == Named::binary) {
      binary.push_back(path);
    } else if (!is_output_table(path)) {
      found.paths.push_back(path);
    } else {
      found.left_out += (found.left_out.empty() ? "" : ", ") + it->path().filename().string();
    }
  }
  if (error) {
    throw InputError("the folder cannot be read: " + error.message(), "check the permission to read", {folder, 0, ""});
  }
  if (found.paths.empty()) found.paths = std::move(binary);
  if (found.paths.empty()) {
    const std::string only = ", only tables that --csv wrote (" + found.left_out + ")";
    throw InputError("the folder has no traces" + (found.left_out.empty() ? "" : only),
                     "name a folder with .csv, .tsv, .mat, .uff, .unv or .tdms files, or a trace itself",
                     {folder, 0, ""});
  }
  std::sort(found.paths.begin(), found.paths.end(), in_natural_order);
  return found;
}

Run run_of(const std::string& path, const ReadOptions& read) {
  Run run;
  run.trace = {path, read};
  run.file = path;
  run.known.path = path;
  run.known.conditions = read.conditions;
  return run;
}

Campaign find_runs(const std::vector<std::string>& names, const ReadOptions& read, const FindOptions& options) {
  Campaign campaign;
  for (const std::string& name : names) {
    std::error_code error;
    if (fs::is_directory(name, error)) {
      add_folder(name, read, options, campaign);
      if (names.size() == 1) campaign.folder = name;
    } else {
      campaign.runs.push_back(options.pattern ? named_run(name, *options.pattern, read) : run_of(name, read));
    }
  }
  name_runs(campaign.runs);
  return campaign;
}

}  // namespace tribofit
