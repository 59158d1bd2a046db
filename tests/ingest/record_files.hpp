#pragma once

#include <fmt/format.h>
#include <matio.h>
#include <zlib.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tribofit::record_files {

/// One record as the formats of laboratories hold it, written byte by byte from their descriptions (7.3 by libmatio).

struct Column {
  std::string name, unit;
  std::vector<double> values;
};
using Columns = std::vector<Column>;  // the first is the time [s]

template <class Number>
std::string bytes_of(Number value, bool big_endian = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big_endian != (std::endian::native == std::endian::big)) return {bytes.rbegin(), bytes.rend()};
  return bytes;
}

inline std::string text_of(const Columns& columns, char separator, const char* number = "{:.15g}") {
  std::string text;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    text += (k > 0 ? std::string(1, separator) : "") + columns[k].name + "[" + columns[k].unit + "]";
  }
  text += "\n";
  for (std::size_t i = 0; i < columns.front().values.size(); ++i) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      text += (k > 0 ? std::string(1, separator) : "") + fmt::format(fmt::runtime(number), columns[k].values[i]);
    }
    text += "\n";
  }
  return text;
}

namespace mat5 {

inline std::string padded(std::string bytes) {
  bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
  return bytes;
}

inline std::string element(std::uint32_t type, const std::string& bytes, bool big = false) {
  return bytes_of(type, big) + bytes_of(static_cast<std::uint32_t>(bytes.size()), big) + padded(bytes);
}

/// An array: class 6 is double, 2 a structure, 1 cells, 4 text; `inside` the elements below its name.
inline std::string array(const std::string& name, std::uint32_t type, std::int32_t rows, std::int32_t columns,
                         const std::string& inside, bool big = false) {
  return element(14,
                 element(6, bytes_of(type, big) + bytes_of(std::uint32_t{0}, big), big) +
                     element(5, bytes_of(rows, big) + bytes_of(columns, big), big) + element(1, name, big) + inside,
                 big);
}

inline std::string numbers(const std::vector<double>& values, bool big = false) {
  std::string bytes;
  for (const double value : values) bytes += bytes_of(value, big);
  return element(9, bytes, big);
}

inline std::string vector(const std::string& name, const std::vector<double>& values, bool big = false,
                          bool row = false) {
  const auto count = static_cast<std::int32_t>(values.size());
  return array(name, 6, row ? 1 : count, row ? count : 1, numbers(values, big), big);
}

inline std::string header(bool big = false, std::uint16_t version = 0x0100) {
  std::string text = "MATLAB 5.0 MAT-file, written by a test";
  text.resize(116, ' ');
  text.resize(124, '\0');
  return text + bytes_of(version, big) + (big ? "MI" : "IM");
}

inline std::string compressed(const std::string& variable) {
  uLongf size = compressBound(static_cast<uLong>(variable.size()));
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(variable.data()),
           static_cast<uLong>(variable.size()));
  packed.resize(size);
  return bytes_of(std::uint32_t{15}) + bytes_of(static_cast<std::uint32_t>(packed.size())) + packed;
}

}  // namespace mat5

inline std::string mat5_of(const Columns& columns, bool big = false, bool packed = false) {
  std::string file = mat5::header(big);
  for (const Column& column : columns) {
    const std::string variable = mat5::vector(column.name, column.values, big);
    file += packed ? mat5::compressed(variable) : variable;
  }
  return file;
}

inline void write_mat73(const std::string& path, const Columns& columns) {
  mat_t* mat = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT73);
  for (const Column& column : columns) {
    std::size_t sizes[] = {1, column.values.size()};
    matvar_t* variable = Mat_VarCreate(column.name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, sizes,
                                       const_cast<double*>(column.values.data()), 0);
    Mat_VarWrite(mat, variable, MAT_COMPRESSION_ZLIB);
    Mat_VarFree(variable);
  }
  Mat_Close(mat);
}

/// The lines of text above the values of a dataset 58; an interval of 0 is uneven spacing.
inline std::string uff_header(const Column& column, double interval, int type) {
  std::string text = column.name + "\nNONE\n01-Jan-26 12:00:00\nNONE\nNONE\n";
  text += "    1         0    0         0 NONE               0   0 NONE               0   0\n";
  text += fmt::format("{:10}{:10}{:10}{:13.5E}{:13.5E}{:13.5E}\n", type, column.values.size(), interval > 0 ? 1 : 0,
                      0.0, interval, 0.0);
  const auto axis = [](int kind, const char* label, const std::string& unit) {
    return fmt::format("{:10}{:5}{:5}{:5} {:20} {:20}\n", kind, 0, 0, 0, label, unit);
  };
  return text + axis(17, "Time", "s") + axis(0, "NONE", column.unit) + axis(0, "NONE", "NONE") +
         axis(0, "NONE", "NONE");
}

/// Each column but the time as a function of it: evenly spaced, or with its abscissa.
inline std::string uff_of(const Columns& columns, double interval = 0) {
  std::string file;
  for (std::size_t k = 1; k < columns.size(); ++k) {
    file += "    -1\n    58\n" + uff_header(columns[k], interval, 4);
    for (std::size_t i = 0; i < columns[k].values.size(); ++i) {
      if (interval == 0) file += fmt::format("{:13.5E}", columns[0].values[i]);
      file += fmt::format("{:20.12E}", columns[k].values[i]);
      const std::size_t in_line = interval == 0 ? 2 : 4;
      if (i % in_line == in_line - 1 || i + 1 == columns[k].values.size()) file += "\n";
    }
    file += "    -1\n";
  }
  return file;
}

inline std::string uff_binary_of(const Columns& columns, double interval = 0, bool big = false) {
  std::string file;
  for (std::size_t k = 1; k < columns.size(); ++k) {
    std::string values;
    for (std::size_t i = 0; i < columns[k].values.size(); ++i) {
      if (interval == 0) values += bytes_of(columns[0].values[i], big);
      values += bytes_of(columns[k].values[i], big);
    }
    file += "    -1\n" +
            fmt::format("    58b{:6}{:6}{:12}{:12}{:6}{:6}{:12}{:12}\n", big ? 2 : 1, 2, 11, values.size(), 0, 0, 0, 0);
    file += uff_header(columns[k], interval, 4) + values + "    -1\n";
  }
  return file;
}

namespace tdms {

constexpr std::uint32_t metadata = 2, new_list = 4, raw_data = 8, interleaved = 32, big_endian = 64;

inline std::string text(const std::string& value, bool big = false) {
  return bytes_of(static_cast<std::uint32_t>(value.size()), big) + value;
}

inline std::string property(const std::string& name, const std::string& value, bool big = false) {
  return text(name, big) + bytes_of(std::uint32_t{0x20}, big) + text(value, big);
}

inline std::string property(const std::string& name, double value, bool big = false) {
  return text(name, big) + bytes_of(std::uint32_t{10}, big) + bytes_of(value, big);
}

/// A channel of `count` values of a type in each chunk.
inline std::string channel(const std::string& name, std::uint32_t type, std::uint64_t count,
                           const std::vector<std::string>& properties = {}, bool big = false) {
  std::string bytes = text("/'rig'/'" + name + "'", big) + bytes_of(std::uint32_t{20}, big) + bytes_of(type, big) +
                      bytes_of(std::uint32_t{1}, big) + bytes_of(count, big) +
                      bytes_of(static_cast<std::uint32_t>(properties.size()), big);
  for (const std::string& one : properties) bytes += one;
  return bytes;
}

inline std::string segment(std::uint32_t mask, const std::string& described, const std::string& raw) {
  const bool big = (mask & big_endian) != 0;
  return "TDSm" + bytes_of(mask) + bytes_of(std::uint32_t{4713}, big) +
         bytes_of(static_cast<std::uint64_t>(described.size() + raw.size()), big) +
         bytes_of(static_cast<std::uint64_t>(described.size()), big) + described + raw;
}

}  // namespace tdms

inline std::string tdms_of(const Columns& columns, bool big = false, bool interleaved = false) {
  std::string described = bytes_of(static_cast<std::uint32_t>(columns.size()), big), raw;
  for (const Column& column : columns) {
    const std::vector<std::string> unit = {tdms::property("unit_string", column.unit, big)};
    described += tdms::channel(column.name, 10, column.values.size(), unit, big);
  }
  const std::size_t rows = columns.front().values.size();
  if (interleaved) {
    for (std::size_t i = 0; i < rows; ++i) {
      for (const Column& column : columns) raw += bytes_of(column.values[i], big);
    }
  } else {
    for (const Column& column : columns) {
      for (const double value : column.values) raw += bytes_of(value, big);
    }
  }
  const std::uint32_t mask = tdms::metadata | tdms::new_list | tdms::raw_data | (big ? tdms::big_endian : 0U) |
                             (interleaved ? tdms::interleaved : 0U);
  return tdms::segment(mask, described, raw);
}

}  // namespace tribofit::record_files
