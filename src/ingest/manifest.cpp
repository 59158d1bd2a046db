#include "tribofit/ingest/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "column_names.hpp"
#include "csv/text_table.hpp"
#include "limits.hpp"
#include "manifest_roles.hpp"
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
bool fits(std::string_view pattern, std::string_view name) {
  std::size_t p = 0, n = 0, star = std::string_view::npos, behind = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      behind = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++behind;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
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
    for (std::size_t row = 0; row < text_.rows(); ++row) take_row(row);
    if (manifest_.rows.empty() && manifest_.problems.empty())
      refuse("lists no runs", "add a row for each run, or remove the manifest", 0);
    note_others();
    return std::move(manifest_);
  }

 private:
  struct ManifestColumn {
    std::string name;  // as the file gives it
    Role role;
    std::string unit;  // empty: in the cells
  };

  [[noreturn]] void refuse(std::string problem, std::string advice, std::size_t line, std::string column = {}) const {
    throw InputError(std::move(problem), std::move(advice), {manifest_.path, line, std::move(column)});
  }

  void read_header() {
    for (const RawColumn& column : text_.table.columns) {
      if (column.named) add_column(column.name, column.line);
    }
    if (count(Role::file) == 1) return;
    std::vector<std::string> names;
    for (const ManifestColumn& column : columns_) {
      if (likely_name("file", std::vector{lower_case(column.name)}).empty()) continue;
      names.push_back(column.name);
    }
    refuse("there is no column 'file'" + (names.empty() ? "" : " (is it '" + names.front() + "'?)"),
           fmt::format("name the column of the traces' names 'file'; {}", kColumns), text_.header_line());
  }

  std::size_t count(Role role) const {
    return static_cast<std::size_t>(
        std::count_if(columns_.begin(), columns_.end(), [&](const ManifestColumn& c) { return c.role == role; }));
  }

  void add_column(const std::string& text, std::size_t line) {
    const ColumnName name = parse_column_name(text);
    ManifestColumn column{text, role_of(name), ""};
    const bool measured = column.role == Role::radius || column.role == Role::speed || column.role == Role::load;
    if (measured) column.unit = name.unit.value_or(names_rpm(name.base) ? "rpm" : "");
    if (measured && !column.unit.empty()) check_unit(column, line);
    if (column.role != Role::other && count(column.role) > 0) {
      refuse(fmt::format("a second column of the same kind as '{}'", named(column.role)), "keep one of them", line,
             text);
    }
    columns_.push_back(std::move(column));
  }

  const std::string& named(Role role) const {
    return std::find_if(columns_.begin(), columns_.end(), [&](const ManifestColumn& c) { return c.role == role; })
        ->name;
  }

  void check_unit(const ManifestColumn& column, std::size_t line) const {
    const Quantity quantity = quantity_of(column.role);
    const std::string example =
        fmt::format("give {} such as {}", with_article(to_string(quantity)), example_of(quantity));
    const auto unit = find_unit(column.unit);
    if (!unit) {
      const std::string nearest = suggest_unit(column.unit);
      refuse(fmt::format("unknown unit '{}'", column.unit),
             nearest.empty() ? example : fmt::format("did you mean {}? {}", nearest, example), line, column.name);
    }
    if (!find_unit(column.unit, quantity)) {
      refuse(fmt::format("'{}' is a unit of {}, not of {}", column.unit, with_article(to_string(unit->quantity)),
                         with_article(to_string(quantity))),
             example, line, column.name);
    }
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
      row.line = text_.line_of(at);
      row.problem = error.what();
      manifest_.rows.push_back(std::move(row));
    }
  }

  void read_row(std::size_t at) {
    const std::vector<std::string> cells = text_.cells_of(at);
    ManifestRow row;
    row.line = text_.line_of(at);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (columns_[k].role == Role::file) file_ = cells[k];
    }
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const ManifestColumn& column = columns_[k];
      if (cells[k].empty()) continue;
      if (column.role == Role::radius) row.conditions.radius = condition(cells[k], column, row.line);
      if (column.role == Role::speed) row.conditions.speed = condition(cells[k], column, row.line);
      if (column.role == Role::load) row.conditions.load = condition(cells[k], column, row.line);
      if (column.role == Role::repeat) row.repeat = repeat(cells[k], column, row.line);
      if (column.role == Role::other) row.others.push_back({column.name, cells[k]});
    }
    if (file_.empty()) {
      refuse("the row names no file", "fill in the file or remove the row", row.line, named(Role::file));
    }
    add_runs(file_, row);
  }

  Condition condition(const std::string& cell, const ManifestColumn& column, std::size_t line) {
    const std::string text = text_.with_decimal_point(cell);
    if (column.role == Role::load && column.unit.empty() && is_bare_number(text)) bare_loads_ = true;
    try {
      return {condition_in_cell(text, column.role, column.name, column.unit), "manifest"};
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
             named(Role::file));
    }
    if (fs::exists(path, ignored)) return add_run(path.string(), row);
    const std::vector<std::string> names = files_of(path.parent_path());
    const std::string last = path.filename().string();
    if (last.find_first_of("*?") == std::string::npos) {
      refuse(fmt::format("'{}' does not exist{}", file, did_you_mean(last, names)),
             "names are relative to the folder of the manifest", row.line, named(Role::file));
    }
    std::size_t found = 0;
    for (const std::string& name : names) {
      if (!fits(last, name)) continue;
      if (++found > 1 && row.repeat) {
        refuse(fmt::format("'{}' fits several files, which cannot all be repeat {}", file, *row.repeat),
               "leave the repeat empty or list the files one by one", row.line, named(Role::repeat));
      }
      add_run((path.parent_path() / name).string(), row);
    }
    if (found == 0) {
      refuse(fmt::format("no file fits '{}'", file), "names are relative to the folder of the manifest", row.line,
             named(Role::file));
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
    const std::string& column = named(Role::file);
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
      if (column.role == Role::other && !column.name.empty()) others.push_back(column.name);
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

Manifest read_manifest(const std::string& folder, ManifestErrors errors) {
  return ManifestReader(folder, errors).read();
}

bool same_conditions(const ManifestRow& a, const ManifestRow& b) {
  const auto same_text = [](const OtherCondition& x, const OtherCondition& y) {
    return x.name == y.name && x.value == y.value;
  };
  return same(a.conditions.radius, b.conditions.radius) && same(a.conditions.speed, b.conditions.speed) &&
         same(a.conditions.load, b.conditions.load) &&
         std::equal(a.others.begin(), a.others.end(), b.others.begin(), b.others.end(), same_text);
}

}  // namespace tribofit
