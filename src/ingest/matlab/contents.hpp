#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/input_file.hpp"
#include "ingest/limits.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

/// An array of a MATLAB file, or a field of a structure of one element, without its values.
struct MatArray {
  std::string name;                  ///< "a", or "a.b" of a field
  std::vector<std::uint64_t> sizes;  ///< rows, columns, ...
  std::string kind;                  ///< what it is where it holds no real numbers ("a cell array"); else empty
  bool is_text = false;
  std::vector<double> scalar;  ///< the value of an array of one number
  std::string text;            ///< of a short line of text

  /// The number of elements. The reader has checked that the file can hold as many.
  std::uint64_t elements() const;
};

/// All elements of an array, column after column; or why they cannot be read.
struct MatValues {
  std::vector<double> numbers;
  std::optional<InputError> refusal;
};

/// What a MATLAB file holds. Its arrays are described in order; values are read by name.
class MatContents {
 public:
  virtual ~MatContents() = default;
  virtual void describe(const std::function<void(MatArray&&)>& see) = 0;
  /// The elements of each array.
  virtual std::vector<MatValues> load(std::span<const std::string> names, int threads) = 0;
};

/// Of version 5 to 7. Own code: every count is checked against the file before memory is asked for, and a damaged file
/// is refused with the offset at which it is; so is one of more arrays, or more values when inflated, than a file of
/// its size has. Variables are inflated on several threads.
std::unique_ptr<MatContents> contents_of_version_5(std::shared_ptr<const InputFile> file);

/// Of version 7.3, by libmatio and HDF5, which a damaged file can crash: they run in a process of their own, for one
/// file at a time.
std::unique_ptr<MatContents> contents_of_version_73(std::shared_ptr<const InputFile> file);

inline constexpr std::size_t mat_header_bytes = 128;
/// The header's version: 0x0100 or 0x0200; and whether numbers begin with their highest byte.
unsigned mat_version(std::string_view header);
bool is_mat_big_endian(std::string_view header);

/// Bytes that the values of a file of `size` bytes may take, inflated and as doubles: 128 MB, or 128 times its size.
constexpr std::uint64_t most_mat_bytes(std::uint64_t size) {
  return (size + kMatSizeBeside) * kMostInflated;
}

}  // namespace tribofit
