#include "matlab_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "contents.hpp"
#include "ingest/limits.hpp"
#include "ingest/numbers.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

constexpr std::size_t most_named = 20;  // of the variables that are not read
constexpr std::size_t version_at = 124, order_at = 126;
constexpr unsigned version_5 = 0x0100, version_73 = 0x0200;

/// Where the values of a column are: in an array, from an element on, every stride-th.
struct Source {
  std::string array;
  std::uint64_t first = 0, stride = 1;
};

/// Rows and columns; nothing for arrays of more dimensions.
std::pair<std::uint64_t, std::uint64_t> shape(const MatArray& array) {
  std::size_t long_sides = 0;
  std::uint64_t rows = 1, columns = 1;
  for (std::size_t k = 0; k < array.sizes.size(); ++k) {
    const std::uint64_t size = array.sizes[k];
    if (size == 1) continue;
    if (++long_sides > 2) return {0, 0};
    (k == 0 ? rows : columns) = size;
  }
  return {rows, columns};
}

class Listing {
 public:
  explicit Listing(RawTable& table) : table_(table) {}

  void add(MatArray&& array) {
    if (!names_.insert(array.name).second) {
      skipped_.push_back(array.name + " (another array has its name)");
    } else if (array.is_text) {
      if (!array.text.empty()) table_.facts.push_back({array.name, array.text});
    } else if (!array.scalar.empty()) {
      table_.facts.push_back({array.name, fmt::format("{}", array.scalar.front())});
    } else if (!array.kind.empty()) {
      skipped_.push_back(fmt::format("{} ({})", array.name, array.kind));
    } else {
      add_columns(array);
    }
  }

  std::vector<Source> finish() {
    settle_rows();
    if (!skipped_.empty()) table_.notes.push_back("not read: " + listed(skipped_, most_named));
    if (!table_.columns.empty()) return std::move(sources_);
    throw InputError("holds no vector of numbers" + (skipped_.empty() ? "" : ": " + listed(skipped_, most_named)),
                     "save each channel as a vector of its own, with save(..., '-v7')", {table_.path, 0, ""});
  }

 private:
  void add_columns(const MatArray& array) {
    const auto [rows, columns] = shape(array);
    if (rows == 0 && array.elements() > 0) {
      skipped_.push_back(array.name + " (an array of three dimensions)");
      return;
    }
    const bool by_row = columns > rows;
    const std::uint64_t length = array.elements() == 0 ? 0 : std::max(rows, columns);
    const std::uint64_t sides = length == 0 ? 1 : std::min(rows, columns);
    if (sources_.size() + sides > kMostColumns) {
      skipped_.push_back(array.name + " (more columns than can be channels)");
      return;
    }
    for (std::uint64_t k = 0; k < sides; ++k) {
      RawColumn column;
      column.name = sides == 1 ? array.name
                    : by_row   ? fmt::format("{}({},:)", array.name, k + 1)
                               : fmt::format("{}(:,{})", array.name, k + 1);
      column.count = static_cast<std::size_t>(length);
      table_.columns.push_back(std::move(column));
      sources_.push_back({array.name, by_row ? k : k * rows, by_row ? rows : 1});
    }
  }

  /// Vectors of one length were recorded together; empty ones are of no rows, and are refused where they are wanted.
  void settle_rows() {
    std::map<std::size_t, std::size_t> rows_of;
    for (RawColumn& column : table_.columns) {
      if (column.count > 0) column.rows = rows_of.emplace(column.count, rows_of.size()).first->second;
    }
    table_.rows.resize(std::max<std::size_t>(1, rows_of.size()));
  }

  RawTable& table_;
  std::vector<Source> sources_;
  std::set<std::string> names_;
  std::vector<std::string> skipped_;
};

void load_vectors(MatContents& contents, const std::vector<Source>& sources, RawTable& table,
                  std::span<const std::size_t> columns, int threads) {
  std::vector<std::string> names;
  for (const std::size_t index : columns) {
    const bool known = std::find(names.begin(), names.end(), sources[index].array) != names.end();
    if (!known && table.columns[index].count > 0) names.push_back(sources[index].array);
  }
  std::vector<MatValues> arrays = contents.load(names, threads);
  for (const std::size_t index : columns) {
    RawColumn& column = table.columns[index];
    const Source& source = sources[index];
    if (column.count == 0) {
      column.refusal.emplace("the vector is empty", "name another one with --columns", table.heading(index));
      continue;
    }
    auto& [values, refusal] =
        arrays[static_cast<std::size_t>(std::find(names.begin(), names.end(), source.array) - names.begin())];
    if (refusal) {
      column.refusal = refusal;
      continue;
    }
    if (values.size() == column.count) {
      column.numbers = std::move(values);
      continue;
    }
    if (values.size() <= source.first + (column.count - 1) * source.stride) {
      if (!column.numbers.empty()) continue;  // of two channels
      column.refusal.emplace(fmt::format("the {} values of the vector are not all in the file", column.count),
                             "the file is damaged; save it again", table.heading(index));
      continue;
    }
    column.numbers.resize(column.count);
    for (std::size_t i = 0; i < column.count; ++i) column.numbers[i] = values[source.first + i * source.stride];
  }
}

RawTable read_matlab(std::shared_ptr<const InputFile> file) {
  RawTable table;
  table.path = file->path();
  std::string header(mat_header_bytes, '\0');
  header.resize(file->read(0, header));
  if (header.size() < mat_header_bytes) {
    throw InputError(fmt::format("is cut off at byte {}, in its head", header.size()), "copy or save the file again",
                     {file->path(), 0, ""});
  }
  const unsigned version = mat_version(header);
  if (version != version_5 && version != version_73) {
    throw InputError(
        fmt::format("byte {}: is of version {:#06x} of MATLAB's format, which is not known", version_at, version),
        "save it with save(..., '-v7')", {file->path(), 0, ""});
  }
  const std::shared_ptr<MatContents> contents =
      version == version_5 ? contents_of_version_5(file) : contents_of_version_73(file);
  Listing listing(table);
  contents->describe([&](MatArray&& array) { listing.add(std::move(array)); });
  const auto sources = std::make_shared<const std::vector<Source>>(listing.finish());
  table.load = [contents, sources](RawTable& filled, std::span<const std::size_t> columns, int threads) {
    load_vectors(*contents, *sources, filled, columns, threads);
  };
  return table;
}

bool is_matlab(std::string_view head) {
  if (head.starts_with("MATLAB 5.0") || head.starts_with("MATLAB 7.3")) return true;
  if (head.size() < mat_header_bytes || head.starts_with(std::string_view("\0\0\0\0", 4))) return false;
  const std::string_view order = head.substr(order_at, 2);
  if (order != "IM" && order != "MI") return false;
  return mat_version(head) == version_5 || mat_version(head) == version_73;
}

}  // namespace

std::uint64_t MatArray::elements() const {
  std::uint64_t count = sizes.empty() ? 0 : 1;
  for (const std::uint64_t size : sizes) {
    if (size != 0 && count > std::numeric_limits<std::uint64_t>::max() / size)
      return std::numeric_limits<std::uint64_t>::max();
    count *= size;
  }
  return count;
}

unsigned mat_version(std::string_view header) {
  return number_at<std::uint16_t>(header, version_at, is_mat_big_endian(header));
}

bool is_mat_big_endian(std::string_view header) {
  return header[order_at] == 'M';
}

const Reader matlab_reader = {"MATLAB", is_matlab, read_matlab};

}  // namespace tribofit
