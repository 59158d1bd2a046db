#include "tribofit/campaign/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <utility>

#include "conditions.hpp"
#include "ingest/raw_table.hpp"
#include "ingest/reader.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

constexpr const char* kNumber = "[0-9]+(?:[.,][0-9]+)?";
constexpr const char* kAdvice = "write it as in 'r{radius}mm_{repeat}.csv'";

const ConditionInfo* measured(const std::string& name) {
  const auto found = std::ranges::find(condition_infos, name, &ConditionInfo::name);
  return found == condition_infos.end() ? nullptr : found;
}

/// The longest beginning of `text` that is a unit of the quantity, as letters.
std::string unit_at_beginning(std::string_view text, Quantity quantity) {
  std::size_t letters = 0;
  while (letters < text.size() && std::isalpha(static_cast<unsigned char>(text[letters]))) ++letters;
  for (; letters > 0; --letters) {
    const std::string unit(text.substr(0, letters));
    if (find_unit(unit, quantity)) return unit;
  }
  return "";
}

std::string escaped(char c) {
  return std::string_view("\\^$.|?*+()[]{}").find(c) == std::string_view::npos ? std::string(1, c)
                                                                               : std::string("\\") + c;
}

/// The one thing that an expression finds in a text: its groups put together; empty where it finds nothing, or several
/// things.
std::string only_match(const std::string& text, const std::regex& expression) {
  std::string found;
  for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it) {
    std::string match;
    for (std::size_t group = 1; group < it->size(); ++group) match += (*it)[group].str();
    if (!found.empty() && found != match) return "";
    found = match;
  }
  return replaced(found, ",", ".");
}

std::regex regex_of(const std::string& text) {
  return std::regex(text, std::regex::ECMAScript | std::regex::icase);
}

Condition condition_from(const std::string& text, const ConditionInfo& what, const std::string& source) {
  if (text.empty()) return {};
  if (text.find_first_not_of("+-.0123456789 ") == std::string::npos) {
    throw InputError(fmt::format("the {} '{}' has no unit", what.name, text),
                     fmt::format("write the unit behind it in the pattern, as in {}", kAdvice));
  }
  const double value = parse_quantity(text, what.quantity, what.name);
  if (!(value > 0)) {
    throw InputError(fmt::format("the {} '{}' is not greater than zero", what.name, text), "correct the name");
  }
  return {value, source};
}

/// "Radius [mm]: 15" as a radius of 15mm.
void take_fact(const RawFact& fact, StatedFields& stated) {
  const ColumnName name = parse_column_name(fact.name);
  const ConditionInfo* what = find_condition(name.base);
  std::string value = replaced(fact.value, ",", ".");
  if (what == nullptr || value.find_first_of("0123456789") == std::string::npos) return;
  if (value.find_first_not_of("+-.0123456789eE") == std::string::npos && name.unit) value += *name.unit;
  try {
    if (condition_from(value, *what, "file").known()) stated.of(what->name) = value;
  } catch (const InputError&) {  // a line that only looks like one
  }
}

}  // namespace

bool in_natural_order(std::string_view a, std::string_view b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, k = 0;
  while (i < a.size() && k < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[k])) {
      if (a[i] != b[k]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[k]);
      ++i, ++k;
      continue;
    }
    const auto number_at = [&](std::string_view text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t begin = at;
      while (at < text.size() && is_digit(text[at])) ++at;
      return text.substr(begin, at - begin);
    };
    const std::string_view one = number_at(a, i), other = number_at(b, k);
    if (one.size() != other.size()) return one.size() < other.size();
    if (one != other) return one < other;
  }
  const std::size_t left = a.size() - i, other_left = b.size() - k;
  return left != other_left ? left < other_left : a < b;  // 07 and 7 are one number
}

std::string& StatedFields::of(std::string_view name) {
  for (std::size_t k = 0; k < condition_infos.size(); ++k) {
    if (condition_infos[k].name == name) return this->*stated_conditions[k];
  }
  return name == "repeat" ? repeat : others.emplace_back(OtherCondition{std::string(name), ""}).value;
}

NamePattern::NamePattern(const std::string& pattern) : text_(pattern) {
  const std::string lower = lower_case(pattern);
  with_extension_ = lower.ends_with(".csv") || lower.ends_with(".tsv");
  std::string expression;
  for (std::size_t at = 0; at < pattern.size(); ++at) {
    if (pattern[at] == '*') {
      expression += ".*";
    } else if (pattern[at] == '{') {
      const std::size_t end = pattern.find('}', at);
      if (end == std::string::npos) throw InputError("--pattern: a { is not closed", kAdvice);
      add_field(pattern.substr(at + 1, end - at - 1), std::string_view(pattern).substr(end + 1), expression);
      at = end;
    } else if (pattern[at] == '}') {
      throw InputError("--pattern: a } has no {", kAdvice);
    } else {
      expression += escaped(pattern[at]);
    }
  }
  if (fields_.empty()) throw InputError(fmt::format("--pattern: '{}' names nothing to read", pattern), kAdvice);
  expression_ = std::regex(expression);
}

void NamePattern::add_field(const std::string& name, std::string_view behind, std::string& expression) {
  if (name.empty() || name == "file")
    throw InputError("--pattern: {" + name + "} is not the name of a condition", kAdvice);
  if (std::ranges::find(fields_, name, &Field::name) != fields_.end())
    throw InputError("--pattern: {" + name + "} is given twice", "use each name once; * stands for anything");
  Field field{name, ""};
  if (const ConditionInfo* what = measured(name)) {
    field.unit = unit_at_beginning(behind, what->quantity);
    expression += field.unit.empty() ? fmt::format("({} ?[A-Za-z]*)", kNumber) : fmt::format("({})", kNumber);
  } else {
    expression += name == "repeat" ? "([0-9]+)" : "(.+?)";
  }
  fields_.push_back(std::move(field));
}

std::optional<StatedFields> NamePattern::read(const std::string& file_name) const {
  const std::string name = with_extension_ ? file_name : std::filesystem::path(file_name).stem().string();
  std::smatch match;
  if (!std::regex_match(name, match, expression_)) return std::nullopt;
  StatedFields stated;
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const std::string text = match[k + 1].str();
    const bool is_number = measured(fields_[k].name) != nullptr;
    stated.of(fields_[k].name) = is_number ? replaced(text, ",", ".") + fields_[k].unit : text;
  }
  return stated;
}

StatedFields usual_fields(const std::string& file_name) {
  const std::string stem = std::filesystem::path(file_name).stem().string();
  const std::string begin = "(?:^|[^0-9a-z.,])", number = fmt::format("({})[-_ ]?", kNumber);
  static const std::regex radius =
      regex_of(begin + "(?:r|radius)?[-_= ]?" + number + "(mm|cm)(?![a-z]|[-_ ]?s(?![a-z]))");
  static const std::regex speed = regex_of(begin + "(?:n|v|w|speed)?[-_= ]?" + number + "(rpm)(?![a-z])");
  static const std::regex load = regex_of(begin + "(?:f|fn|p|l|load)?[-_= ]?" + number + "(k?n)(?![a-z])");
  static const std::regex temperature = regex_of(begin + "(?:t|temp)?[-_= ]?" + number + "(?:deg)?(c)(?![a-z])");
  static const std::regex named_repeat = regex_of(begin + "(?:run|rep|repeat|no|nr|trial)[-_ ]?0*([0-9]+)(?![0-9a-z])");
  static const std::regex last_number = regex_of("[-_ (]0*([0-9]{1,3})\\)?$");
  StatedFields stated;
  stated.radius = lower_case(only_match(stem, radius));
  stated.speed = lower_case(only_match(stem, speed));
  stated.load = replaced(lower_case(only_match(stem, load)), "n", "N");  // units of force know capitals
  const std::string degrees = only_match(stem, temperature);
  if (!degrees.empty()) stated.of("temperature") = degrees.substr(0, degrees.size() - 1) + "degC";
  stated.repeat = only_match(stem, named_repeat);
  if (stated.repeat.empty()) stated.repeat = only_match(stem, last_number);
  return stated;
}

StatedFields header_fields(const std::string& path) {
  StatedFields stated;
  try {
    for (const RawFact& fact : read_table(path).facts) take_fact(fact, stated);
  } catch (const InputError&) {  // the batch will say what is wrong with the file
  }
  return stated;
}

ManifestRow row_from(const StatedFields& fields, const std::string& path, const std::string& source) {
  ManifestRow row;
  row.path = path;
  for (std::size_t k = 0; k < condition_infos.size(); ++k) {
    const ConditionInfo& what = condition_infos[k];
    row.conditions.*what.member = condition_from(fields.*stated_conditions[k], what, source);
  }
  int repeat = 0;
  const auto [end, error] = std::from_chars(fields.repeat.data(), fields.repeat.data() + fields.repeat.size(), repeat);
  if (!fields.repeat.empty() && error == std::errc{}) row.repeat = repeat;
  row.others = fields.others;
  return row;
}

}  // namespace tribofit
