#include "tribofit/ingest/read_trace.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

#include "assemble.hpp"
#include "join.hpp"
#include "reader.hpp"
#include "recording.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

/// With two files a column may be in either; in one of them it must be.
void check_requests(const FileRecord& first, const FileRecord& second, const ReadOptions& options) {
  for (std::size_t k = 0; k < channel_count; ++k) {
    const auto channel = static_cast<Channel>(k);
    const auto request = options.columns.find(std::string(to_string(channel)));
    if (request == options.columns.end() || request->second.empty() || request->second == "none") continue;
    if (first.columns.find(channel) != nullptr || second.columns.find(channel) != nullptr) continue;
    throw InputError("there is no column '" + request->second + "' for " + request->first + " in either file",
                     "the columns are: " + listed(first.column_names) + "; " + listed(second.column_names) + "; " +
                         lists_columns(second.path),
                     {first.path, 0, ""});
  }
}

void refuse_twice(const std::string& path, const std::string& next) {
  std::error_code none;
  if (!std::filesystem::equivalent(path, next, none)) return;
  throw InputError("the file is given twice as a part of the run", "name every part once", {next, 0, ""});
}

}  // namespace

Trace read_trace(const std::string& path, const ReadOptions& options, std::span<const Reader> readers) {
  FileRecord run = read_recording(path, options, readers);
  for (std::size_t i = 0; i < options.continued_in.size(); ++i) {
    refuse_twice(path, options.continued_in[i]);
    for (std::size_t k = 0; k < i; ++k) refuse_twice(options.continued_in[k], options.continued_in[i]);
    continue_recording(run, read_recording(options.continued_in[i], options, readers), i + 2);
  }
  if (!options.second_file.empty()) {
    FileRecord other = read_recording(options.second_file, options, readers);
    check_requests(run, other, options);
    join(run, std::move(other), options.clock_offset);
  }
  return assemble(std::move(run), options);
}

Trace read_trace(const std::string& path, const ReadOptions& options) {
  return read_trace(path, options, all_readers());
}

}  // namespace tribofit
