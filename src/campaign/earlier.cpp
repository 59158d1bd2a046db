#include "tribofit/campaign/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "conditions.hpp"
#include "ingest/raw_table.hpp"
#include "ingest/csv/dialect.hpp"
#include "ingest/csv/text_table.hpp"
#include "tribofit/friction/laws/all.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

/// A quantity that the groups give a value for, in their unit.
struct Known {
  std::string name, unit;
};

struct EarlierColumn {
  enum class Kind { condition, other, law, protocol, value, std_error, none };
  Kind kind = Kind::none;
  std::string title;  ///< as the file gives it
  std::string name;   ///< of the quantity or the condition
  std::string unit;   ///< of conditions; empty: in the cells
  const ConditionInfo* condition = nullptr;
  std::string law, protocol;  ///< said by the name of the column
  double factor = 1;          ///< of values, from the unit of the column to ours
};
using Kind = EarlierColumn::Kind;

/// Names of [D]'s own for what we measure, too.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kAlso = {{{"v_r_amplitude", "amplitude"},
                                                                                 {"fundamental", "frequency"},
                                                                                 {"fundamental_frequency", "frequency"},
                                                                                 {"rms", "rms_velocity"}}};

/// Takes `prefix` and the mark behind it off a name.
bool take_prefix(std::string_view& name, std::string_view prefix) {
  if (!name.starts_with(prefix) || name.size() <= prefix.size() + 1 || name[prefix.size()] != '_') return false;
  name.remove_prefix(prefix.size() + 1);
  return true;
}

/// A unit as it stands in brackets or behind the name: " [s/mm]", "_s_per_mm", "_mm_s". Empty: none; nothing: it is
/// none.
std::optional<std::string> unit_in(std::string_view text) {
  if (text.empty()) return "";
  const std::string_view bare = trimmed(text);
  if (bare.front() == '[' || bare.front() == '(') return strip_brackets(bare);
  if (text.front() != '_') return std::nullopt;
  const std::string unit = replaced(replaced(std::string(text.substr(1)), "_per_", "/"), "_", "/");
  return find_unit(unit) ? std::optional(unit) : std::nullopt;
}

class EarlierReader {
 public:
  EarlierReader(const std::string& path, std::span<const PooledGroup> groups) {
    table_.path = path;
    for (const PooledGroup& group : groups) {
      for (const auto& fit : group.fits) add_known(fit.parameters);
      add_known(group.measures);
      for (const OtherCondition& other : group.others) others_.insert(other.name);
    }
  }

  EarlierTable read() {
    text_ = read_text_table(table_.path,
                            {1 << 26, "is too large for a table of values", "one row for each condition is meant",
                             "begin it with the names of the columns, as in radius_mm,mu_s,mu_k,alpha_s_per_mm"});
    for (const std::string& name : text_.names) columns_.push_back(column_of(name));
    find_long();
    check_columns();
    for (std::size_t row = 0; row < text_.rows.size(); ++row) read_row(row);
    if (table_.values.empty()) refuse("holds no values", "fill in a row for each of the conditions");
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(std::string problem, std::string advice, std::size_t line = 0,
                           std::string column = {}) const {
    throw InputError(std::move(problem), std::move(advice), {table_.path, line, std::move(column)});
  }

  void add_known(const std::vector<PooledValue>& values) {
    for (const PooledValue& value : values) {
      const std::string name = full_name(value.name, value.effect);
      if (find(name) == nullptr) known_.push_back({name, value.unit});
    }
  }

  const Known* find(std::string_view name) const {
    for (const auto& [theirs, ours] : kAlso) name = name == theirs ? ours : name;
    const auto found = std::ranges::find(known_, name, &Known::name);
    return found == known_.end() ? nullptr : &*found;
  }

  std::vector<std::string> names_of_known() const {
    std::vector<std::string> names;
    for (const Known& known : known_) names.push_back(known.name);
    return names;
  }

  /// Factor from `unit` to that of the quantity.
  double factor_to(const Known& quantity, const std::string& unit, std::size_t line, const std::string& column) const {
    const auto no_unit = [&](const std::string& problem) {
      refuse(problem, fmt::format("{} is in {}", quantity.name, quantity.unit), line, column);
    };
    if (unit.empty() && quantity.unit == "1") return 1;
    if (unit.empty()) no_unit("has no unit");
    const auto own = find_unit(quantity.unit), theirs = find_unit(unit);
    if (!theirs) {
      const std::string nearest = suggest_unit(unit);
      no_unit(fmt::format("unknown unit '{}'{}", unit, nearest.empty() ? "" : " (did you mean " + nearest + "?)"));
    }
    if (!own || own->quantity != theirs->quantity)
      no_unit(fmt::format("'{}' is a unit of {}", unit, with_article(to_string(theirs->quantity))));
    return theirs->factor / own->factor;
  }

  /// Makes it a column of values, or of their errors, where its name says so.
  void take_as_value(EarlierColumn& column) const {
    std::string_view rest = column.title;
    EarlierColumn found = column;
    for (const std::string& law : law_keys()) {
      if (take_prefix(rest, law)) found.law = law;
    }
    for (const Protocol protocol : {Protocol::joint, Protocol::published}) {
      if (take_prefix(rest, to_string(protocol))) found.protocol = to_string(protocol);
    }
    std::vector<std::string> names = names_of_known();
    for (const auto& [theirs, ours] : kAlso) names.emplace_back(theirs);
    std::ranges::sort(names, std::ranges::greater(), &std::string::size);
    for (const std::string& name : names) {
      const Known* known = find(name);
      if (known == nullptr || !rest.starts_with(name)) continue;
      std::string_view behind = rest.substr(name.size());
      constexpr std::string_view kError = "_std_error";
      found.kind = behind.starts_with(kError) ? Kind::std_error : Kind::value;
      if (found.kind == Kind::std_error) behind.remove_prefix(kError.size());
      const auto unit = unit_in(behind);
      if (!unit) continue;
      found.name = known->name;
      found.factor = factor_to(*known, *unit, text_.header_line, column.title);
      column = found;
      return;
    }
  }

  void take_as_condition(EarlierColumn& column) const {
    const ColumnName name = parse_column_name(column.title);
    column.condition = find_condition(name.base);
    column.name = column.title;
    if (column.condition != nullptr) {
      column.kind = Kind::condition;
      column.name = column.condition->name;
    } else if (others_.contains(column.title)) {
      column.kind = Kind::other;
    } else if (column.title == "law" || column.title == "protocol") {
      column.kind = column.title == "law" ? Kind::law : Kind::protocol;
    }
    column.unit = name.unit.value_or(names_rpm(name.base) ? "rpm" : "");
  }

  EarlierColumn column_of(const std::string& title) const {
    EarlierColumn column;
    column.title = title;
    if (!others_.contains(title)) take_as_value(column);
    if (column.kind == Kind::none) take_as_condition(column);
    return column;
  }

  /// Where the table has a row a value, the columns that say so.
  void find_long() {
    for (std::size_t k = columns_.size(); k-- > 0;) {
      const EarlierColumn& column = columns_[k];
      if (column.kind != Kind::none) continue;
      if (is_one_of(column.title, {"name", "parameter", "quantity"})) name_ = k;
      if (column.title == "value") value_ = k;
      if (column.title == "unit") unit_ = k;
      if (column.title == "std_error") error_ = k;
    }
  }
  bool is_long() const { return name_ && value_; }

  static bool is_beside(const EarlierColumn& a, const EarlierColumn& b) {
    return a.name == b.name && a.law == b.law && a.protocol == b.protocol;
  }

  void check_columns() {
    const std::size_t line = text_.header_line;
    bool conditions = false, values = is_long();
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const EarlierColumn& column = columns_[k];
      conditions = conditions || column.kind <= Kind::other;
      values = values || column.kind == Kind::value;
      if (column.kind == Kind::none && !is_long()) note_unknown(column.title);
      for (std::size_t j = 0; j < k && column.kind != Kind::none; ++j) {
        if (columns_[j].kind != column.kind || !is_beside(columns_[j], column)) continue;
        refuse(fmt::format("a second column of the same kind as '{}'", columns_[j].title), "keep one of them", line,
               column.title);
      }
    }
    if (!conditions) {
      refuse("there is no column of conditions",
             fmt::format("add {}, {} or {}", condition_infos[0].column, condition_infos[1].column,
                         condition_infos[2].column),
             line);
    }
    if (!values) refuse("there is no column of values", "the runs have " + listed(names_of_known()), line);
  }

  void note_unknown(const std::string& title) {
    if (is_one_of(title, {"", "run", "runs", "file", "repeat", "status", "message", "note", "notes"})) return;
    const std::string nearest = likely_name(title, names_of_known());
    table_.notes.push_back(fmt::format("column {} is not a parameter, measure or condition of these runs{}", title,
                                       nearest.empty() ? "" : " (is it " + nearest + "?)"));
  }

  void read_row(std::size_t at) {
    const std::vector<std::string> cells = text_.cells_of(at);
    EarlierValue row;
    row.line = text_.rows[at].line;
    const bool states_conditions = read_conditions(cells, row);
    const std::size_t before = table_.values.size();
    if (is_long()) {
      read_long(cells, row);
    } else {
      read_wide(cells, row);
    }
    if (table_.values.size() > before && !states_conditions)
      refuse("the row states no conditions", "fill in the radius, the speed or another condition", row.line);
  }

  /// Whether there are any.
  bool read_conditions(const std::vector<std::string>& cells, EarlierValue& row) const {
    bool any = false;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const EarlierColumn& column = columns_[k];
      const std::string& text = cells[k];
      if (text.empty()) continue;
      any = any || column.kind <= Kind::other;
      if (column.kind == Kind::other) row.others.push_back({column.name, text});
      if (column.kind == Kind::law) row.law = text;
      if (column.kind == Kind::protocol) row.protocol = text;
      if (column.kind != Kind::condition) continue;
      try {
        row.conditions.*column.condition->member = {
            condition_in_cell(text_.with_decimal_point(text), *column.condition, column.title, column.unit), "table"};
      } catch (const InputError& error) {
        refuse(error.problem(), error.advice(), row.line, column.title);
      }
    }
    return any;
  }

  /// What stands in a cell, the title of its column, and the factor to our unit.
  struct Cell {
    std::string text, column;
    double factor = 1;
  };

  double number(const Cell& cell, std::size_t line) const {
    const std::string plain = text_.with_decimal_point(cell.text);
    const std::size_t begin = plain.starts_with('+') ? 1 : 0;
    double value = 0;
    const auto [end, error] = std::from_chars(plain.data() + begin, plain.data() + plain.size(), value);
    if (is_number(plain, '.') && error == std::errc{} && std::isfinite(value)) return value;
    if (error == std::errc::result_out_of_range)
      refuse(fmt::format("'{}' is too large for a number", cell.text), "correct it", line, cell.column);
    refuse(fmt::format("'{}' is not a number", cell.text), "write a number, or leave the cell empty", line,
           cell.column);
  }

  /// A value of a row, and its error where its cell is not empty.
  void add(EarlierValue row, const Known& known, const Cell& value, const Cell& error) {
    row.name = known.name;
    row.unit = known.unit;
    row.column = value.column;
    row.value = value.factor * number(value, row.line);
    if (!error.text.empty()) {
      row.std_error = error.factor * number(error, row.line);
      if (row.std_error < 0)
        refuse(fmt::format("'{}' is less than zero", error.text), "a standard error is positive", row.line,
               error.column);
    }
    table_.values.push_back(std::move(row));
  }

  void read_wide(const std::vector<std::string>& cells, const EarlierValue& row) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const EarlierColumn& column = columns_[k];
      if (column.kind != Kind::value || cells[k].empty()) continue;
      EarlierValue value = row;
      if (!column.law.empty()) value.law = column.law;
      if (!column.protocol.empty()) value.protocol = column.protocol;
      Cell error;
      for (std::size_t j = cells.size(); j-- > 0;) {
        const EarlierColumn& other = columns_[j];
        if (other.kind == Kind::std_error && is_beside(other, column)) error = {cells[j], other.title, other.factor};
      }
      add(std::move(value), *find(column.name), {cells[k], column.title, column.factor}, error);
    }
  }

  void read_long(const std::vector<std::string>& cells, const EarlierValue& row) {
    const std::string& name = cells[*name_];
    if (name.empty() || cells[*value_].empty()) return;
    const Known* known = find(name);
    if (known == nullptr) {
      if (unknown_.insert(name).second)
        table_.notes.push_back(
            fmt::format("line {}: '{}' is not a parameter or measure of these runs", row.line, name));
      return;
    }
    const auto cell = [&](std::optional<std::size_t> at) {
      return at ? Cell{cells[*at], columns_[*at].title} : Cell{"", name};
    };
    Cell value = cell(value_), error = cell(error_);
    const Cell unit = cell(unit_);
    value.factor = error.factor = factor_to(*known, unit.text, row.line, unit.column);
    add(row, *known, value, error);
  }

  EarlierTable table_;
  std::vector<Known> known_;
  std::set<std::string> others_;  // conditions of the groups
  TextTable text_;
  std::vector<EarlierColumn> columns_;
  std::optional<std::size_t> name_, value_, unit_, error_;  // of a table with a row a value
  std::set<std::string> unknown_;                           // names in rows
};

}  // namespace

EarlierTable read_earlier(const std::string& path, std::span<const PooledGroup> groups) {
  return EarlierReader(path, groups).read();
}

}  // namespace tribofit
