#include "reader.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "csv/csv_reader.hpp"
#include "csv/encoding.hpp"
#include "matlab/matlab_reader.hpp"
#include "tdms/tdms_reader.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "uff/uff_reader.hpp"

namespace tribofit {

std::span<const Reader> all_readers() {
  static const std::array readers = {matlab_reader, tdms_reader, uff_reader, csv_reader};
  return readers;
}

RawTable read_table(const std::string& path, std::span<const Reader> readers) {
  const auto file = std::make_shared<const InputFile>(path);
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file->size(), signature_bytes)), '\0');
  head.resize(file->read(0, head));
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

}  // namespace tribofit
