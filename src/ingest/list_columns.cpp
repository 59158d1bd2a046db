#include "tribofit/ingest/list_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "assemble.hpp"
#include "column_names.hpp"
#include "columns.hpp"
#include "limits.hpp"
#include "points.hpp"
#include "reader.hpp"
#include "recording.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/execution/parallel.hpp"
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
    if (name_rank(name.base, static_cast<Channel>(k), quantity) != no_rank)
      return std::string(to_string(static_cast<Channel>(k)));
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

bool contains_any(std::string_view text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string_view::npos; });
}

/// What the name or the unit of a column suggests that it holds; empty where they suggest nothing.
std::string likely_channel(const RawColumn& column) {
  const ColumnName name = parse_column_name(column.name);
  const std::string text = unit_of(column, name);
  const auto unit = find_unit(text);
  const bool has_unit = unit && !text.empty();
  const bool load = contains_any(name.base, {"load", "normal", "weight", "fz", "fn"});
  if (has_unit && find_unit(text, Quantity::angular_velocity)) return "speed";
  if (has_unit && unit->quantity == Quantity::torque) return "torque";
  if (has_unit && unit->quantity == Quantity::temperature) return "temperature";
  if (has_unit && unit->quantity == Quantity::length) {
    if (contains_any(name.base, {"base", "drive", "stage", "carriage", "lp", "loadp", "ram", "piston"})) return "x_d";
    if (contains_any(name.base, {"displ", "block", "slider", "mass", "vib", "laser"})) return "x_b";
  }
  if (has_unit && unit->quantity == Quantity::velocity)
    return contains_any(name.base, {"block", "vib", "laser"}) ? "v_b" : "v_r";
  if (has_unit && unit->quantity == Quantity::force) {
    if (load) return "load";
    if (contains_any(name.base, {"force", "fric", "trac", "tang", "lateral", "fx", "ft"})) return "force";
  }
  if (has_unit && unit->quantity == Quantity::pressure) {
    if (contains_any(name.base, {"normal", "norm", "sigma", "sn"})) return "load";
    if (contains_any(name.base, {"shear", "tau"})) return "force";
  }
  const std::size_t end = name.base.find_last_not_of("0123456789");  // "Force1_N"
  RawColumn without_number = column;
  without_number.name = end == std::string::npos ? "" : name.base.substr(0, end + 1);
  without_number.unit = text;
  return end == std::string::npos ? "" : channel_named(without_number);
}

/// Where a channel has no column, those that are likely to be it.
void suggest(const RawTable& table, ColumnListing& listing) {
  const auto is_taken = [&](const std::string& channel) {
    return std::any_of(listing.columns.begin(), listing.columns.end(),
                       [&](const ListedColumn& c) { return c.channel == channel && !c.is_likely; });
  };
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    ListedColumn& listed = listing.columns[i];
    if (!listed.channel.empty() || listed.is_text) continue;
    const std::string channel = likely_channel(table.columns[i]);
    if (channel.empty() || is_taken(channel)) continue;
    listed.channel = channel;
    listed.is_likely = true;
  }
}

void load_what_can_be(RawTable& table, ColumnListing& listing, int threads) {
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (!table.columns[i].is_text) wanted.push_back(i);
  }
  if (!table.load || wanted.empty()) return;
  table.load(table, wanted, threads);
  table.load = nullptr;  // they are there
  std::size_t refused = 0;
  for (const std::size_t i : wanted) {
    const RawColumn& column = table.columns[i];
    if (!column.refusal) continue;
    ++refused;
    listing.notes.push_back("column " + column.shown_name() + ": " + column.refusal->problem());
  }
  if (refused == wanted.size()) throw InputError(*table.columns[wanted.front()].refusal);
}

/// is_finite: the reader knows that there are numbers alone, as in most files.
void take_numbers(const RawColumn& column, bool is_finite, ListedColumn& listed) {
  if (is_finite && !column.is_text && !column.numbers.empty()) {
    const Extremes all = extremes(column.numbers);
    listed.count = column.numbers.size(), listed.lowest = all.low, listed.highest = all.high;
    return;
  }
  listed.count = column.is_text ? column.texts.size() : 0;
  for (const double value : column.numbers) {
    if (!(std::abs(value) < kLargestValue)) continue;
    listed.lowest = listed.count == 0 ? value : std::min(listed.lowest, value);
    listed.highest = listed.count == 0 ? value : std::max(listed.highest, value);
    ++listed.count;
  }
}

/// Adds the first column of these channels, those that are certain before those that are likely. False where there is
/// none.
bool select(std::initializer_list<const char*> channels, ColumnListing& listing) {
  for (const bool likely : {false, true}) {
    for (const std::string channel : channels) {
      const auto column = std::find_if(listing.columns.begin(), listing.columns.end(), [&](const ListedColumn& c) {
        return c.channel == channel && c.is_likely == likely;
      });
      if (column == listing.columns.end()) continue;
      const bool needs_unit = channel == "v_b" || channel == "v_r" || channel == "speed" || channel == "x_b";
      const bool bare = needs_unit && column->unit.empty() && !names_rpm(parse_column_name(column->name).base);
      const std::string unit = !bare ? "" : channel == "speed" ? "rpm" : channel == "x_b" ? "mm" : "mm/s";
      const std::string request = column->request + (bare ? ":" + unit : "");
      if (bare) listing.assumed.push_back(unit + " of " + channel);
      listing.selected.emplace(channel, request);
      listing.selection += (listing.selection.empty() ? "" : ",") + channel + "=" + request;
      return true;
    }
  }
  return false;
}

void select_trace(ColumnListing& listing) {
  if (!select({"time"}, listing) && listing.intervals.empty()) listing.missing.emplace_back("time");
  if (!select({"mu", "force", "torque"}, listing)) listing.missing.emplace_back("friction");
  const bool moves = select({"v_b", "v_r", "x_b", "speed", "v_lp"}, listing);
  const bool is_driven = select({"x_d"}, listing);
  if (!moves && !is_driven) listing.missing.emplace_back("velocity");
  select({"load"}, listing);
  const bool tabulated = std::all_of(listing.columns.begin(), listing.columns.end(),
                                     [](const ListedColumn& column) { return column.count <= kMostTabulated; });
  const bool only_time = listing.missing == std::vector<std::string>{"time"};
  if (!only_time || !tabulated || listing.selected.contains("v_b")) return;
  listing.missing.clear();
  listing.notes.emplace_back("no time: a table of steady points");
}

/// What a table holds, all columns of which are then loaded.
ColumnListing listing_of(RawTable& table, const ReadOptions& options) {
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
  suggest(table, listing);
  load_what_can_be(table, listing, options.threads);
  run_tasks(table.columns.size(), options.threads,
            [&](std::size_t i) { take_numbers(table.columns[i], table.is_finite, listing.columns[i]); });
  for (const RawRows& rows : table.rows) {
    if (rows.interval) listing.intervals.push_back(*rows.interval);
  }
  listing.notes.insert(listing.notes.end(), table.notes.begin(), table.notes.end());
  listing.notes.insert(listing.notes.end(), table.warnings.begin(), table.warnings.end());
  select_trace(listing);
  return listing;
}

/// With which it is seen whether a radius is all that is missing [m].
constexpr double kExampleRadius = 0.015;

/// Tries the columns that a listing selects.
void try_selected(RawTable table, const std::string& path, ReadOptions options, TriedColumns& tried) {
  options.columns = tried.listing.selected;
  const bool given = options.conditions.radius.known();
  tried.needs_radius = true;
  try {
    const Trace trace = assemble(read_recording(std::move(table), path, options), options);
    const bool stated =
        trace.conditions.radius.known() || std::any_of(trace.steps.begin(), trace.steps.end(),
                                                       [](const Step& step) { return step.conditions.radius.known(); });
    tried.obstacle.clear();
    tried.needs_radius = given || (!stated && trace.velocity_kind != VelocityKind::relative);
  } catch (const InputError& error) {
    tried.obstacle = error.problem() + "; " + error.advice();
  }
}

}  // namespace

ColumnListing list_columns(const std::string& path, const ReadOptions& options) {
  RawTable table = read_table(path);
  return listing_of(table, options);
}

TriedColumns try_columns(const std::string& path, const ReadOptions& options) {
  RawTable table = read_table(path);
  TriedColumns tried{listing_of(table, options), "", false};
  if (!tried.listing.missing.empty()) return tried;
  try_selected(std::move(table), path, options, tried);
  if (tried.obstacle.empty()) return tried;
  ReadOptions with_radius = options;
  with_radius.conditions.radius = {kExampleRadius, "example"};
  try_selected(read_table(path), path, with_radius, tried);
  return tried;
}

}  // namespace tribofit
