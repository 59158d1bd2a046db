#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "conditions.hpp"
#include "ingest/csv/encoding.hpp"
#include "limits.hpp"
#include "output/csv_table.hpp"
#include "output/json.hpp"
#include "tribofit/campaign/run.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/output_tables.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/output/text.hpp"

namespace tribofit {
namespace {

namespace fs = std::filesystem;

struct FolderTraces {
  std::vector<std::string> paths;  ///< in order of name
  std::string left_out;            ///< tables that --csv wrote there, as a list
};

/// The text files of a folder, or the binary ones where there is no text, without its manifest, which holds the
/// conditions of runs and is none. Throws InputError where there are none.
FolderTraces traces_in(const std::string& folder) {
  FolderTraces found;
  std::vector<std::string> binary;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string path = it->path().string(), name = it->path().filename().string();
    const std::string extension = lower_case(it->path().extension().string());
    if (name == manifest_name || name.front() == '.' || it->is_directory(error)) continue;
    if (is_one_of(extension, {".mat", ".uff", ".unv", ".tdms"})) binary.push_back(path);
    if (!is_one_of(extension, {".csv", ".tsv"})) continue;
    if (!is_output_table(path)) {
      found.paths.push_back(path);
    } else {
      found.left_out += (found.left_out.empty() ? "" : ", ") + name;
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
  std::ranges::sort(found.paths, in_natural_order);
  return found;
}

/// What is stated of a run in `place`, where the user says nothing (`read`); where both speak and differ, a warning.
Run stated_run(const ManifestRow& row, const std::string& place, const ReadOptions& read) {
  Run run = run_of(row.path, read);
  Conditions& merged = run.trace.read.conditions;
  for (const ConditionInfo& info : condition_infos) {
    const Condition& stated = row.conditions.*info.member;
    Condition& used = merged.*info.member;
    if (!stated.known()) continue;
    if (info.member == &Conditions::radius && !read.step_radii.empty()) {
      run.warnings.push_back("the radii of the steps given with --radius are used, not the radius of " + place);
    } else if (!used.known()) {
      used = stated;
    } else if (std::abs(used.value - stated.value) > kSameStatement * std::abs(stated.value)) {
      run.warnings.push_back(fmt::format("--{} {} {} is used, not the {} {} of {}", info.name,
                                         general(used.value / info.si, 4), info.unit,
                                         general(stated.value / info.si, 4), info.unit, place));
    }
  }
  run.known = row;
  run.known.conditions = merged;
  run.problem = row.problem;
  return run;
}

/// The run of a file, of which its name may say something.
Run run_at(const std::string& path, const std::optional<NamePattern>& pattern, const ReadOptions& read) {
  Run run = run_of(path, read);
  if (!pattern) return run;
  const std::string file = fs::path(path).filename().string();
  try {
    const auto fields = pattern->read(file);
    if (fields) return stated_run(row_from(*fields, path, "file name"), "its name", read);
    throw InputError("does not fit the pattern '" + pattern->text() + "'", "change the pattern or move the file");
  } catch (const InputError& error) {
    run.problem = InputError(error.problem(), error.advice(), {file, 0, ""}).what();
    return run;
  }
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
    for (const std::string& path : traces.paths) campaign.runs.push_back(run_at(path, options.pattern, read));
    if (!traces.left_out.empty()) {
      campaign.notes.push_back("not read from " + folder + ", because --csv wrote them: " + traces.left_out);
      campaign.runs[first].notes.push_back(campaign.notes.back());  // said once
    }
  }
  const std::string prefix = (fs::path(folder) / "").string();
  for (std::size_t k = first; k < campaign.runs.size(); ++k) {
    Run& run = campaign.runs[k];
    if (run.file.starts_with(prefix)) run.file.erase(0, prefix.size());
  }
}

/// A name that JSON and a line can hold and that shows what it is: other bytes become another one.
std::string plain(std::string name, char instead = '_') {
  const bool is_utf8 = guess_encoding(name + "\n") == Encoding::utf8;  // a letter may not be cut off at the end
  for (std::size_t k = 0; k < name.size(); ++k) {
    const bool is_broken = !is_utf8 && static_cast<unsigned char>(name[k]) > 0x7F;
    const std::size_t bytes = is_broken ? 1 : unseen_bytes(std::string_view(name).substr(k));
    std::fill_n(name.begin() + static_cast<std::ptrdiff_t>(k), bytes, instead);
  }
  return name;
}

/// So long that the files of a run, which are called like it, have names.
std::string shortened(std::string name) {
  std::size_t end = std::min<std::size_t>(name.size(), 200);
  while (end < name.size() && end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) --end;
  name.resize(end);
  return name;
}

/// What a cell of a manifest calls a file: what it cannot hold is a '?', which fits that file.
std::string in_manifest(const std::string& file) {
  std::string name = plain(file, '?');
  for (char* end : {&name.front(), &name.back()}) *end = *end == ' ' ? '?' : *end;
  for (char& c : name) c = name != file && (c == '[' || c == '\\') ? '?' : c;  // of the language of patterns
  return name;
}

/// What a file name is called by, from short to long: "a" and "sub-a.csv" of sub/a.csv.
std::string short_name(const Run& run) {
  return shortened(plain(fs::path(run.file).stem().string()));
}

std::string long_name(const Run& run) {
  std::string name = replaced(run.file, "/", "-");
  name.erase(0, name.find_first_not_of(".-"));
  return name.empty() ? "run" : shortened(plain(name));
}

/// The short name where it is the only one of its kind, else the long one, with a number where that is taken as well.
void name_runs(std::vector<Run>& runs) {
  std::map<std::string, std::size_t> count;
  for (const char* own : campaign_files) ++count[fs::path(own).stem().string()];
  for (const Run& run : runs) ++count[short_name(run)];
  std::set<std::string> taken, seen;
  for (Run& run : runs) {
    run.name = count[short_name(run)] == 1 ? short_name(run) : long_name(run);
    taken.insert(run.name);
  }
  for (Run& run : runs) {
    std::string name = run.name;
    if (seen.insert(name).second) continue;
    for (int number = 2; !taken.insert(name).second; ++number) name = fmt::format("{}-{}", run.name, number);
    run.name = name;
  }
}

}  // namespace

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
      campaign.runs.push_back(run_at(name, options.pattern, read));
    }
  }
  name_runs(campaign.runs);
  return campaign;
}

namespace {

/// What the header says where the name says nothing; where both speak and differ, a remark.
void take_header(const StatedFields& header, const std::string& file, StatedFields& fields,
                 std::vector<std::string>& remarks) {
  for (std::size_t k = 0; k < condition_infos.size(); ++k) {
    const auto field = stated_conditions[k];
    const ConditionInfo& condition = condition_infos[k];
    const std::string& said = header.*field;
    std::string& named = fields.*field;
    if (named.empty()) named = said;
    if (said.empty() || named == said) continue;
    const auto value_of_text = [&](const std::string& text) {
      StatedFields one;
      one.*field = text;
      return (row_from(one, file, "").conditions.*condition.member).value;
    };
    try {
      const double a = value_of_text(named), b = value_of_text(said);
      if (std::abs(a - b) > kSameStatement * std::abs(b)) {
        remarks.push_back(fmt::format("{}: the {} of its header is {}, that of its name {}; check which is right", file,
                                      condition.name, said, named));
      }
    } catch (const InputError&) {  // the reader of the manifest will say what is wrong with it
    }
  }
}

}  // namespace

ManifestDraft draft_manifest(const std::string& folder, const std::optional<NamePattern>& pattern) {
  ManifestDraft draft;
  std::vector<std::pair<std::string, StatedFields>> rows;
  std::vector<std::string> others, remarks;
  for (const std::string& path : traces_in(folder).paths) {
    const std::string file = fs::path(path).filename().string();
    const std::optional<StatedFields> named = pattern ? pattern->read(file) : usual_fields(file);
    if (!named) remarks.push_back(fmt::format("{} does not fit the pattern {}", file, pattern->text()));
    StatedFields& fields = rows.emplace_back(file, named.value_or(StatedFields())).second;
    take_header(header_fields(path), file, fields, remarks);
    add_names(fields.others, others);
    if (!fields.radius.empty()) ++draft.complete;
  }
  draft.runs = rows.size();
  if (draft.complete < draft.runs) {
    remarks.push_back(
        fmt::format("{} of {} runs: no radius found; fill it in, as in 15mm", draft.runs - draft.complete, draft.runs));
  }
  for (const std::string& remark : remarks) draft.text += "# " + printable(remark) + "\n";
  draft.text += csv_line("file", "radius", "speed", "load", "repeat", Json(others));
  for (const auto& [file, fields] : rows) {
    Json values = Json::array();
    for (const std::string& name : others) values.push_back(value_of(fields.others, name));
    draft.text += csv_line(in_manifest(file), fields.radius, fields.speed, fields.load, fields.repeat, values);
  }
  return draft;
}

}  // namespace tribofit
