#include "tribofit/ingest/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>
#include <vector>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

// Exponents of the base dimensions: m, kg, s, rad, K, V, cycle. Angle and cycle are kept apart from "no dimension"
// because rad/s, Hz and 1/s must not be taken for one another.
using Dimensions = std::array<int, 7>;

struct Symbol {
  std::string_view names;  // divided by blanks
  double factor;
  Dimensions dimensions;
  std::string_view prefixes = {};  // those people use with it; others would only hide typing errors
};

constexpr double turn = 2 * std::numbers::pi;

constexpr Dimensions length = {1, 0, 0, 0, 0, 0, 0}, duration = {0, 0, 1, 0, 0, 0, 0}, mass = {0, 1, 0, 0, 0, 0, 0},
                     force = {1, 1, -2, 0, 0, 0, 0}, pressure = {-1, 1, -2, 0, 0, 0, 0},
                     frequency = {0, 0, -1, 0, 0, 0, 1}, angle = {0, 0, 0, 1, 0, 0, 0},
                     temperature = {0, 0, 0, 0, 1, 0, 0}, voltage = {0, 0, 0, 0, 0, 1, 0};

constexpr std::array symbols = {
    Symbol{"m", 1, length, "numcdk"},
    Symbol{"micron microns mic", 1e-6, length},  // the last as xlook has it
    Symbol{"in", 0.0254, length},
    Symbol{"ft", 0.3048, length},
    Symbol{"s", 1, duration, "num"},
    Symbol{"sec", 1, duration, "m"},
    Symbol{"second seconds", 1, duration},
    Symbol{"min", 60, duration},
    Symbol{"h", 3600, duration},
    Symbol{"g", 1e-3, mass, "mk"},
    Symbol{"t", 1e3, mass},
    Symbol{"N", 1, force, "umkM"},
    Symbol{"newton", 1, force},
    Symbol{"kgf kp", 9.80665, force},
    Symbol{"gf", 9.80665e-3, force},
    Symbol{"Pa", 1, pressure, "kMG"},
    Symbol{"mpa", 1e6, pressure},  // of names in small letters: no stress is in millipascals
    Symbol{"bar", 1e5, pressure, "mk"},
    Symbol{"psi", 6894.757293168, pressure},
    Symbol{"lbf", 4.4482216152605, force},
    Symbol{"ozf", 0.27801385095378125, force},
    Symbol{"kip", 4448.2216152605, force},
    Symbol{"dyn", 1e-5, force},
    Symbol{"lb", 0.45359237, mass},
    Symbol{"Hz", 1, frequency, "mkMG"},
    Symbol{"hz", 1, frequency, "k"},
    Symbol{"rad", 1, angle, "um"},
    Symbol{"deg", turn / 360, angle},
    Symbol{"rev turn", turn, angle},
    Symbol{"rpm", turn / 60, {0, 0, -1, 1, 0, 0, 0}},
    Symbol{"K degC", 1, temperature},
    Symbol{"V", 1, voltage, "um"},
    Symbol{"v volt volts", 1, voltage},
    Symbol{"%", 1e-2, {}},
    Symbol{"1", 1, {}},
};

struct Kind {
  Quantity quantity;
  Dimensions dimensions;
  std::string_view name, example;
};

constexpr std::array kinds = {
    Kind{Quantity::dimensionless, {}, "dimensionless number", "0.3 or 30 %"},
    Kind{Quantity::time, duration, "time", "0.5s or 20ms"},
    Kind{Quantity::length, length, "length", "15mm or 0.015m"},
    Kind{Quantity::velocity, {1, 0, -1, 0, 0, 0, 0}, "velocity", "6.3mm/s"},
    Kind{Quantity::angular_velocity, {0, 0, -1, 1, 0, 0, 0}, "angular velocity", "4rpm or 0.419rad/s"},
    Kind{Quantity::acceleration, {1, 0, -2, 0, 0, 0, 0}, "acceleration", "0.5m/s^2"},
    Kind{Quantity::force, force, "force", "50N"},
    Kind{Quantity::torque, {2, 1, -2, 0, 0, 0, 0}, "torque", "2.5Nm"},
    Kind{Quantity::mass, mass, "mass", "0.1kg or 100g"},
    Kind{Quantity::stiffness, {0, 1, -2, 0, 0, 0, 0}, "stiffness", "12N/mm"},
    Kind{Quantity::damping, {0, 1, -1, 0, 0, 0, 0}, "damping", "3Ns/m"},
    Kind{Quantity::frequency, frequency, "frequency", "20kHz or 50Hz"},
    Kind{Quantity::angle, angle, "angle", "90deg or 1.57rad"},
    Kind{Quantity::temperature, temperature, "temperature", "23degC"},
    Kind{Quantity::voltage, voltage, "voltage", "10V"},
    Kind{Quantity::inverse_velocity, {-1, 0, 1, 0, 0, 0, 0}, "inverse velocity", "0.05s/mm"},
    Kind{
        Quantity::inverse_square_of_velocity, {-2, 0, 2, 0, 0, 0, 0}, "inverse square of a velocity", "0.0001s^2/mm^2"},
    Kind{Quantity::inverse_length, {-1, 0, 0, 0, 0, 0, 0}, "inverse length", "100/mm"},
    Kind{Quantity::inverse_time, {0, 0, -1, 0, 0, 0, 0}, "inverse time", "0.001 1/s"},
    Kind{Quantity::inverse_temperature, {0, 0, 0, 0, -1, 0, 0}, "inverse temperature", "0.002 1/K"},
    Kind{Quantity::pressure, pressure, "stress", "5MPa"},
};

const Kind& kind_of(Quantity quantity) {
  return *std::ranges::find(kinds, quantity, &Kind::quantity);
}

double prefix_factor(char prefix) {
  static constexpr std::array<std::pair<char, double>, 8> prefixes = {
      {{'n', 1e-9}, {'u', 1e-6}, {'m', 1e-3}, {'c', 1e-2}, {'d', 1e-1}, {'k', 1e3}, {'M', 1e6}, {'G', 1e9}}};
  return std::ranges::find(prefixes, prefix, &std::pair<char, double>::first)->second;
}

struct Term {
  double factor = 1;
  Dimensions dimensions{};
};

std::optional<Term> find_symbol(std::string_view name) {
  for (const Symbol& symbol : symbols) {
    if (is_among(name, symbol.names)) return Term{symbol.factor, symbol.dimensions};
  }
  for (const Symbol& symbol : symbols) {
    const bool has_prefix = name.size() > 1 && symbol.prefixes.find(name[0]) != std::string_view::npos;
    if (has_prefix && is_among(name.substr(1), symbol.names))
      return Term{prefix_factor(name[0]) * symbol.factor, symbol.dimensions};
  }
  return std::nullopt;
}

void multiply(Term& product, const Term& term, int exponent) {
  for (int i = 0; i < exponent; ++i) product.factor *= term.factor;
  for (int i = 0; i > exponent; --i) product.factor /= term.factor;  // 1/mm is 1000/m, to the last bit
  for (std::size_t i = 0; i < term.dimensions.size(); ++i) product.dimensions[i] += exponent * term.dimensions[i];
}

/// A run of letters: one symbol, or newtons written together with what follows ("Nm", "kNmm", "Ns").
std::optional<Term> find_word(std::string_view word) {
  if (const auto symbol = find_symbol(word)) return symbol;
  const std::size_t newton = word.find('N');
  if (newton == std::string_view::npos || newton > 1 || newton + 1 >= word.size()) return std::nullopt;
  auto product = find_symbol(word.substr(0, newton + 1));
  const auto rest = find_symbol(word.substr(newton + 1));
  if (!product || !rest) return std::nullopt;
  multiply(*product, *rest, 1);
  return product;
}

/// Products, quotients, powers and parentheses: "N*s/mm", "mm s^-1", "V/(mm/s)".
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : rest_(text) {}

  std::optional<Term> parse() {
    const auto result = product();
    return result && rest_.empty() ? result : std::nullopt;
  }

 private:
  bool take(char c) {
    skip_spaces();
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void skip_spaces() {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  }

  std::optional<Term> product() {
    Term result;
    int sign = 1;
    for (bool first = true;; first = false) {
      if (take('/')) {
        sign = -1;
      } else if (!first) {
        sign = 1;
        if (!take('*') && (rest_.empty() || rest_.front() == ')')) return result;
      }
      const auto factor = power();
      if (!factor) return std::nullopt;
      multiply(result, *factor, sign);
    }
  }

  std::optional<Term> power() {
    auto base = primary();
    if (!base) return std::nullopt;
    const bool caret = take('^');
    int exponent = 1;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), exponent);
    if (error != std::errc{}) return caret ? std::nullopt : base;
    if (std::abs(exponent) > 4) return std::nullopt;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    Term result;
    multiply(result, *base, exponent);
    return result;
  }

  std::optional<Term> primary() {
    if (take('(')) {
      const auto inner = product();
      return inner && take(')') ? inner : std::nullopt;
    }
    skip_spaces();
    if (!rest_.empty() && (rest_.front() == '1' || rest_.front() == '%')) {
      const auto result = find_symbol(rest_.substr(0, 1));
      rest_.remove_prefix(1);
      return result;
    }
    const std::size_t end = std::min(rest_.find_first_of(" /*^()-0123456789"), rest_.size());
    const auto result = find_word(rest_.substr(0, end));
    rest_.remove_prefix(end);
    return result;
  }

  std::string_view rest_;
};

/// Torques of drives and wrenches, in which a mass stands for the force it weighs with ("ft-lb", "kg cm").
std::optional<std::string> torque_of_masses(std::string_view text) {
  std::string word;
  for (const char c : lower_case(text)) {
    if (std::string_view(" -.*").find(c) == std::string_view::npos) word += c;
  }
  static constexpr std::array<std::string_view, 11> torques = {"lb*ft", "ft*lb", "lb*in", "in*lb", "oz*in", "in*oz",
                                                               "kg*m",  "kg*cm", "kg*mm", "g*cm",  "g*mm"};
  for (const std::string_view torque : torques) {
    const std::size_t star = torque.find('*');
    const std::string first(torque.substr(0, star)), second(torque.substr(star + 1));
    const bool length_first = second == "lb" || second == "oz";
    const std::string &weight = length_first ? second : first, &arm = length_first ? first : second;
    for (const char* ending : {"", "f", "s"}) {
      if (word == (length_first ? arm + weight + ending : weight + ending + arm)) return weight + "f*" + arm;
    }
  }
  return std::nullopt;
}

/// One spelling for units that people write in many ways, in ASCII: "\u00b5m" is "um", "N\u00b7m" is "N*m", "ft-lb" is
/// "lbf*ft".
std::string usual_spelling(std::string_view text) {
  static constexpr std::string_view spellings[][2] = {
      {"\u00b5", "u"},   {"\u03bc", "u"},  {"\u00b7", "*"},         {"\u22c5", "*"},  {"\u00d7", "*"},
      {"\u00b2", "^2"},  {"\u00b3", "^3"}, {"\u207b\u00b9", "^-1"}, {"\u00b9", "^1"}, {"\u2103", "degC"},
      {"\u00b0", "deg"}, {"**", "^"},      {" per ", "/"},          {"N.m", "N*m"},   {"\u2212", "-"}};
  std::string result(trimmed(text));
  for (const auto& [from, to] : spellings) result = replaced(std::move(result), from, to);
  return torque_of_masses(result).value_or(result);
}

std::optional<Unit> find_exactly(std::string_view text) {
  if (text.empty() || text == "-") return Unit{};
  if (text == "K") return Unit{Quantity::temperature, 1, -273.15};
  if (text == "C" || text == "degC" || text == "deg C") return Unit{Quantity::temperature, 1, 0};
  if (text == "F" || text == "degF" || text == "deg F") return Unit{Quantity::temperature, 5.0 / 9, -160.0 / 9};
  if (text == "% of load" || text == "% load" || text == "%load") return find_exactly("%");
  if (text == "r/min" || text == "U/min" || text == "RPM") return find_exactly("rpm");
  const auto term = UnitParser(text).parse();
  if (!term) return std::nullopt;
  for (const Kind& kind : kinds) {
    if (kind.dimensions == term->dimensions) return Unit{kind.quantity, term->factor, 0};
  }
  return std::nullopt;
}

const std::vector<std::string>& known_units() {
  static const std::vector<std::string> names = split(
      "s ms us min h m mm um cm in m/s mm/s um/s cm/s rad/s rpm deg/s rev/s m/s^2 mm/s^2 N mN kN MN kgf gf lbf kip Nm "
      "mNm Nmm kNm kg g N/m N/mm kN/m Ns/m Ns/mm Hz kHz MHz rad deg rev degC K V mV s/m s/mm s^2/mm^2 1/m 1/mm 1/s "
      "1/min 1/K %",
      ' ');
  return names;
}

/// "1/min" on the plate of a drive is a rotational speed, never a rate.
std::optional<Unit> as_quantity(const Unit& unit, Quantity wanted) {
  if (unit.quantity == wanted) return unit;
  if (wanted == Quantity::angular_velocity && unit.quantity == Quantity::inverse_time && unit.factor < 1) {
    return Unit{wanted, unit.factor * turn, 0};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Unit> find_unit(std::string_view text) {
  const std::string name = usual_spelling(text);
  if (const auto unit = find_exactly(name)) return unit;
  return find_exactly(lower_case(name));
}

std::optional<Unit> find_unit(std::string_view text, Quantity quantity) {
  const auto unit = find_unit(text);
  return unit ? as_quantity(*unit, quantity) : std::nullopt;
}

std::string suggest_unit(std::string_view text) {
  return likely_name(usual_spelling(text), known_units());
}

double parse_quantity(std::string_view text, Quantity quantity, std::string_view name, std::string_view bare_unit) {
  const std::string shown = fmt::format("'{}'", text);
  const auto fail = [&](const std::string& problem, const std::string& advice) {
    throw InputError(fmt::format("{}: {}", name, problem), advice);
  };
  const std::string example =
      fmt::format("give {} such as {}", with_article(to_string(quantity)), example_of(quantity));

  std::string_view rest = trimmed(text);
  if (rest.size() > 1 && rest.front() == '+' && rest[1] != '-') rest.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error == std::errc::result_out_of_range) fail(shown + " is outside the range of numbers", example);
  if (error != std::errc{}) fail(shown + " is not a number", example);
  if (!std::isfinite(number)) fail(shown + " is not a finite number", example);
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  rest = trimmed(rest);
  if (rest.empty()) rest = bare_unit;
  if (rest.empty()) return number;

  if (rest.front() == ',') fail(shown + " has a decimal comma", "write numbers with a decimal point; " + example);
  const auto unit = find_unit(rest);
  if (!unit) {
    const std::string nearest = suggest_unit(rest);
    fail(fmt::format("unknown unit '{}' in {}", rest, shown),
         nearest.empty() ? example : "did you mean " + nearest + "? " + example);
  }
  const auto wanted = as_quantity(*unit, quantity);
  if (!wanted) {
    fail(fmt::format("{} is {}, not {}", shown, with_article(to_string(unit->quantity)),
                     with_article(to_string(quantity))),
         example);
  }
  return number * wanted->factor + wanted->offset;
}

std::string frequency_text(double hertz, int digits) {
  if (!std::isfinite(hertz)) return "-";
  const bool is_high = hertz >= 1000;
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(hertz, 1e-300))) + 1 - digits);
  const double rounded = decade > 1 ? std::round(hertz / decade) * decade : hertz;  // never "1.2e+04"
  return general(is_high ? rounded / 1000 : rounded, std::max(digits, 3)) + (is_high ? " kHz" : " Hz");
}

std::string_view to_string(Quantity quantity) {
  return kind_of(quantity).name;
}

std::string_view example_of(Quantity quantity) {
  return kind_of(quantity).example;
}

}  // namespace tribofit
