#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "ingest/content_hash.hpp"
#include "ingest/limits.hpp"
#include "ingest/numbers.hpp"
#include "ingest/raw_table.hpp"
#include "ingest/reader.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

constexpr std::size_t header_lines = 11;

/// The abscissa by its number in the eighth line; 0 and 1 leave it open.
constexpr int unknown_abscissa = 0, general_abscissa = 1, time_abscissa = 17;

/// What a function depends on where that is not the time; empty where it is, or where it may be.
std::string other_abscissa(int type, const std::string& unit) {
  static const std::map<int, const char*> names = {{2, "stress"},
                                                   {3, "strain"},
                                                   {5, "temperature"},
                                                   {6, "heat flux"},
                                                   {8, "displacement"},
                                                   {9, "reaction force"},
                                                   {11, "velocity"},
                                                   {12, "acceleration"},
                                                   {13, "excitation force"},
                                                   {15, "pressure"},
                                                   {16, "mass"},
                                                   {18, "frequency"},
                                                   {19, "rpm"},
                                                   {20, "order"},
                                                   {21, "sound pressure"},
                                                   {22, "sound intensity"},
                                                   {23, "sound power"}};
  const bool is_open = type == unknown_abscissa || type == general_abscissa;
  if (!is_open && type != time_abscissa) {
    const auto name = names.find(type);
    return name != names.end() ? name->second : fmt::format("an abscissa of type {}", type);
  }
  const auto known = find_unit(unit);
  if (unit.empty() || !known || find_unit(unit, Quantity::time)) return "";
  return is_open || known->quantity == Quantity::frequency ? std::string(to_string(known->quantity)) : "";
}

bool is_mark(std::string_view line) {
  return trimmed(line) == "-1";
}

/// What stands in columns [begin, begin + width) of a line.
std::string_view field(std::string_view line, std::size_t begin, std::size_t width) {
  return begin < line.size() ? trimmed(line.substr(begin, width)) : std::string_view();
}

/// A text of the file; "NONE" stands for none.
std::string label(std::string_view text) {
  const std::string result(trimmed(text));
  return lower_case(result) == "none" ? std::string() : result;
}

/// A dataset of values: "    58b     1     2          11      317168 ..." and the eleven lines above the values.
struct Function {
  bool binary = false, big_endian = false;
  int format = 2;           // of floating point numbers: 2 is IEEE 754
  std::uint64_t bytes = 0;  // of the values
  std::string title, response;
  int type = 2;  // of the values: 2 and 4 real, 5 and 6 complex; 4 and 6 of double precision
  std::uint64_t count = 0;
  bool even = true;
  double start = 0, interval = 0;
  int abscissa = 0;
  std::string abscissa_unit, ordinate, unit;

  bool is_complex() const { return type == 5 || type == 6; }
  bool is_double() const { return type == 4 || type == 6; }
};

class File {
 public:
  File(const InputFile& file, RawTable& table) : path_(file.path()), table_(table) {
    bytes_ = file.read_text(0, file.size());
    table_.rows.clear();
  }

  void read() {
    while (find_mark()) {
      dataset_at_ = at_;
      const std::string_view head = line();
      ++datasets_;
      if (number<int>(field(head, 0, 6), "the number of the dataset") == 58) {
        read_function(head);
      } else {
        ++others_;
      }
      find_mark();
    }
    if (others_ > 0)
      skipped_.push_back(fmt::format("{} dataset{} of another number", others_, others_ == 1 ? "" : "s"));
    const std::string skipped = listed(skipped_, kMostNamed);
    if (!skipped.empty()) table_.notes.push_back("not read: " + skipped);
    if (!table_.columns.empty()) return;
    throw InputError("holds no real function of time" + (skipped.empty() ? "" : ": " + skipped),
                     "export the time histories as dataset 58", {path_, 0, ""});
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const {
    throw InputError(fmt::format("byte {}, in dataset {} (from byte {}): {}", at_, datasets_, dataset_at_, problem),
                     "the file is cut off or damaged; export it again", {path_, 0, ""});
  }

  std::string_view line() {
    const std::size_t begin = at_, end = std::min(bytes_.find('\n', at_), bytes_.size());
    at_ = std::min(end + 1, bytes_.size());
    std::string_view text = std::string_view(bytes_).substr(begin, end - begin);
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return text;
  }

  /// Goes behind the next mark, which begins or ends a dataset; false at the end of the file.
  bool find_mark() {
    while (at_ < bytes_.size()) {
      if (is_mark(line())) return at_ < bytes_.size();
    }
    return false;
  }

  template <class Number>
  Number number(std::string_view text, const char* what) const {
    std::string word(text);
    std::replace(word.begin(), word.end(), 'D', 'E');  // of Fortran
    if (word.starts_with('+')) word.erase(0, 1);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size())
      refuse(fmt::format("{} is '{}', not a number", what, text));
    return value;
  }

  Function header(std::string_view head) {
    Function f;
    f.binary = head.size() > 6 && lower_case(head.substr(6, 1)) == "b";
    std::uint64_t lines_above = header_lines;
    if (f.binary) {
      f.big_endian = number<int>(field(head, 7, 6), "the order of bytes") == 2;
      f.format = number<int>(field(head, 13, 6), "the format of numbers");
      lines_above = number<std::uint64_t>(field(head, 19, 12), "the number of lines");
      f.bytes = number<std::uint64_t>(field(head, 31, 12), "the number of bytes");
    }
    std::vector<std::string_view> lines;
    for (std::size_t i = 0; i < header_lines; ++i) {
      if (at_ >= bytes_.size()) refuse("the lines above the values are cut off");
      lines.push_back(line());
    }
    f.title = label(lines[0]);
    f.response = label(field(lines[5], 31, 10));
    f.type = number<int>(field(lines[6], 0, 10), "the type of the values");
    f.count = number<std::uint64_t>(field(lines[6], 10, 10), "the number of values");
    f.even = number<int>(field(lines[6], 20, 10), "the spacing") == 1;
    f.start = number<double>(field(lines[6], 30, 13), "the first abscissa");
    f.interval = number<double>(field(lines[6], 43, 13), "the increment");
    f.abscissa = number<int>(field(lines[7], 0, 10), "the type of the abscissa");
    f.abscissa_unit = label(field(lines[7], 47, 20));
    f.ordinate = label(field(lines[8], 26, 20));
    f.unit = label(field(lines[8], 47, 20));
    const std::string below = label(field(lines[9], 47, 20));
    if (!below.empty()) f.unit = (f.unit.empty() ? "1" : f.unit) + "/(" + below + ")";
    if (f.type != 2 && f.type != 4 && !f.is_complex()) refuse(fmt::format("values of type {}", f.type));
    if (lines_above != header_lines)
      refuse(fmt::format("{} lines above the values, not {}", lines_above, header_lines));
    if (f.bytes > bytes_.size() - at_)
      refuse(fmt::format("{} bytes of values, of which {} are there", f.bytes, bytes_.size() - at_));
    return f;
  }

  void read_function(std::string_view head) {
    const Function f = header(head);
    const std::string depends_on = other_abscissa(f.abscissa, f.abscissa_unit);
    const std::string why = f.is_complex()              ? "complex"
                            : depends_on == "frequency" ? "a spectrum"
                            : !depends_on.empty()       ? "a function of " + depends_on + ", not of time"
                            : columns_ == kMostColumns  ? "more columns than can be channels"
                                                        : "";
    if (!why.empty()) {
      skipped_.push_back(fmt::format("'{}' ({})", f.title, why));
      at_ += static_cast<std::size_t>(f.bytes);
      return;
    }
    if (f.format != 2) refuse(fmt::format("numbers of format {}, not IEEE 754", f.format));
    if (f.count > bytes_.size()) refuse(fmt::format("{} values in a file of {} bytes", f.count, bytes_.size()));
    if (f.even && !(f.interval > 0 && std::isfinite(f.interval) && std::isfinite(f.start))) {
      refuse(fmt::format("an increment of {}", general(f.interval)));
    }
    std::vector<double> abscissa, ordinate;
    f.binary ? binary_values(f, abscissa, ordinate) : text_values(f, abscissa, ordinate);
    add(f, std::move(abscissa), std::move(ordinate));
  }

  void binary_values(const Function& f, std::vector<double>& abscissa, std::vector<double>& ordinate) {
    const std::size_t size = f.is_double() ? 8 : 4;
    const bool wide = f.is_double() && f.bytes >= f.count * 16;  // writers differ in the precision of the abscissa
    const std::size_t before = f.even ? 0 : wide ? 8 : 4;
    if (f.bytes / (before + size) < f.count) {
      refuse(fmt::format("{} values in {} bytes", f.count, f.bytes));
    }
    const std::string_view view(bytes_);
    const auto value = [&](std::size_t at, std::size_t width) {
      return width == 8 ? number_at<double>(view, at, f.big_endian)
                        : static_cast<double>(number_at<float>(view, at, f.big_endian));
    };
    for (std::size_t i = 0; i < f.count; ++i) {
      const std::size_t at = at_ + i * (before + size);
      if (before > 0) abscissa.push_back(value(at, before));
      ordinate.push_back(value(at + before, size));
    }
    at_ += static_cast<std::size_t>(f.bytes);
  }

  void text_values(const Function& f, std::vector<double>& abscissa, std::vector<double>& ordinate) {
    const std::uint64_t wanted = f.even ? f.count : 2 * f.count;
    for (std::uint64_t done = 0; done < wanted;) {
      const std::size_t begin = at_;
      std::string text(at_ < bytes_.size() ? line() : std::string_view());
      if (begin >= bytes_.size() || is_mark(text)) {
        at_ = begin;
        refuse(fmt::format("{} of {} values are there", f.even ? done : done / 2, f.count));
      }
      std::replace(text.begin(), text.end(), 'D', 'E');
      const char *at = text.data(), *end = at + text.size();
      while (done < wanted) {
        while (at != end && (*at == ' ' || *at == '+')) ++at;
        if (at == end) break;
        double value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc{}) {
          at_ = begin + static_cast<std::size_t>(at - text.data());
          refuse(fmt::format("'{}' is not a number",
                             std::string_view(at, static_cast<std::size_t>(end - at)).substr(0, 20)));
        }
        at = next;
        (f.even || done % 2 == 1 ? ordinate : abscissa).push_back(value);
        ++done;
      }
    }
  }

  void add(const Function& f, std::vector<double> abscissa, std::vector<double> ordinate) {
    RawColumn column;
    const bool known = is_field_name(parse_column_name(f.title).base);
    const bool by_ordinate = f.title.empty() || (!known && is_field_name(parse_column_name(f.ordinate).base));
    column.name = by_ordinate ? f.ordinate : f.title;
    if (column.name.empty()) column.name = f.response;
    column.named = !column.name.empty();
    if (!column.named) column.name = fmt::format("#{}", table_.columns.size() + 1);
    column.place = by_ordinate && !f.title.empty() ? f.title : "";
    column.unit = f.unit;
    column.count = ordinate.size();
    column.rows = f.even ? even_rows(f) : uneven_rows(f, abscissa);
    column.numbers = std::move(ordinate);
    table_.columns.push_back(std::move(column));
    ++columns_;
  }

  /// Functions of one spacing share rows; those of uneven spacing have the abscissa as a column of their own.
  std::size_t even_rows(const Function& f) {
    const bool stated = !f.abscissa_unit.empty();
    const std::optional<Unit> seconds = Unit{Quantity::time, 1, 0};
    const auto unit = stated                        ? find_unit(f.abscissa_unit, Quantity::time)
                      : f.abscissa == time_abscissa ? seconds
                                                    : std::nullopt;
    const double factor = unit ? unit->factor : -1;  // those of an unknown unit share rows of their own
    const auto [at, is_new] = rows_.emplace(std::tuple(f.count, f.start * factor, f.interval * factor), 0);
    if (!is_new) return at->second;
    at->second = add_rows();
    if (unit) {
      table_.rows[at->second].interval = f.interval * factor;
      table_.rows[at->second].start = f.start * factor;
    } else {
      table_.notes.push_back(fmt::format(
          "'{}' states an increment of {} {}: state the sampling rate with {}", f.title, general(f.interval),
          stated ? fmt::format("in '{}', which is no known unit of time", f.abscissa_unit)
                 : "of an unknown abscissa without a unit",
          setting("rate")));
    }
    return at->second;
  }

  std::size_t uneven_rows(const Function& f, std::vector<double>& abscissa) {
    const std::string unit = f.abscissa_unit.empty() && f.abscissa == time_abscissa ? "s" : f.abscissa_unit;
    const std::string_view bytes(reinterpret_cast<const char*>(abscissa.data()), abscissa.size() * sizeof(double));
    const auto [known, is_new] = times_.emplace(xxh64(unit, xxh64(bytes)), table_.columns.size());
    if (!is_new && table_.columns[known->second].numbers == abscissa) return table_.columns[known->second].rows;
    RawColumn time;
    time.name = "time";
    time.unit = unit;
    time.place = f.title;
    time.rows = add_rows();
    time.count = abscissa.size();
    time.numbers = std::move(abscissa);
    table_.columns.push_back(std::move(time));
    return table_.columns.back().rows;
  }

  std::size_t add_rows() {
    table_.rows.emplace_back();
    return table_.rows.size() - 1;
  }

  std::string path_, bytes_;
  RawTable& table_;
  std::size_t at_ = 0, dataset_at_ = 0, datasets_ = 0, others_ = 0;
  std::size_t columns_ = 0;                     // of functions
  std::map<std::uint64_t, std::size_t> times_;  // columns of abscissas, by their content
  std::vector<std::string> skipped_;
  std::map<std::tuple<std::uint64_t, double, double>, std::size_t> rows_;  // of even spacing: count, start, interval
};

/// A mark alone in the first line that says something, then the number of a dataset.
bool is_universal_file(std::string_view head) {
  bool marked = false;
  for (std::size_t at = 0; at < head.size();) {
    const std::size_t end = std::min(head.find('\n', at), head.size());
    const std::string_view text = trimmed(head.substr(at, end - at));
    at = end + 1;
    if (text.empty()) continue;
    if (!marked) {
      if (text != "-1") return false;
      marked = true;
      continue;
    }
    const std::string_view number = text.substr(0, std::min(text.find_first_not_of("0123456789"), text.size()));
    const std::string_view rest = text.substr(number.size());
    return !number.empty() && number.size() <= 4 && (rest.empty() || rest.front() == 'b' || rest.front() == 'B');
  }
  return false;
}

RawTable read_universal_file(std::shared_ptr<const InputFile> file) {
  RawTable table;
  table.path = file->path();
  File(*file, table).read();
  return table;
}

}  // namespace

/// Universal files (UFF), datasets 58 and 58b: real functions of time, as text or binary of either order of bytes,
/// evenly spaced or not. Each is a column, named by its first line or its ordinate; those of the same spacing share
/// rows. Other datasets, complex functions and functions of anything but time (spectra, orders, ...) are named and not
/// read. An abscissa that states neither that it is time nor a unit of time gives no rate: the user states it.
///
/// After "Universal Dataset Number 58: Function at Nodal DOF" (SDRC, University of Cincinnati), whose binary form 58b
/// has the same eleven lines of text and then the values.
const Reader uff_reader = {"UFF 58", is_universal_file, read_universal_file};

}  // namespace tribofit
