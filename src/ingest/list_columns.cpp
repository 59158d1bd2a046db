#include "tribofit/ingest/list_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "limits.hpp"
#include "recording.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

/// The name by which each column is asked for: itself, or its number where another has the same or it cannot be
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

/// The channel that a name alone stands for; empty: none.
std::string channel_named(const Label& label) {
  for (const Channel channel : all_channels) {
    if (name_rank(label.base, channel, label.quantity) != no_rank) return std::string(to_string(channel));
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
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (table.columns[i].named) listing.columns[i].channel = channel_named(label_of(table.columns[i]));
    }
  }
}

/// A unit, with one of these parts in the name (if there are any), that suggests a channel.
struct Hint {
  Quantity quantity;
  Channel channel;
  std::string_view parts = {};
};
constexpr Hint hints[] = {{Quantity::angular_velocity, Channel::speed},
                          {Quantity::torque, Channel::torque},
                          {Quantity::temperature, Channel::temperature},
                          {Quantity::length, Channel::x_d, "base drive stage carriage lp loadp ram piston"},
                          {Quantity::length, Channel::x_b, "displ block slider mass vib laser"},
                          {Quantity::velocity, Channel::v_b, "block vib laser"},
                          {Quantity::velocity, Channel::v_r},
                          {Quantity::force, Channel::load, "load normal weight fz fn"},
                          {Quantity::force, Channel::force, "force fric trac tang lateral fx ft"},
                          {Quantity::pressure, Channel::load, "normal norm sigma sn"},
                          {Quantity::pressure, Channel::force, "shear tau"}};

/// What the name or the unit of a column suggests that it holds; empty where they suggest nothing.
std::string likely_channel(const RawColumn& column) {
  Label label = label_of(column);
  for (const Hint& hint : hints) {
    const std::vector<std::string> parts = split(hint.parts, ' ');  // an empty one is in every name
    const auto is_in_name = [&](const std::string& part) { return label.base.find(part) != std::string::npos; };
    if (label.quantity == hint.quantity && std::ranges::any_of(parts, is_in_name))
      return std::string(to_string(hint.channel));
  }
  label.base.erase(label.base.find_last_not_of("0123456789") + 1);  // "Force1_N"
  return column.named ? channel_named(label) : std::string();
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

void take_numbers(const RawColumn& column, ListedColumn& listed) {
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
      const ChannelInfo& info = *std::ranges::find(channel_infos, channel, &ChannelInfo::key);
      const bool of_machine = channel == "x_d" || channel == "v_lp";
      const bool bare = info.unitless == Unitless::unknown && !of_machine && column->unit.empty() &&
                        !names_rpm(parse_column_name(column->name).base);
      const std::string unit(info.unit), request = column->request + (bare ? ":" + unit : "");
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
    listed.unit = label_of(column).unit;
    listed.is_text = column.is_text;
    listed.request = requests[i];
    listing.columns.push_back(std::move(listed));
  }
  for (const RawFact& fact : table.facts) listing.facts.emplace_back(fact.name, fact.value);
  recognise(table, options, listing);
  suggest(table, listing);
  load_what_can_be(table, listing, options.threads);
  run_tasks(table.columns.size(), options.threads,
            [&](std::size_t i) { take_numbers(table.columns[i], listing.columns[i]); });
  for (const RawRows& rows : table.rows) {
    if (rows.interval) listing.intervals.push_back(*rows.interval);
  }
  listing.notes.insert(listing.notes.end(), table.notes.begin(), table.notes.end());
  listing.notes.insert(listing.notes.end(), table.warnings.begin(), table.warnings.end());
  select_trace(listing);
  return listing;
}

/// Tries the columns that a listing selects.
void try_selected(RawTable table, const std::string& path, ReadOptions options, TriedColumns& tried) {
  options.columns = tried.listing.selected;
  bool needed = options.conditions.radius.known();
  tried.needs_radius = true;
  try {
    const Trace trace = assemble(read_recording(std::move(table), path, options), options, &needed);
    const bool stated = trace.conditions.radius.known() || std::ranges::any_of(trace.steps, [](const Step& step) {
                          return step.conditions.radius.known();
                        });
    tried.needs_radius = needed || (!stated && trace.velocity_kind != VelocityKind::relative);
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
  if (tried.listing.missing.empty()) try_selected(std::move(table), path, options, tried);
  return tried;
}

}  // namespace tribofit
