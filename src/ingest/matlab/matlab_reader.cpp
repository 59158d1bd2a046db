#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "ingest/limits.hpp"
#include "ingest/numbers.hpp"
#include "ingest/reader.hpp"
#include "mat_file.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

constexpr std::size_t header_bytes = 128, version_at = 124, order_at = 126;
constexpr unsigned version_5 = 0x0100, version_73 = 0x0200;

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

  void add(const MatArray& array) {
    ++arrays_;
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

  std::vector<MatColumn> finish() {
    settle_rows();
    const std::string skipped = listed(skipped_, kMostNamed);
    if (!skipped_.empty()) table_.notes.push_back("not read: " + skipped);
    if (!table_.columns.empty()) return std::move(sources_);
    throw InputError("holds no vector of numbers" + (skipped_.empty() ? "" : ": " + skipped),
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
      sources_.push_back({arrays_ - 1, by_row ? k : k * rows, by_row ? rows : 1, length});
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
  std::size_t arrays_ = 0;
  std::vector<MatColumn> sources_;
  std::set<std::string> names_;
  std::vector<std::string> skipped_;
};

[[noreturn]] void refuse_at(const InputFile& file, std::uint64_t at, const std::string& problem) {
  throw InputError(fmt::format("byte {}: {}", at, problem), "the file is cut off or damaged; copy or save it again",
                   {file.path(), 0, ""});
}

/// The number of variables of a file of version 5: elements of a type, a size and as many bytes, up to its end.
/// libmatio ends without a word where one is damaged.
std::size_t count_variables(const InputFile& file, bool big_endian) {
  std::size_t count = 0;
  constexpr std::size_t tag_bytes = 8;
  for (std::uint64_t at = header_bytes; at < file.size(); ++count) {
    const std::string tag = file.read_text(at, tag_bytes);
    if (tag.size() < tag_bytes) refuse_at(file, at, "the head of a variable is cut off");
    const auto type = number_at<std::uint32_t>(tag, 0, big_endian);
    const std::uint64_t size = number_at<std::uint32_t>(tag, 4, big_endian), left = file.size() - at - tag.size();
    if (type != 14 && type != 15)  // a matrix, or one that is deflated
      refuse_at(file, at, fmt::format("an element of type {} where a variable begins", type));
    if (size > left) refuse_at(file, at, fmt::format("a variable of {} bytes, of which {} are there", size, left));
    if (count == kMostMatArrays) refuse_at(file, at, fmt::format("more than {} variables", kMostMatArrays));
    at += tag.size() + size;
  }
  return count;
}

/// The header's version, and whether numbers begin with their highest byte.
bool is_big_endian(std::string_view header) {
  return header[order_at] == 'M';
}
unsigned version_of(std::string_view header) {
  return number_at<std::uint16_t>(header, version_at, is_big_endian(header));
}

/// The number of variables that a whole file has at least. Throws InputError for one that is not whole.
std::size_t check_whole(const InputFile& file) {
  const std::string header = file.read_text(0, header_bytes);
  if (header.size() < header_bytes) {
    throw InputError(fmt::format("is cut off at byte {}, in its head", header.size()), "copy or save the file again",
                     {file.path(), 0, ""});
  }
  const unsigned version = version_of(header);
  if (version == version_5) return count_variables(file, is_big_endian(header));
  if (version != version_73) {
    throw InputError(
        fmt::format("byte {}: is of version {:#06x} of MATLAB's format, which is not known", version_at, version),
        "save it with save(..., '-v7')", {file.path(), 0, ""});
  }
  return 1;  // HDF5 opens no file that is not whole, and libmatio then finds no variable in it
}

RawTable read_matlab(std::shared_ptr<const InputFile> file) {
  const std::size_t variables = check_whole(*file);
  RawTable table;
  table.path = file->path();
  Listing listing(table);
  for (const MatArray& array : describe_mat_file(*file, variables)) listing.add(array);
  table.load = [file, sources = listing.finish()](RawTable& filled, std::span<const std::size_t> columns, int) {
    std::vector<MatColumn> asked;
    for (const std::size_t index : columns) asked.push_back(sources[index]);
    Apart reading = read_mat_columns(*file, std::move(asked));
    for (const std::size_t index : columns) {
      try {
        filled.columns[index].numbers = reading.next<std::vector<double>>();
      } catch (const InputError& error) {
        filled.columns[index].refusal.emplace(error.problem(), error.advice(), filled.heading(index));
      }
    }
  };
  return table;
}

bool is_matlab(std::string_view head) {
  if (head.starts_with("MATLAB 5.0") || head.starts_with("MATLAB 7.3")) return true;
  if (head.size() < header_bytes || head.starts_with(std::string_view("\0\0\0\0", 4))) return false;
  const std::string_view order = head.substr(order_at, 2);
  if (order != "IM" && order != "MI") return false;
  return version_of(head) == version_5 || version_of(head) == version_73;
}

}  // namespace

/// MATLAB's files of version 5 to 7 and 7.3, by libmatio. Every numeric vector, row or column, is a column; those of a
/// matrix are columns "a(:,1)", those of a structure "a.b". Vectors of one length share rows. Scalars and lines of text
/// are facts: fs and dt give the sampling where no vector holds the time. Cells, objects, complex and sparse arrays are
/// named and not read.
const Reader matlab_reader = {"MATLAB", is_matlab, read_matlab};

}  // namespace tribofit
