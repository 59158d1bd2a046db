#include "tribofit/ingest/manifest.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "csv/text_table.hpp"
#include "input_file.hpp"
#include "limits.hpp"
#include "output/csv_table.hpp"
#include "raw_table.hpp"
#include "stated_conditions.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/output_tables.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kColumns = "the columns are file, radius, speed, load, repeat and others of your own";

/// Whether `name` fits a pattern of literal bytes, * (any run of them) and ? (any one).
bool fits(const std::string& pattern, const std::string& name) {
  return ::fnmatch(replaced(pattern, "[", "[[]").c_str(), name.c_str(), FNM_NOESCAPE) == 0;
}

/// Names of the files of a folder, sorted; hidden ones, the manifest and what --csv wrote left out.
std::vector<std::string> files_of(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.front() == '.' || name == manifest_name || it->is_directory(error)) continue;
    if (!is_output_table(it->path().string())) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

class ManifestReader {
 public:
  ManifestReader(const std::string& folder, ManifestErrors errors) : folder_(folder), errors_(errors) {
    manifest_.path = (folder_ / manifest_name).string();
  }

  Manifest read() {
    const std::string advice = fmt::format("begin it with file,radius,speed,load; {}", kColumns);
    text_ = read_text_table(manifest_.path,
                            {kLargestManifest, "is too large for a manifest", "one row a run is meant", advice});
    read_header();
    for (std::size_t row = 0; row < text_.rows.size(); ++row) take_row(row);
    if (manifest_.rows.empty() && manifest_.problems.empty())
      refuse("lists no runs", "add a row for each run, or remove the manifest", 0);
    note_others();
    return std::move(manifest_);
  }

 private:
  struct ManifestColumn {
    std::string name;                // as the file gives it
    std::string role;                // "file", "repeat", the name of a condition; empty: another
    const ConditionInfo* condition;  // nullptr: it is none
    std::string unit;                // empty: in the cells
  };

  [[noreturn]] void refuse(std::string problem, std::string advice, std::size_t line, std::string column = {}) const {
    throw InputError(std::move(problem), std::move(advice), {manifest_.path, line, std::move(column)});
  }

  void read_header() {
    for (const std::string& name : text_.names) add_column(name);
    if (find("file") != nullptr) return;
    std::vector<std::string> names;
    for (const ManifestColumn& column : columns_) {
      if (likely_name("file", std::vector{lower_case(column.name)}).empty()) continue;
      names.push_back(column.name);
    }
    refuse("there is no column 'file'" + (names.empty() ? "" : " (is it '" + names.front() + "'?)"),
           fmt::format("name the column of the traces' names 'file'; {}", kColumns), text_.header_line);
  }

  const ManifestColumn* find(std::string_view role) const {
    const auto at = std::ranges::find(columns_, role, &ManifestColumn::role);
    return at != columns_.end() ? &*at : nullptr;
  }

  void add_column(const std::string& text) {
    const ColumnName name = parse_column_name(text);
    ManifestColumn column{text, "", find_condition(name.base), ""};
    if (column.condition != nullptr) {
      column.role = column.condition->name;
      column.unit = name.unit.value_or(names_rpm(name.base) ? "rpm" : "");
      if (!column.unit.empty()) check_unit(column);
    } else if (is_among(name.base, "file filename trace path datei")) {
      column.role = "file";
    } else if (is_among(name.base, "repeat repetition replicate rep wiederholung")) {
      column.role = "repeat";
    }
    if (!column.role.empty() && find(column.role) != nullptr) {
      refuse(fmt::format("a second column of the same kind as '{}'", find(column.role)->name), "keep one of them",
             text_.header_line, text);
    }
    columns_.push_back(std::move(column));
  }

  const std::string& file_column() const { return find("file")->name; }

  void check_unit(const ManifestColumn& column) const {
    const Quantity quantity = column.condition->quantity;
    const std::string example =
        fmt::format("give {} such as {}", with_article(to_string(quantity)), example_of(quantity));
    const auto unit = find_unit(column.unit);
    if (unit && find_unit(column.unit, quantity)) return;
    const std::string nearest = unit ? "" : suggest_unit(column.unit);
    refuse(unit ? fmt::format("'{}' is a unit of {}, not of {}", column.unit, with_article(to_string(unit->quantity)),
                              with_article(to_string(quantity)))
                : fmt::format("unknown unit '{}'", column.unit),
           nearest.empty() ? example : fmt::format("did you mean {}? {}", nearest, example), text_.header_line,
           column.name);
  }

  void take_row(std::size_t at) {
    file_.clear();
    if (errors_ == ManifestErrors::refuse) return read_row(at);
    try {
      read_row(at);
    } catch (const InputError& error) {
      const std::string path = (folder_ / file_).string();
      const bool is_one_run = !file_.empty() && file_.find_first_of("*?") == std::string::npos;
      if (!is_one_run || !row_of_.emplace(identity_of(path), manifest_.rows.size()).second) {
        manifest_.problems.push_back(error.what());
        return;
      }
      ManifestRow row;
      row.path = path;
      row.line = text_.rows[at].line;
      row.problem = error.what();
      manifest_.rows.push_back(std::move(row));
    }
  }

  void read_row(std::size_t at) {
    std::vector<std::string> cells = text_.cells_of(at);
    for (std::string& cell : cells) cell.erase(0, cell.starts_with('\'') && is_formula(cell.substr(1)) ? 1 : 0);
    ManifestRow row;
    row.line = text_.rows[at].line;
    file_ = cells[static_cast<std::size_t>(find("file") - columns_.data())];
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const ManifestColumn& column = columns_[k];
      if (cells[k].empty()) continue;
      if (column.condition != nullptr) {
        row.conditions.*column.condition->member = condition(cells[k], column, row.line);
      } else if (column.role == "repeat") {
        row.repeat = repeat(cells[k], column, row.line);
      } else if (column.role.empty()) {
        row.others.push_back({column.name, cells[k]});
      }
    }
    if (file_.empty()) refuse("the row names no file", "fill in the file or remove the row", row.line, file_column());
    add_runs(file_, row);
  }

  Condition condition(const std::string& cell, const ManifestColumn& column, std::size_t line) {
    const std::string text = text_.with_decimal_point(cell);
    const bool is_load = column.condition->quantity == Quantity::force;
    bare_loads_ = bare_loads_ || (is_load && column.unit.empty() && is_bare_number(text));
    try {
      return {condition_in_cell(text, *column.condition, column.name, column.unit), "manifest"};
    } catch (const InputError& error) {
      refuse(error.problem(), error.advice(), line, column.name);
    }
  }

  int repeat(const std::string& text, const ManifestColumn& column, std::size_t line) const {
    int value = 0;
    const char* end = text.data() + text.size();
    const auto [last, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || last != end || value < 0) {
      refuse(fmt::format("'{}' is not a whole number", text), "number the repeats of a condition 1, 2, 3", line,
             column.name);
    }
    return value;
  }

  void add_runs(const std::string& file, const ManifestRow& row) {
    const fs::path path = folder_ / file;  // an absolute name stays as it is
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
      refuse(fmt::format("'{}' is a folder", file), "name a file, or several as in runs/*.csv", row.line,
             file_column());
    }
    if (fs::exists(path, ignored)) return add_run(path.string(), row);
    const std::vector<std::string> names = files_of(path.parent_path());
    const std::string last = path.filename().string();
    if (last.find_first_of("*?") == std::string::npos) {
      refuse(fmt::format("'{}' does not exist{}", file, did_you_mean(last, names)),
             "names are relative to the folder of the manifest", row.line, file_column());
    }
    std::size_t found = 0;
    for (const std::string& name : names) {
      if (!fits(last, name)) continue;
      if (++found > 1 && row.repeat) {
        refuse(fmt::format("'{}' fits several files, which cannot all be repeat {}", file, *row.repeat),
               "leave the repeat empty or list the files one by one", row.line, find("repeat")->name);
      }
      add_run((path.parent_path() / name).string(), row);
    }
    if (found == 0) {
      refuse(fmt::format("no file fits '{}'", file), "names are relative to the folder of the manifest", row.line,
             file_column());
    }
  }

  void add_run(std::string path, ManifestRow row) {
    const auto [known, is_new] = row_of_.emplace(identity_of(path), manifest_.rows.size());
    if (is_new) {
      row.path = std::move(path);
      manifest_.rows.push_back(std::move(row));
      return;
    }
    ManifestRow& earlier = manifest_.rows[known->second];
    const std::string name = fs::path(path).filename().string();
    const std::string& column = file_column();
    if (same_conditions(earlier, row) && earlier.repeat == row.repeat) {
      name_problem({fmt::format("'{}' is listed twice, in line {} and here", name, earlier.line),
                    "remove one of the rows",
                    {manifest_.path, row.line, column}});
      return;
    }
    const InputError error(fmt::format("'{}' has other conditions here than in line {}", name, earlier.line),
                           "keep the row that is right", {manifest_.path, row.line, column});
    if (errors_ == ManifestErrors::refuse) throw error;
    if (earlier.problem.empty()) earlier.problem = error.what();  // neither row is known to be right
  }

  /// Refuses the manifest, or goes on with the other rows.
  void name_problem(const InputError& error) {
    if (errors_ == ManifestErrors::refuse) throw error;
    manifest_.problems.push_back(error.what());
  }

  static std::string identity_of(const fs::path& path) {
    std::error_code ignored;
    return fs::weakly_canonical(path, ignored).string();
  }

  void note_others() {
    std::vector<std::string> others;
    for (const ManifestColumn& column : columns_) {
      if (column.role.empty() && !column.name.empty()) others.push_back(column.name);
    }
    if (!others.empty()) {
      manifest_.notes.push_back(fmt::format("{}: further conditions: {}", manifest_.path, listed(others)));
    }
    if (bare_loads_) manifest_.notes.push_back(fmt::format("{}: loads without a unit are in N", manifest_.path));
  }

  fs::path folder_;
  ManifestErrors errors_;
  Manifest manifest_;
  std::string file_;  // named by the row being read, as written
  TextTable text_;
  std::vector<ManifestColumn> columns_;
  std::map<std::string, std::size_t> row_of_;  // by the identity of its file
  bool bare_loads_ = false;
};

bool same(const Condition& a, const Condition& b) {
  if (!a.known() || !b.known()) return a.known() == b.known();
  return std::abs(a.value - b.value) <= kConditionRounding * std::abs(a.value);
}

}  // namespace

bool is_output_table(const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  const auto known = std::ranges::find(output_tables, name, &OutputTable::name);
  if (known == output_tables.end()) return false;
  try {
    return InputFile(path).read_text(0, known->header.size()) == known->header;
  } catch (const InputError&) {
    return false;
  }
}

Manifest read_manifest(const std::string& folder, ManifestErrors errors) {
  return ManifestReader(folder, errors).read();
}

bool same_conditions(const ManifestRow& a, const ManifestRow& b) {
  const auto same_text = [](const OtherCondition& x, const OtherCondition& y) {
    return x.name == y.name && x.value == y.value;
  };
  const bool same_known = std::ranges::all_of(condition_infos, [&](const ConditionInfo& info) {
    return same(a.conditions.*info.member, b.conditions.*info.member);
  });
  return same_known && std::equal(a.others.begin(), a.others.end(), b.others.begin(), b.others.end(), same_text);
}

}  // namespace tribofit
