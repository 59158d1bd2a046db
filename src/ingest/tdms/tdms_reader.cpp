#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "ingest/limits.hpp"
#include "ingest/reader.hpp"
#include "tdms_file.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

using Objects = std::vector<TdmsObject>;

std::string text_of(const TdmsProperty* property) {
  return property != nullptr && property->is_text ? property->text : std::string();
}

double number_of(const TdmsProperty* property) {
  return property != nullptr && !property->is_text ? property->number : 0;
}

/// Values that DAQmx has left unscaled, though they are numbers of a usual type.
bool is_unscaled(const TdmsObject& object) {
  return lower_case(text_of(object.find("NI_Scaling_Status"))) == "unscaled" &&
         number_of(object.find("NI_Number_Of_Scales")) > 0;
}

RawColumn column_of(const TdmsObject& object, std::size_t rows) {
  RawColumn column;
  column.name = object.names.back();
  column.place = "group " + object.names.front();
  column.unit = text_of(object.find("unit_string"));
  if (column.unit.empty()) column.unit = text_of(object.find("NI_UnitDescription"));
  if (object.type == tdms::timestamp) column.unit = "s";
  column.rows = rows;
  column.count = static_cast<std::size_t>(object.count);
  column.is_text = object.type == tdms::text;
  return column;
}

void load_channels(const InputFile& file, const Objects& channels, RawTable& table,
                   std::span<const std::size_t> columns) {
  std::map<std::size_t, std::vector<double>*> wanted;
  for (const std::size_t index : columns) {
    RawColumn& column = table.columns[index];
    if (column.is_text) {
      column.refusal.emplace("holds text, not numbers", "name another column with " + setting("columns"),
                             table.heading(index));
    } else if (is_unscaled(channels[index])) {
      column.refusal.emplace("the values are raw ones of DAQmx, which need its scaling",
                             "export the channel scaled, as a TDMS file of doubles or as CSV", table.heading(index));
    } else {
      column.numbers.reserve(column.count);
      wanted.emplace(channels[index].number, &column.numbers);
    }
  }
  if (!wanted.empty()) read_tdms_values(file, wanted);
}

void add_facts(const TdmsObject& object, RawTable& table) {
  for (const TdmsProperty& property : object.properties) {
    if (property.name == "name") continue;
    table.facts.push_back({property.name, property.is_text ? property.text : fmt::format("{}", property.number)});
  }
}

RawTable read_tdms(std::shared_ptr<const InputFile> file) {
  RawTable table;
  table.path = file->path();
  auto channels = std::make_shared<Objects>();
  std::size_t more = 0;
  std::map<std::tuple<std::uint64_t, double, double>, std::size_t> rows_of;  // count, interval, start
  for (TdmsObject& object : read_tdms_objects(*file, table.notes)) {
    if (object.names.size() < 2) add_facts(object, table);
    if (object.names.size() < 2 || object.type == 0) continue;
    if (channels->size() == kMostColumns) {
      ++more;
      continue;
    }
    const double interval = number_of(object.find("wf_increment")), start = number_of(object.find("wf_start_offset"));
    const bool sampled = interval > 0 && std::isfinite(interval) && std::isfinite(start);
    const auto same = std::tuple(object.count, sampled ? interval : 0, sampled ? start : 0);
    const auto [at, is_new] = rows_of.emplace(same, rows_of.size());
    if (table.rows.size() <= at->second) table.rows.emplace_back();
    if (is_new && sampled) {
      table.rows[at->second].interval = interval;
      table.rows[at->second].start = start;
    }
    table.columns.push_back(column_of(object, at->second));
    channels->push_back(std::move(object));
  }
  if (more > 0) table.notes.push_back(fmt::format("not read: {} channels beyond the first {}", more, kMostColumns));
  if (channels->empty()) {
    throw InputError("holds no channel with values", "check that the export was complete", {table.path, 0, ""});
  }
  table.load = [file, channels](RawTable& filled, std::span<const std::size_t> columns, int) {
    load_channels(*file, *channels, filled, columns);
  };
  return table;
}

bool is_tdms(std::string_view head) {
  return head.starts_with("TDSm");
}

}  // namespace

/// NI's TDMS: channels of numbers or times, of either order of bytes, contiguous or interleaved, in any number of
/// segments. Channels of one length and sampling share rows; wf_increment gives the sampling, unit_string the unit. The
/// properties of the file and its groups are facts. Raw values of DAQmx, which are to be scaled, are refused.
///
/// After "TDMS File Format Internal Structure" (NI).
const Reader tdms_reader = {"TDMS", is_tdms, read_tdms};

}  // namespace tribofit
