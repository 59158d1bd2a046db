#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "apart.hpp"
#include "ingest/input_file.hpp"

namespace tribofit {

/// An array of a MATLAB file, or a field of a structure of one element, without its values.
struct MatArray {
  std::string name;                  ///< "a", or "a.b" of a field
  std::vector<std::uint64_t> sizes;  ///< rows, columns, ...
  std::string kind;                  ///< what it is where it holds no real numbers ("a cell array"); else empty
  bool is_text = false;
  std::vector<double> scalar;  ///< the value of an array of one number
  std::string text;            ///< of a short line of text

  std::uint64_t elements() const;  ///< the largest number where they are more than that
};

/// Where the values of a column are: in an array of the file, from an element on, every stride-th.
struct MatColumn {
  std::size_t array = 0;
  std::uint64_t first = 0, stride = 1, count = 0;
};

/// All arrays of a file, by libmatio in a process of its own. Throws InputError where fewer than `variables` can be
/// read.
std::vector<MatArray> describe_mat_file(const InputFile& file, std::size_t variables);

/// The process that answers with the values of columns, which must be in the order of their arrays.
Apart read_mat_columns(const InputFile& file, std::vector<MatColumn> columns);

}  // namespace tribofit
