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

/// The second in which the first of the times begins: times are measured from there, or they would lose digits.
double epoch_of(const InputFile& file, const TdmsObject& object) {
  if (object.type != tdms::timestamp || object.pieces.empty()) return 0;
  std::string bytes(16, '\0');
  file.read(object.pieces.front().begin, bytes);
  return std::floor(tdms::value_at(bytes, 0, tdms::timestamp, object.pieces.front().big_endian, 0));
}

/// Values at even distances, from a byte on.
void read_values(const InputFile& file, const TdmsObject& object, const TdmsPiece& piece, std::uint64_t begin,
                 double epoch, std::vector<double>& out) {
  const std::uint64_t size = tdms::bytes_of(object.type);
  const std::uint64_t most = std::max<std::uint64_t>(1, (1 << 20) / piece.stride);
  std::string bytes;
  for (std::uint64_t done = 0; done < piece.count;) {
    const std::uint64_t now = std::min(most, piece.count - done);
    bytes.resize(static_cast<std::size_t>((now - 1) * piece.stride + size));
    if (file.read(begin + done * piece.stride, bytes) < bytes.size()) {
      throw InputError(fmt::format("byte {}: the values are cut off", file.size()), "copy the file again",
                       {file.path(), 0, object.path});
    }
    for (std::uint64_t i = 0; i < now; ++i) {
      out.push_back(
          tdms::value_at(bytes, static_cast<std::size_t>(i * piece.stride), object.type, piece.big_endian, epoch));
    }
    done += now;
  }
}

void read_piece(const InputFile& file, const TdmsObject& object, const TdmsPiece& piece, double epoch,
                std::vector<double>& out) {
  if (piece.count == 1 && piece.chunks > 1 && piece.chunk_stride <= 4096) {  // read what is between them, too
    const TdmsPiece values = {piece.begin, piece.chunks, piece.chunk_stride, 1, 0, piece.big_endian};
    return read_values(file, object, values, piece.begin, epoch, out);
  }
  for (std::uint64_t k = 0; k < piece.chunks; ++k) {
    read_values(file, object, piece, piece.begin + k * piece.chunk_stride, epoch, out);
  }
}

void load_channels(const InputFile& file, const Objects& channels, RawTable& table,
                   std::span<const std::size_t> columns) {
  for (const std::size_t index : columns) {
    const TdmsObject& object = channels[index];
    RawColumn& column = table.columns[index];
    if (!column.numbers.empty()) continue;
    if (column.is_text) {
      column.refusal.emplace("holds text, not numbers", "name another column with " + setting("columns"),
                             table.heading(index));
      continue;
    }
    if (is_unscaled(object)) {
      column.refusal.emplace("the values are raw ones of DAQmx, which need its scaling",
                             "export the channel scaled, as a TDMS file of doubles or as CSV", table.heading(index));
      continue;
    }
    const double epoch = epoch_of(file, object);
    column.numbers.reserve(column.count);
    for (const TdmsPiece& piece : object.pieces) read_piece(file, object, piece, epoch, column.numbers);
  }
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
