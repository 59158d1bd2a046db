#include "tribofit/ingest/read_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include "csv/encoding.hpp"
#include "recording.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

using NamedColumns = std::map<std::string, std::string>;

bool is_named(const NamedColumns& columns, std::string_view channel) {
  const auto request = columns.find(std::string(channel));
  return request != columns.end() && !request->second.empty() && request->second != "none";
}

/// With two files a column may be in either; in one of those it is asked of it must be.
void check_requests(const NamedColumns& columns, std::initializer_list<const FileRecord*> files) {
  for (const Channel channel : all_channels) {
    if (!is_named(columns, to_string(channel))) continue;
    const auto holds = [&](const FileRecord* file) { return file->columns.find(channel) != nullptr; };
    if (std::any_of(files.begin(), files.end(), holds)) continue;
    std::string names;
    for (const FileRecord* file : files) names += (names.empty() ? "" : "; ") + listed(file->column_names);
    const FileRecord& last = **std::prev(files.end());
    throw InputError(fmt::format("there is no column '{}' for {}{}", columns.at(std::string(to_string(channel))),
                                 to_string(channel), files.size() > 1 ? " in either file" : ""),
                     "the columns are: " + names + "; " + lists_columns(last.path), {(*files.begin())->path, 0, ""});
  }
}

/// What one file is asked for is not looked for in the other, nor is another description of the same quantity.
void leave_to_other(const NamedColumns& named, NamedColumns& other) {
  const NamedColumns asked = other;
  for (const Channel channel : all_channels) {
    if (channel == Channel::time || !is_named(named, to_string(channel))) continue;
    const auto is_same = [&](Channel c) { return info_of(c).target == info_of(channel).target; };
    const bool is_in_both =
        std::ranges::any_of(all_channels, [&](Channel c) { return is_same(c) && is_named(asked, to_string(c)); });
    for (const Channel c : all_channels) {
      if ((c == channel || (is_same(c) && !is_in_both)) && !is_named(asked, to_string(c)))
        other[std::string(to_string(c))] = "none";
    }
  }
}

/// Reads the second file and joins it.
void join_second(FileRecord& run, const ReadOptions& options, ReadOptions second, std::span<const Reader> readers) {
  FileRecord other = read_recording(options.second_file, second, readers);
  if (options.second_columns.empty()) {
    check_requests(options.columns, {&run, &other});
  } else {
    check_requests(options.columns, {&run});
    check_requests(options.second_columns, {&other});
  }
  join(run, std::move(other), options.clock_offset);
}

void refuse_twice(const std::string& path, const std::string& next) {
  std::error_code none;
  if (!std::filesystem::equivalent(path, next, none)) return;
  throw InputError("the file is given twice as a part of the run", "name every part once", {next, 0, ""});
}

}  // namespace

std::span<const Reader> all_readers() {
  static const std::array readers = {matlab_reader, tdms_reader, uff_reader, csv_reader};
  return readers;
}

RawTable read_table(const std::string& path, std::span<const Reader> readers) {
  const auto file = std::make_shared<const InputFile>(path);
  const std::string head = file->read_text(0, signature_bytes);
  const auto known =
      std::find_if(readers.begin(), readers.end(), [&](const Reader& reader) { return reader.recognises(head); });
  if (known != readers.end()) {
    RawTable table = known->read(file);
    table.format = known->format;
    return table;
  }
  refuse_unless_text(head, path);
  std::vector<std::string> formats;
  for (const Reader& reader : readers) formats.emplace_back(reader.format);
  throw InputError("is of no known format", "export the trace as one of: " + listed(formats), {path, 0, ""});
}

Trace read_trace(const std::string& path, const ReadOptions& options, std::span<const Reader> readers) {
  ReadOptions first = options, second = options;
  if (!options.second_columns.empty()) {
    second.columns = options.second_columns;
    leave_to_other(options.second_columns, first.columns);
    leave_to_other(options.columns, second.columns);
  }
  if (!options.second_columns.empty() || !options.second_units.empty()) second.units = options.second_units;
  FileRecord run = read_recording(path, first, readers);
  for (std::size_t i = 0; i < options.continued_in.size(); ++i) {
    refuse_twice(path, options.continued_in[i]);
    for (std::size_t k = 0; k < i; ++k) refuse_twice(options.continued_in[k], options.continued_in[i]);
    continue_recording(run, read_recording(options.continued_in[i], first, readers), i + 2);
  }
  if (run.is_points() && !options.second_file.empty()) {
    throw InputError("points have no time on which a second file could be joined", "put all columns into one file",
                     {options.second_file, 0, ""});
  }
  if (!options.second_file.empty()) join_second(run, options, std::move(second), readers);
  return assemble(std::move(run), options);
}

Trace read_trace(const std::string& path, const ReadOptions& options) {
  return read_trace(path, options, all_readers());
}

}  // namespace tribofit
