#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "tribofit/ingest/list_columns.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

constexpr std::size_t kColumns = 6;
using Row = std::array<std::string, kColumns>;

Row row_of(const ListedColumn& column) {
  const std::string name = column.place.empty() ? column.name : column.name + " of " + column.place;
  const bool has_numbers = !column.is_text && column.count > 0;
  return {column.request.front() == '#' && column.request != column.name ? column.request + " " + name : name,
          column.unit,
          column.is_text && column.count == 0 ? "text" : fmt::format("{}", column.count),
          has_numbers ? general(column.lowest) : "",
          has_numbers ? general(column.highest) : "",
          column.channel + (column.is_likely ? "?" : "")};
}

std::string table_of(const std::vector<Row>& rows) {
  std::array<std::size_t, kColumns> widths{};
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < kColumns; ++k) widths[k] = std::max(widths[k], letters_in(row[k]));
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line = " ";
    for (std::size_t k = 0; k < kColumns; ++k) {
      const std::string space(widths[k] - letters_in(row[k]), ' ');
      const bool is_number = k >= 2 && k <= 4;
      line += " " + (is_number ? space + row[k] : row[k] + space) + " ";
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string table_and_facts(const ColumnListing& listing, const std::string& path) {
  std::string text = fmt::format("{}: {}, {} column{}\n", printable(path), listing.format, listing.columns.size(),
                                 listing.columns.size() == 1 ? "" : "s");
  std::vector<Row> rows = {{"name", "unit", "values", "lowest", "highest", "taken for"}};
  for (const ListedColumn& column : listing.columns) rows.push_back(row_of(column));
  for (Row& row : rows) {
    for (std::string& cell : row) cell = printable(cell);
  }
  text += table_of(rows);
  const bool likely = std::any_of(listing.columns.begin(), listing.columns.end(),
                                  [](const ListedColumn& column) { return column.is_likely; });
  if (likely) text += "  ?: what the name or the unit suggests; it is taken where --columns names it\n";
  std::vector<double> intervals = listing.intervals;
  intervals.erase(std::unique(intervals.begin(), intervals.end()), intervals.end());
  for (const double interval : intervals)
    text += fmt::format("  time: every {} s, as the file states\n", general(interval));
  constexpr std::size_t kMostFacts = 20;
  for (std::size_t i = 0; i < listing.facts.size() && i < kMostFacts; ++i) {
    text += printable(fmt::format("  {}: {}", listing.facts[i].first, listing.facts[i].second.substr(0, 60))) + "\n";
  }
  if (listing.facts.size() > kMostFacts) text += fmt::format("  and {} more\n", listing.facts.size() - kMostFacts);
  for (const std::string& note : listing.notes) text += printable("  " + note) + "\n";
  return text;
}

std::string missing_columns(const ColumnListing& listing) {
  const std::map<std::string, std::string> needs = {{"time", "time (or the rate of sampling: --rate 20kHz)"},
                                                    {"friction", "friction (mu, force or torque)"},
                                                    {"velocity", "velocity (v_b, v_r, x_b or speed)"}};
  std::vector<std::string> missing;
  for (const std::string& what : listing.missing) missing.push_back(needs.at(what));
  std::string text = "\nA law needs time, friction and velocity. Not recognised here: " + listed(missing) + "\n";
  const auto unknown = std::find_if(listing.columns.begin(), listing.columns.end(), [](const ListedColumn& column) {
    return column.channel.empty() && column.unit.empty() && !column.is_text && column.count > 0;
  });
  if (unknown == listing.columns.end()) return text;
  const auto is_missing = [&](const char* what) {
    return std::find(listing.missing.begin(), listing.missing.end(), what) != listing.missing.end();
  };
  const std::string& name = unknown->request;
  const std::string choice = is_missing("friction")   ? "mu=" + name
                             : is_missing("velocity") ? "v_b=" + name + ":mm/s"
                                                      : "time=" + name + ":s";
  return text + fmt::format("If '{}' is that, say so: --columns {}\n", printable(unknown->name), shell_quoted(choice));
}

/// The command that fits the trace, or what keeps it from being one.
std::string next_step(const TriedColumns& tried, const std::string& path) {
  const ColumnListing& listing = tried.listing;
  if (!listing.missing.empty()) return missing_columns(listing);
  if (!tried.obstacle.empty()) return "\nThese columns make no trace yet: " + printable(tried.obstacle) + "\n";
  std::vector<std::string> examples;
  if (tried.needs_radius) examples.emplace_back("15mm for the friction radius of your machine");
  for (const std::string& unit : listing.assumed) examples.push_back(unit + ", whose unit the file does not state");
  return fmt::format("\nNext{}:\n  identify{} --columns {} {}\n",
                     examples.empty() ? "" : " (check " + listed(examples) + ")",
                     tried.needs_radius ? " --radius 15mm" : "", shell_quoted(listing.selection), shell_quoted(path));
}

}  // namespace

void add_columns(const Command& app) {
  const auto file = std::make_shared<std::string>();
  const Command verb = app.add_verb("columns", "List what a file holds, with the --columns line for it",
                                    "Any file that identify reads: text, MATLAB, UFF 58 and 58b, TDMS. What it is "
                                    "taken for is what --columns says.\n\n"
                                    "Examples:\n"
                                    "  identify columns trace.csv\n"
                                    "  identify columns export.mat");
  verb.add_option("FILE", *file, "File of a trace").required();
  verb.on_run([file, verb] {
    const TriedColumns tried = try_columns(*file);
    print(table_and_facts(tried.listing, *file) + next_step(tried, *file));
  });
}
