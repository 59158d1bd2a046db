#include "tribofit/friction/formula.hpp"

#include <muParser.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "tribofit/execution/stop.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {

namespace {

/// Variables of a formula, their units and what they need.
struct Variable {
  const char* name;
  const char* unit;
  double per_si;  ///< value in `unit` of one SI unit
};
constexpr std::array<Variable, 9> kVariables = {{{"v", "mm/s", 1e3},
                                                 {"acceleration", "mm/s^2", 1e3},
                                                 {"t", "s", 1},
                                                 {"angle", "rad", 1},
                                                 {"distance", "mm", 1e3},
                                                 {"reversal_distance", "mm", 1e3},
                                                 {"stick_time", "s", 1},
                                                 {"load", "N", 1},
                                                 {"temperature", "degC", 1}}};

/// A parameter of this name is the frequency of a line.
constexpr std::string_view kLineFrequency = "f";
constexpr std::size_t kBetweenStops = 32;  // values of a formula, of which a long one takes its time

/// Parts between separators that stand in no bracket.
std::vector<std::string> split_outside_brackets(std::string_view text, char separator) {
  std::vector<std::string> parts;
  std::size_t depth = 0, begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && (text[i] == '[' || text[i] == '(')) ++depth;
    if (i < text.size() && (text[i] == ']' || text[i] == ')') && depth > 0) --depth;
    if (i == text.size() || (text[i] == separator && depth == 0)) {
      parts.emplace_back(trimmed(text.substr(begin, i - begin)));
      begin = i + 1;
    }
  }
  return parts;
}

[[noreturn]] void reject(const std::string& problem, const std::string& text) {
  throw InputError(
      "the formula \"" + text + "\": " + problem,
      "write it as 'hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=25mm/s, w=6mm/s' with the variables v [mm/s], "
      "acceleration [mm/s^2], t [s], angle [rad], distance [mm], reversal_distance [mm], stick_time [s], load [N], "
      "temperature [degC]");
}

/// Units of the variables a formula is written in, so that a parameter's number means the same as the variable's.
std::string_view formula_unit(Quantity quantity) {
  switch (quantity) {
    case Quantity::velocity:
      return "mm/s";
    case Quantity::acceleration:
      return "mm/s^2";
    case Quantity::length:
      return "mm";
    case Quantity::inverse_velocity:
      return "s/mm";
    case Quantity::inverse_length:
      return "1/mm";
    case Quantity::time:
      return "s";
    case Quantity::force:
      return "N";
    case Quantity::angle:
      return "rad";
    case Quantity::frequency:
      return "Hz";
    case Quantity::inverse_time:
      return "1/s";
    case Quantity::angular_velocity:
      return "rad/s";
    case Quantity::temperature:
      return "degC";
    case Quantity::inverse_temperature:
      return "1/K";
    default:
      return "1";
  }
}

/// Reads "0.02", "25mm/s" or "25mm/s[5,60]" into a parameter whose unit is that of the formula's variables.
Parameter read_start(const std::string& name, const std::string& value, const std::string& text) {
  Parameter parameter;
  parameter.name = name;
  std::string number = value, bounds;
  if (const auto open = value.find('['); open != std::string::npos) {
    if (value.back() != ']') reject("the bounds of '" + name + "' lack a closing bracket", text);
    bounds = value.substr(open + 1, value.size() - open - 2);
    number = trimmed(value.substr(0, open));
  }
  char* end = nullptr;
  const double plain = std::strtod(number.c_str(), &end);
  const std::string unit_text(trimmed(end));
  if (end == number.c_str() || !std::isfinite(plain)) reject("'" + name + "' needs a number as its start value", text);
  double factor = 1;
  if (!unit_text.empty()) {
    const std::optional<Unit> unit = find_unit(unit_text);
    if (!unit) reject("the unit '" + unit_text + "' of '" + name + "' is not known", text);
    if (unit->offset != 0) {
      reject(
          "'" + name + "' in " + unit_text + " may be a temperature or a difference of temperatures; give it in degC",
          text);
    }
    parameter.unit = std::string(formula_unit(unit->quantity));
    const std::optional<Unit> shown = find_unit(parameter.unit);
    parameter.si = shown ? shown->factor : 1.0;
    factor = unit->factor / parameter.si;
  }
  parameter.periodic = parameter.unit == "rad";
  parameter.within_record = parameter.unit == "s";
  parameter.decisive = parameter.unit == "s" || parameter.unit == "mm" || parameter.unit == "Hz";
  parameter.start = plain * factor;
  const double reach = parameter.start == 0 ? 1 : 10 * std::abs(parameter.start);
  parameter.lower = parameter.start > 0 ? 0 : -reach;
  parameter.upper = parameter.start < 0 ? 0 : reach;
  if (!unit_text.empty()) parameter.lower = parameter.start > 0 ? 0.1 * parameter.start : parameter.lower;
  if (unit_text.empty() && parameter.start != 0) {
    parameter.lower = -reach;
    parameter.upper = reach;
  }
  if (!bounds.empty()) {
    const std::vector<std::string> ends = split_outside_brackets(bounds, ',');
    char *end_low = nullptr, *end_high = nullptr;
    if (ends.size() == 2) {
      parameter.lower = std::strtod(ends[0].c_str(), &end_low) * factor;
      parameter.upper = std::strtod(ends[1].c_str(), &end_high) * factor;
    }
    if (ends.size() != 2 || end_low == ends[0].c_str() || end_high == ends[1].c_str() || *end_low != 0 ||
        *end_high != 0 || !std::isfinite(parameter.lower) || !std::isfinite(parameter.upper) ||
        !(parameter.lower < parameter.upper) || parameter.start < parameter.lower ||
        parameter.start > parameter.upper) {
      reject("the bounds of '" + name + "' are not [lower,upper] around its start", text);
    }
  }
  return parameter;
}

}  // namespace

struct Formula::Parsed {
  std::string text, name, expression;
  std::vector<Parameter> parameters;
  Channels needs;
  std::array<double, kVariables.size()> variable{};
  std::vector<double> value;
  mu::Parser parser;

  /// Binds names to the storage of this object; a copy must bind anew.
  void bind() {
    parser = mu::Parser();
    parser.SetExpr(expression);
    parser.DefineConst("pi", 3.14159265358979323846);
    for (std::size_t k = 0; k < kVariables.size(); ++k) parser.DefineVar(kVariables[k].name, &variable[k]);
    value.assign(parameters.size(), 0.0);
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      value[k] = parameters[k].start;
      parser.DefineVar(parameters[k].name, &value[k]);
    }
  }
};

namespace {

/// The expression of a formula assigns nothing.
void refuse_assignment(const std::string& expression, const std::string& text) {
  const auto is = [&](std::size_t k, const char* any) {
    return k < expression.size() && std::string_view(any).find(expression[k]) != std::string_view::npos;
  };
  for (std::size_t i = 0; i < expression.size(); ++i) {
    if (is(i, "=") && !is(i + 1, "=") && (i == 0 || !is(i - 1, "=<>!"))) {
      reject("there is an assignment in its expression", text);
    }
  }
}

void refuse_name(const std::string& name, const std::string& text) {
  const auto name_char = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), name_char)) {
    reject("its name must be letters, digits, '-' or '_'", text);
  }
}

/// Parameters with their starts: what stands after the semicolon.
std::vector<Parameter> read_parameters(std::string_view starts, const std::string& text) {
  std::vector<Parameter> parameters;
  for (const std::string& part : split_outside_brackets(starts, ',')) {
    if (part.empty()) continue;
    const auto assign = part.find('=');
    const std::string key(trimmed(std::string_view(part).substr(0, assign)));
    if (assign == std::string::npos || key.empty()) reject("'" + part + "' is not 'parameter=start'", text);
    for (const Variable& variable : kVariables) {
      if (key == variable.name) reject("'" + key + "' is a variable and cannot be a parameter", text);
    }
    for (const Parameter& known : parameters) {
      if (known.name == key) reject("the parameter '" + key + "' is given twice", text);
    }
    parameters.push_back(read_start(key, std::string(trimmed(std::string_view(part).substr(assign + 1))), text));
  }
  return parameters;
}

/// Every name in the expression is known, and every parameter is used.
template <class UsedNames>
void check_names(const UsedNames& used, const std::vector<Parameter>& parameters, const std::string& text) {
  std::vector<std::string> known;
  for (const Variable& variable : kVariables) known.emplace_back(variable.name);
  for (const Parameter& parameter : parameters) known.push_back(parameter.name);
  for (const auto& [name, unused] : used) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      reject("'" + name + "' is neither a variable nor a parameter with a start (nearest: '" +
                 nearest_name(name, known) + "')",
             text);
    }
  }
  for (const Parameter& parameter : parameters) {
    if (!used.contains(parameter.name)) reject("the parameter '" + parameter.name + "' is not used", text);
  }
}

}  // namespace

Formula::Formula(std::string_view given) : parsed_(std::make_unique<Parsed>()) {
  Parsed& p = *parsed_;
  p.text = trimmed(given);
  const auto semicolon = p.text.find(';');
  const std::string definition = p.text.substr(0, semicolon);
  const auto equals = definition.find('=');
  if (equals == std::string::npos) reject("there is no '=' between its name and its expression", p.text);
  p.name = trimmed(definition.substr(0, equals));
  p.expression = trimmed(definition.substr(equals + 1));
  refuse_assignment(p.expression, p.text);
  refuse_name(p.name, p.text);
  if (semicolon != std::string::npos) {
    p.parameters = read_parameters(std::string_view(p.text).substr(semicolon + 1), p.text);
  }
  try {
    p.bind();
    const auto used = p.parser.GetUsedVar();
    check_names(used, p.parameters, p.text);
    p.needs = {.acceleration = used.contains("acceleration"),
               .angle = used.contains("angle"),
               .distance = used.contains("distance"),
               .load = used.contains("load"),
               .temperature = used.contains("temperature"),
               .stick_time = used.contains("stick_time"),
               .reversal_distance = used.contains("reversal_distance"),
               .time = used.contains("t")};
    p.needs.time |=
        p.needs.acceleration || p.needs.angle || p.needs.distance || p.needs.reversal_distance || p.needs.stick_time;
    p.parser.Eval();
    if (p.parser.GetNumResults() != 1) reject("there is more than one expression", p.text);
  } catch (const mu::Parser::exception_type& error) {
    const auto position = static_cast<std::size_t>(std::max(0, error.GetPos()));
    reject(std::string(error.GetMsg()) + " Here:\n  " + p.expression + "\n  " +
               std::string(std::min(position, p.expression.size()), ' ') + "^",
           p.text);
  }
}

Formula::Formula(const Formula& other) : parsed_(std::make_unique<Parsed>(*other.parsed_)) {
  parsed_->bind();
}
Formula& Formula::operator=(const Formula& other) {
  if (this != &other) *this = Formula(other);
  return *this;
}
Formula::Formula(Formula&&) noexcept = default;
Formula& Formula::operator=(Formula&&) noexcept = default;
Formula::~Formula() = default;

EffectInfo Formula::info() const {
  return {.key = parsed_->name,
          .statement = "a term given by the user",
          .equation = "mu + " + parsed_->expression,
          .source = "the user",
          .experiment = "",
          .parameters = parsed_->parameters,
          .needs = parsed_->needs,
          .group = EffectGroup::user,
          .needs_full_resolution =
              std::any_of(parsed_->parameters.begin(), parsed_->parameters.end(),
                          [](const Parameter& parameter) { return parameter.name == kLineFrequency; })};
}

bool Formula::same_as(const Formula& other) const {
  const auto bare = [](std::string text) {
    std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
    return text;
  };
  return bare(parsed_->expression) == bare(other.parsed_->expression);
}

std::size_t Formula::parameter_count() const {
  return parsed_->parameters.size();
}

void Formula::evaluate(std::span<const double> values, const Slip& slip, std::span<const double> speed,
                       std::span<double> terms) const {
  Parsed& p = *parsed_;
  for (std::size_t k = 0; k < values.size(); ++k) p.value[k] = values[k] / p.parameters[k].si;
  try {
    for (std::size_t i = 0; i < slip.size(); ++i) {
      if (i % kBetweenStops == 0) stop_point();
      const SlidingState<double> at = slip.at(i, speed[i]);
      const std::array<double, kVariables.size()> si = {speed[i],      at.acceleration, at.time,
                                                        at.angle,      at.distance,     at.reversal_distance,
                                                        at.stick_time, at.load,         at.temperature};
      for (std::size_t k = 0; k < si.size(); ++k) p.variable[k] = si[k] * kVariables[k].per_si;
      terms[i] = p.parser.Eval();
    }
  } catch (const mu::Parser::exception_type& error) {
    reject(error.GetMsg(), p.text);
  }
}

void Formula::differentiate(std::size_t k, std::span<const double> values, const Slip& slip,
                            std::span<const double> speed, std::span<double> slopes) const {
  std::vector<double> low(slopes.size());
  const auto difference = [&](double h, auto&& terms_at) {
    terms_at(h, slopes);
    terms_at(-h, low);
    for (std::size_t i = 0; i < slopes.size(); ++i) slopes[i] = (slopes[i] - low[i]) / (2 * h);
  };
  constexpr double kRelativeStep = 6e-6;  // cube root of the rounding unit: least error of a central difference
  if (k < values.size()) {
    std::vector<double> moved(values.begin(), values.end());
    const Parameter& parameter = parsed_->parameters[k];
    const double scale = std::max(std::abs(values[k]), std::abs(parameter.start * parameter.si));
    difference(kRelativeStep * (scale > 0 ? scale : parameter.si), [&](double h, std::span<double> terms) {
      moved[k] = values[k] + h;
      evaluate(moved, slip, speed, terms);
    });
  } else {
    std::vector<double> moved(speed.size());
    difference(1e-9, [&](double h, std::span<double> terms) {
      for (std::size_t i = 0; i < speed.size(); ++i) moved[i] = speed[i] + h;
      evaluate(values, slip, moved, terms);
    });
  }
}

}  // namespace tribofit
