#include "tribofit/campaign/earlier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "earlier_columns.hpp"
#include "ingest/csv/dialect.hpp"
#include "ingest/csv/text_table.hpp"
#include "ingest/manifest_roles.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

constexpr const char* kExample = "as in radius_mm,mu_s,mu_k,alpha_s_per_mm";

class EarlierReader {
 public:
  EarlierReader(const std::string& path, std::span<const PooledGroup> groups) : columns_(path, groups) {
    table_.path = path;
  }

  EarlierTable read() {
    const std::string advice = std::string("begin it with the names of the columns, ") + kExample;
    text_ = read_text_table(
        table_.path, {1 << 26, "is too large for a table of values", "one row for each condition is meant", advice});
    std::vector<std::string> titles;
    for (const RawColumn& column : text_.table.columns) {
      if (column.named) titles.push_back(column.name);
    }
    columns_.read(titles, text_.header_line());
    table_.notes = columns_.notes();
    for (std::size_t row = 0; row < text_.rows(); ++row) read_row(row);
    if (table_.values.empty()) refuse("holds no values", "fill in a row for each of the conditions");
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(std::string problem, std::string advice, std::size_t line = 0,
                           std::string column = {}) const {
    throw InputError(std::move(problem), std::move(advice), {table_.path, line, std::move(column)});
  }

  void read_row(std::size_t at) {
    const std::vector<std::string> cells = text_.cells_of(at);
    EarlierValue row;
    row.line = text_.line_of(at);
    read_conditions(cells, row);
    const std::size_t before = table_.values.size();
    if (columns_.is_long()) {
      read_long(cells, row);
    } else {
      read_wide(cells, row);
    }
    if (table_.values.size() > before && !states_conditions(row)) {
      refuse("the row states no conditions", "fill in the radius, the speed or another condition", row.line);
    }
  }

  static bool states_conditions(const EarlierValue& row) {
    return row.conditions.radius.known() || row.conditions.speed.known() || row.conditions.load.known() ||
           !row.others.empty();
  }

  void read_conditions(const std::vector<std::string>& cells, EarlierValue& row) const {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const EarlierColumn& column = columns_[k];
      if (cells[k].empty()) continue;
      const std::string& text = cells[k];
      using Kind = EarlierColumn::Kind;
      if (column.kind == Kind::radius) row.conditions.radius = condition(text, column, Role::radius, row.line);
      if (column.kind == Kind::speed) row.conditions.speed = condition(text, column, Role::speed, row.line);
      if (column.kind == Kind::load) row.conditions.load = condition(text, column, Role::load, row.line);
      if (column.kind == Kind::other) row.others.push_back({column.name, text});
      if (column.kind == Kind::law) row.law = text;
      if (column.kind == Kind::protocol) row.protocol = text;
    }
  }

  Condition condition(const std::string& text, const EarlierColumn& column, Role role, std::size_t line) const {
    try {
      return {condition_in_cell(text_.with_decimal_point(text), role, column.title, column.unit), "table"};
    } catch (const InputError& error) {
      refuse(error.problem(), error.advice(), line, column.title);
    }
  }

  double number(const std::string& text, std::size_t line, const std::string& column) const {
    const std::string plain = text_.with_decimal_point(text);
    const std::size_t begin = plain.starts_with('+') ? 1 : 0;
    double value = 0;
    const auto [end, error] = std::from_chars(plain.data() + begin, plain.data() + plain.size(), value);
    if (is_number(plain, '.') && error == std::errc{} && std::isfinite(value)) return value;
    if (error == std::errc::result_out_of_range) {
      refuse(fmt::format("'{}' is too large for a number", text), "correct it", line, column);
    }
    refuse(fmt::format("'{}' is not a number", text), "write a number, or leave the cell empty", line, column);
  }

  double std_error(const std::string& text, std::size_t line, const std::string& column) const {
    const double value = number(text, line, column);
    if (value < 0) refuse(fmt::format("'{}' is less than zero", text), "a standard error is positive", line, column);
    return value;
  }

  void read_wide(const std::vector<std::string>& cells, const EarlierValue& row) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const EarlierColumn& column = columns_[k];
      if (column.kind != EarlierColumn::Kind::value || cells[k].empty()) continue;
      EarlierValue value = row;
      value.name = column.name;
      value.unit = column.own_unit;
      if (!column.law.empty()) value.law = column.law;
      if (!column.protocol.empty()) value.protocol = column.protocol;
      value.column = column.title;
      value.value = column.factor * number(cells[k], row.line, column.title);
      if (const auto error = columns_.error_of(k); error && !cells[*error].empty()) {
        value.std_error = columns_[*error].factor * std_error(cells[*error], row.line, columns_[*error].title);
      }
      table_.values.push_back(std::move(value));
    }
  }

  void read_long(const std::vector<std::string>& cells, EarlierValue value) {
    const LongColumns& at = columns_.long_columns();
    const std::string& name = cells[at.name];
    if (name.empty() || cells[at.value].empty()) return;
    const auto known = columns_.find(name);
    if (!known) {
      if (unknown_.insert(name).second) {
        table_.notes.push_back(
            fmt::format("line {}: '{}' is not a parameter or measure of these runs", value.line, name));
      }
      return;
    }
    value.name = known->name;
    value.unit = known->unit;
    value.column = columns_[at.value].title;
    const std::string unit = at.unit ? cells[*at.unit] : "";
    const double factor = columns_.factor_to(*known, unit, value.line, at.unit ? columns_[*at.unit].title : name);
    value.value = factor * number(cells[at.value], value.line, value.column);
    if (at.std_error && !cells[*at.std_error].empty()) {
      value.std_error = factor * std_error(cells[*at.std_error], value.line, columns_[*at.std_error].title);
    }
    table_.values.push_back(std::move(value));
  }

  EarlierTable table_;
  EarlierColumns columns_;
  TextTable text_;
  std::set<std::string> unknown_;  // names in rows
};

}  // namespace

EarlierTable read_earlier(const std::string& path, std::span<const PooledGroup> groups) {
  return EarlierReader(path, groups).read();
}

}  // namespace tribofit
