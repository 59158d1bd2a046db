#include "tribofit/ingest/list_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "column_names.hpp"
#include "columns.hpp"
#include "reader.hpp"
#include "tribofit/ingest/file_names.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

std::string unit_of(const RawColumn& column, const ColumnName& name) {
  return name.unit && !name.unit->empty() ? *name.unit : column.unit;
}

/// The name that --columns finds each column by: itself, or its number where another has the same or it cannot be
/// typed.
std::vector<std::string> requests_for(const RawTable& table) {
  std::map<std::string_view, std::size_t> count;
  for (const RawColumn& column : table.columns) ++count[column.name];
  std::vector<std::string> requests;
  for (const RawColumn& column : table.columns) {
    const bool plain = column.named && count[column.name] == 1 && column.name.find('=') == std::string::npos;
    requests.push_back(plain ? column.name : fmt::format("#{}", requests.size() + 1));
  }
  return requests;
}

/// The channel that a name alone stands for.
std::string channel_named(const RawColumn& column) {
  const ColumnName name = parse_column_name(column.name);
  const auto unit = find_unit(unit_of(column, name));
  const auto quantity = unit && !unit_of(column, name).empty() ? std::optional(unit->quantity) : std::nullopt;
  for (std::size_t k = 0; column.named && k < channel_count; ++k) {
    if (name_rank(name.base, static_cast<Channel>(k), quantity) != no_rank) return std::string(kChannelNames[k]);
  }
  return {};
}

/// Sets what each column is taken for; by their names alone where they make no trace together.
void recognise(const RawTable& table, const ReadOptions& options, ColumnListing& listing) {
  try {
    for (const Column& used : find_columns(table, options).used) {
      listing.columns[used.index].channel = to_string(used.channel);
    }
  } catch (const InputError& error) {
    const std::string where = error.where().column.empty() ? "" : "column " + error.where().column + ": ";
    listing.notes.push_back(where + error.problem() + "; " + error.advice());
    for (std::size_t i = 0; i < table.columns.size(); ++i) listing.columns[i].channel = channel_named(table.columns[i]);
  }
}

void load_what_can_be(RawTable& table, ColumnListing& listing, int threads) {
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (!table.columns[i].is_text) wanted.push_back(i);
  }
  if (!table.load || wanted.empty()) return;
  table.load(table, wanted, threads);
  std::size_t refused = 0;
  for (const std::size_t i : wanted) {
    const RawColumn& column = table.columns[i];
    if (!column.refusal) continue;
    ++refused;
    listing.notes.push_back("column " + column.shown_name() + ": " + column.refusal->problem());
  }
  if (refused == wanted.size()) throw InputError(*table.columns[wanted.front()].refusal);
}

void take_numbers(const RawColumn& column, ListedColumn& listed) {
  listed.count = column.is_text ? column.texts.size() : 0;
  for (const double value : column.numbers) {
    if (!(std::abs(value) < largest_value)) continue;
    listed.lowest = listed.count == 0 ? value : std::min(listed.lowest, value);
    listed.highest = listed.count == 0 ? value : std::max(listed.highest, value);
    ++listed.count;
  }
}

std::string selection_for(const ColumnListing& listing) {
  const auto item = [&](const std::string& channel) -> std::string {
    for (const ListedColumn& column : listing.columns) {
      if (column.channel != channel) continue;
      const auto parsed = parse_column_name(column.name);
      const bool bare = column.unit.empty() && (channel == "v_b" || channel == "v_r" || channel == "speed");
      const std::string unit = bare && !names_rpm(parsed.base) ? (channel == "speed" ? ":rpm" : ":mm/s") : "";
      return channel + "=" + column.request + unit;
    }
    return {};
  };
  std::vector<std::string> items;
  const auto first_of = [&](std::initializer_list<const char*> channels, const char* missing) {
    for (const char* channel : channels) {
      const std::string found = item(channel);
      if (found.empty()) continue;
      items.push_back(found);
      return;
    }
    if (*missing != '\0') items.emplace_back(missing);
  };
  first_of({"time"}, listing.intervals.empty() ? "time=NAME" : "");
  first_of({"mu", "force", "torque"}, "mu=NAME");
  first_of({"v_b", "v_r", "speed"}, "v_b=NAME:mm/s");
  first_of({"load"}, "");
  std::string text;
  for (const std::string& part : items) text += (text.empty() ? "" : ",") + part;
  return text;
}

}  // namespace

ColumnListing list_columns(const std::string& path, const ReadOptions& options) {
  RawTable table = read_table(path);
  ColumnListing listing;
  listing.format = table.format;
  const std::vector<std::string> requests = requests_for(table);
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const RawColumn& column = table.columns[i];
    ListedColumn listed;
    listed.name = column.name;
    listed.place = column.place;
    listed.unit = unit_of(column, parse_column_name(column.name));
    listed.is_text = column.is_text;
    listed.request = requests[i];
    listing.columns.push_back(std::move(listed));
  }
  for (const RawFact& fact : table.facts) listing.facts.emplace_back(fact.name, fact.value);
  recognise(table, options, listing);
  load_what_can_be(table, listing, options.threads);
  for (std::size_t i = 0; i < table.columns.size(); ++i) take_numbers(table.columns[i], listing.columns[i]);
  for (const RawRows& rows : table.rows) {
    if (rows.interval) listing.intervals.push_back(*rows.interval);
  }
  listing.notes.insert(listing.notes.end(), table.notes.begin(), table.notes.end());
  listing.notes.insert(listing.notes.end(), table.warnings.begin(), table.warnings.end());
  listing.selection = selection_for(listing);
  return listing;
}

}  // namespace tribofit
