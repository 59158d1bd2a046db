#include "earlier_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "ingest/column_names.hpp"
#include "ingest/manifest_roles.hpp"
#include "tribofit/campaign/earlier.hpp"
#include "tribofit/friction/laws/all.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

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

bool has(const std::vector<std::string>& list, std::string_view text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

}  // namespace

EarlierColumns::EarlierColumns(std::string path, std::span<const PooledGroup> groups) : path_(std::move(path)) {
  const auto add = [&](const PooledValue& value) {
    if (!find(full_name(value.name, value.effect))) known_.push_back({full_name(value.name, value.effect), value.unit});
  };
  for (const PooledGroup& group : groups) {
    for (const auto& fit : group.fits) {
      if (!has(laws_, fit.law)) laws_.push_back(fit.law);
      for (const PooledValue& value : fit.parameters) add(value);
    }
    for (const PooledValue& value : group.measures) add(value);
    for (const OtherCondition& other : group.others) {
      if (!has(others_, other.name)) others_.push_back(other.name);
    }
  }
}

std::optional<KnownQuantity> EarlierColumns::find(std::string_view name) const {
  for (const auto& [theirs, ours] : kAlso) {
    if (name == theirs) return find(ours);
  }
  const auto found = std::find_if(known_.begin(), known_.end(), [&](const KnownQuantity& q) { return q.name == name; });
  return found == known_.end() ? std::nullopt : std::optional(*found);
}

double EarlierColumns::factor_to(const KnownQuantity& quantity, const std::string& unit, std::size_t line,
                                 const std::string& column) const {
  const auto refuse = [&](std::string problem) {
    throw InputError(std::move(problem), fmt::format("{} is in {}", quantity.name, quantity.unit),
                     {path_, line, column});
  };
  if (unit.empty()) {
    if (quantity.unit != "1") refuse("has no unit");
    return 1;
  }
  const auto own = find_unit(quantity.unit);
  const auto theirs = find_unit(unit);
  if (!theirs) {
    const std::string nearest = suggest_unit(unit);
    refuse(fmt::format("unknown unit '{}'{}", unit, nearest.empty() ? "" : " (did you mean " + nearest + "?)"));
  }
  if (!own || own->quantity != theirs->quantity) {
    refuse(fmt::format("'{}' is a unit of {}", unit, with_article(to_string(theirs->quantity))));
  }
  return theirs->factor / own->factor;
}

std::optional<EarlierColumn> EarlierColumns::value_column(const std::string& title, std::size_t line) const {
  EarlierColumn column;
  column.title = title;
  std::string_view rest = title;
  for (const std::string& law : law_keys()) {
    if (take_prefix(rest, law)) column.law = law;
  }
  for (const Protocol protocol : {Protocol::joint, Protocol::published}) {
    if (take_prefix(rest, to_string(protocol))) column.protocol = to_string(protocol);
  }
  std::vector<std::string> names;
  for (const KnownQuantity& known : known_) names.push_back(known.name);
  for (const auto& [theirs, ours] : kAlso) names.emplace_back(theirs);
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) { return a.size() > b.size(); });
  for (const std::string& name : names) {
    const auto known = find(name);
    if (!known || !rest.starts_with(name)) continue;
    std::string_view behind = rest.substr(name.size());
    constexpr std::string_view kError = "_std_error";
    column.kind = behind.starts_with(kError) ? Kind::std_error : Kind::value;
    if (column.kind == Kind::std_error) behind.remove_prefix(kError.size());
    const auto unit = unit_in(behind);
    if (!unit) continue;
    column.name = known->name;
    column.own_unit = known->unit;
    column.factor = factor_to(*known, *unit, line, title);
    return column;
  }
  return std::nullopt;
}

std::optional<EarlierColumn> EarlierColumns::condition_column(const std::string& title) const {
  EarlierColumn column;
  column.title = column.name = title;
  const ColumnName name = parse_column_name(title);
  switch (role_of(name)) {
    case Role::radius:
      column.kind = Kind::radius;
      break;
    case Role::speed:
      column.kind = Kind::speed;
      break;
    case Role::load:
      column.kind = Kind::load;
      break;
    default:
      if (title == "law") column.kind = Kind::law;
      if (title == "protocol") column.kind = Kind::protocol;
      if (has(others_, title)) column.kind = Kind::other;
  }
  if (column.kind == Kind::none) return std::nullopt;
  column.unit = name.unit.value_or(column.kind == Kind::speed && names_rpm(name.base) ? "rpm" : "");
  return column;
}

EarlierColumn EarlierColumns::column_of(const std::string& title, std::size_t line) const {
  if (has(others_, title)) return *condition_column(title);
  if (auto value = value_column(title, line)) return *value;
  if (auto condition = condition_column(title)) return *condition;
  EarlierColumn column;
  column.title = title;
  return column;
}

void EarlierColumns::find_long() {
  const auto place = [&](std::initializer_list<std::string_view> names) -> std::optional<std::size_t> {
    for (const std::string_view name : names) {
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (columns_[k].title == name && columns_[k].kind == Kind::none) return k;
      }
    }
    return std::nullopt;
  };
  const auto name = place({"name", "parameter", "quantity"}), value = place({"value"});
  if (name && value) long_ = LongColumns{*name, *value, place({"unit"}), place({"std_error"})};
}

void EarlierColumns::read(const std::vector<std::string>& titles, std::size_t line) {
  for (const std::string& title : titles) columns_.push_back(column_of(title, line));
  find_long();
  check(line);
  if (long_) return;
  for (const EarlierColumn& column : columns_) {
    if (column.kind == Kind::none) note_unknown(column);
  }
}

void EarlierColumns::check(std::size_t line) {
  bool conditions = false, values = long_.has_value();
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const EarlierColumn& column = columns_[k];
    conditions = conditions || column.kind <= Kind::other;
    values = values || column.kind == Kind::value;
    for (std::size_t j = 0; j < k; ++j) {
      const EarlierColumn& other = columns_[j];
      const bool same = column.kind != Kind::none && column.kind == other.kind && column.law == other.law &&
                        column.protocol == other.protocol;
      const bool one_each = column.kind < Kind::other || column.kind == Kind::law || column.kind == Kind::protocol;
      if (!same || (!one_each && column.name != other.name)) continue;
      throw InputError(fmt::format("a second column of the same kind as '{}'", other.title), "keep one of them",
                       {path_, line, column.title});
    }
  }
  if (!conditions) {
    throw InputError("there is no column of conditions",
                     fmt::format("add {}, {} or {}", condition_infos[0].column, condition_infos[1].column,
                                 condition_infos[2].column),
                     {path_, line, ""});
  }
  if (!values) {
    std::vector<std::string> names;
    for (const KnownQuantity& known : known_) names.push_back(known.name);
    throw InputError("there is no column of values", "the runs have " + listed(names), {path_, line, ""});
  }
}

std::optional<std::size_t> EarlierColumns::error_of(std::size_t value) const {
  const EarlierColumn& column = columns_.at(value);
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const EarlierColumn& other = columns_[k];
    if (other.kind == Kind::std_error && other.name == column.name && other.law == column.law &&
        other.protocol == column.protocol) {
      return k;
    }
  }
  return std::nullopt;
}

void EarlierColumns::note_unknown(const EarlierColumn& column) {
  static const std::vector<std::string> ignored = {"run",    "runs",    "file", "repeat",
                                                   "status", "message", "note", "notes"};
  if (column.title.empty() || has(ignored, column.title)) return;
  std::vector<std::string> names;
  for (const KnownQuantity& known : known_) names.push_back(known.name);
  const std::string nearest = likely_name(column.title, names);
  notes_.push_back(fmt::format("column {} is not a parameter, measure or condition of these runs{}", column.title,
                               nearest.empty() ? "" : " (is it " + nearest + "?)"));
}

}  // namespace tribofit
