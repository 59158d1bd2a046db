#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "numbers.hpp"
#include "reader.hpp"

namespace tribofit {

/// A binary format of the tests' own, by which the seam for readers is tried without CSV: a signature, then facts, sets
/// of rows and columns, each as a count and that many; texts as a length and bytes; numbers in the order of this
/// machine.
namespace binary_format {

inline constexpr std::string_view signature = "\x01LABREC";

/// Puts numbers, in the order of this machine, and texts into bytes.
class Writer {
 public:
  explicit Writer(std::string_view begin = {}) : bytes_(begin) {}

  template <class Number>
  Writer& number(Number value) {
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
    return *this;
  }
  Writer& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// The bytes of a file with these columns, facts and rows.
inline std::string bytes_of(const RawTable& table) {
  Writer out(signature);
  out.number(static_cast<std::uint32_t>(table.facts.size()));
  for (const RawFact& fact : table.facts) out.text(fact.name).text(fact.value);
  out.number(static_cast<std::uint32_t>(table.rows.size()));
  for (const RawRows& rows : table.rows) {
    out.number(rows.interval.value_or(0)).number(rows.start).number(static_cast<std::uint32_t>(rows.steps.size()));
    for (const RawStep& step : rows.steps) {
      out.number(static_cast<std::uint64_t>(step.begin)).text(step.label).number(step.conditions.radius.value);
    }
  }
  out.number(static_cast<std::uint32_t>(table.columns.size()));
  for (const RawColumn& column : table.columns) {
    out.text(column.name).text(column.unit).text(column.place).number(static_cast<std::uint32_t>(column.rows));
    out.number(static_cast<std::uint8_t>(column.is_text ? 1 : 0));
    out.number(static_cast<std::uint64_t>(column.numbers.size()));
    for (const double value : column.numbers) out.number(value);
  }
  return out.bytes();
}

class Parser {
 public:
  explicit Parser(const InputFile& file) : path_(file.path()), bytes_(bytes_of(file), cut_off(file)) {
    bytes_.skip(signature.size());
  }

  RawTable parse() {
    RawTable table;
    table.path = path_;
    for (auto n = number<std::uint32_t>(); n > 0; --n) {
      std::string name = text(), value = text();
      table.facts.push_back({std::move(name), std::move(value)});
    }
    table.rows.clear();
    for (auto n = number<std::uint32_t>(); n > 0; --n) table.rows.push_back(rows());
    for (auto n = number<std::uint32_t>(); n > 0; --n) table.columns.push_back(column());
    return table;
  }

 private:
  static std::string bytes_of(const InputFile& file) {
    std::string bytes(static_cast<std::size_t>(file.size()), '\0');
    bytes.resize(file.read(0, bytes));
    return bytes;
  }
  static ByteCursor::CutOff cut_off(const InputFile& file) {
    return [path = file.path(), size = file.size()](std::uint64_t, std::uint64_t) {
      throw InputError("is cut off at byte " + std::to_string(size), "copy the file again", {path, 0, ""});
    };
  }
  template <class Number>
  Number number() {
    return bytes_.number<Number>(native_big_endian);
  }
  std::string text() { return bytes_.text(native_big_endian); }
  RawRows rows() {
    RawRows result;
    const auto interval = number<double>();
    if (interval != 0) result.interval = interval;
    result.start = number<double>();
    for (auto n = number<std::uint32_t>(); n > 0; --n) {
      RawStep step;
      step.begin = number<std::uint64_t>();
      step.label = text();
      step.conditions.radius = {number<double>(), "file"};
      result.steps.push_back(std::move(step));
    }
    return result;
  }
  RawColumn column() {
    RawColumn result;
    result.name = text();
    result.unit = text();
    result.place = text();
    result.rows = number<std::uint32_t>();
    result.is_text = number<std::uint8_t>() != 0;
    const auto count = number<std::uint64_t>();
    bytes_.need(count, 8);
    for (std::uint64_t i = 0; i < count; ++i) result.numbers.push_back(number<double>());
    return result;
  }

  std::string path_;
  ByteCursor bytes_;
};

inline const Reader reader = {"LABREC", [](std::string_view head) { return head.starts_with(signature); },
                              [](std::shared_ptr<const InputFile> file) { return Parser(*file).parse(); }};

}  // namespace binary_format
}  // namespace tribofit
