#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "console.hpp"
#include "tribofit/ingest/list_columns.hpp"
#include "tribofit/report/terminal.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

constexpr const char* kColumnsFooter =
    "Any file that identify reads: text, MATLAB, UFF 58 and 58b, TDMS. What it is taken for is what --columns says.\n\n"
    "Examples:\n"
    "  identify columns trace.csv\n"
    "  identify columns export.mat";

constexpr std::size_t kColumns = 6;
using Row = std::array<std::string, kColumns>;

Row row_of(const ListedColumn& column) {
  const std::string name = column.place.empty() ? column.name : column.name + " of " + column.place;
  const bool has_numbers = !column.is_text && column.count > 0;
  return {column.request.front() == '#' && column.request != column.name ? column.request + " " + name : name,
          column.unit,
          column.is_text && column.count == 0 ? "text" : fmt::format("{}", column.count),
          has_numbers ? fmt::format("{:.6g}", column.lowest) : "",
          has_numbers ? fmt::format("{:.6g}", column.highest) : "",
          column.channel};
}

/// Letters, not bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string table_of(const std::vector<Row>& rows) {
  std::array<std::size_t, kColumns> widths{};
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < kColumns; ++k) widths[k] = std::max(widths[k], width_of(row[k]));
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line = " ";
    for (std::size_t k = 0; k < kColumns; ++k) {
      const std::string space(widths[k] - width_of(row[k]), ' ');
      const bool is_number = k >= 2 && k <= 4;
      line += " " + (is_number ? space + row[k] : row[k] + space) + " ";
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string render(const ColumnListing& listing, const std::string& path) {
  std::string text = fmt::format("{}: {}, {} column{}\n", path, listing.format, listing.columns.size(),
                                 listing.columns.size() == 1 ? "" : "s");
  std::vector<Row> rows = {{"name", "unit", "values", "lowest", "highest", "taken for"}};
  for (const ListedColumn& column : listing.columns) rows.push_back(row_of(column));
  text += table_of(rows);
  std::vector<double> intervals = listing.intervals;
  intervals.erase(std::unique(intervals.begin(), intervals.end()), intervals.end());
  for (const double interval : intervals) text += fmt::format("  time: every {:g} s, as the file states\n", interval);
  constexpr std::size_t kMostFacts = 20;
  for (std::size_t i = 0; i < listing.facts.size() && i < kMostFacts; ++i) {
    text += fmt::format("  {}: {}\n", listing.facts[i].first, listing.facts[i].second.substr(0, 60));
  }
  if (listing.facts.size() > kMostFacts) text += fmt::format("  and {} more\n", listing.facts.size() - kMostFacts);
  for (const std::string& note : listing.notes) text += "  " + note + "\n";
  return text + fmt::format("\nNext, with names in the place of NAME:\n  identify --columns {} {}\n",
                            shell_quoted(listing.selection), shell_quoted(path));
}

}  // namespace

void add_columns(const Command& app) {
  const auto file = std::make_shared<std::string>();
  const Command verb = app.add_verb("columns", "List what a file holds, with the --columns line for it");
  verb.footer(kColumnsFooter);
  verb.add_option("FILE", *file, "File of a trace").required();
  verb.on_run([file, verb] {
    verb.refuse_empty_values();
    print(render(list_columns(*file), *file));
    return ExitStatus::done;
  });
}
