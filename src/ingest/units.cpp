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

#include "unit_spelling.hpp"

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
  std::string_view name;
  double factor;
  Dimensions dimensions;
  std::string_view prefixes;  // those people use with it; others would only hide typing errors
};

constexpr double turn = 2 * std::numbers::pi;

constexpr std::array symbols = {
    Symbol{"m", 1, {1, 0, 0, 0, 0, 0, 0}, "numcdk"},
    Symbol{"micron", 1e-6, {1, 0, 0, 0, 0, 0, 0}, ""},
    Symbol{"microns", 1e-6, {1, 0, 0, 0, 0, 0, 0}, ""},
    Symbol{"mic", 1e-6, {1, 0, 0, 0, 0, 0, 0}, ""},  // as xlook has it
    Symbol{"in", 0.0254, {1, 0, 0, 0, 0, 0, 0}, ""},
    Symbol{"ft", 0.3048, {1, 0, 0, 0, 0, 0, 0}, ""},
    Symbol{"s", 1, {0, 0, 1, 0, 0, 0, 0}, "num"},
    Symbol{"sec", 1, {0, 0, 1, 0, 0, 0, 0}, "m"},
    Symbol{"second", 1, {0, 0, 1, 0, 0, 0, 0}, ""},
    Symbol{"seconds", 1, {0, 0, 1, 0, 0, 0, 0}, ""},
    Symbol{"min", 60, {0, 0, 1, 0, 0, 0, 0}, ""},
    Symbol{"h", 3600, {0, 0, 1, 0, 0, 0, 0}, ""},
    Symbol{"g", 1e-3, {0, 1, 0, 0, 0, 0, 0}, "mk"},
    Symbol{"t", 1e3, {0, 1, 0, 0, 0, 0, 0}, ""},
    Symbol{"N", 1, {1, 1, -2, 0, 0, 0, 0}, "umkM"},
    Symbol{"newton", 1, {1, 1, -2, 0, 0, 0, 0}, ""},
    Symbol{"kgf", 9.80665, {1, 1, -2, 0, 0, 0, 0}, ""},
    Symbol{"gf", 9.80665e-3, {1, 1, -2, 0, 0, 0, 0}, ""},
    Symbol{"kp", 9.80665, {1, 1, -2, 0, 0, 0, 0}, ""},
    Symbol{"Pa", 1, {-1, 1, -2, 0, 0, 0, 0}, "kMG"},
    Symbol{"mpa", 1e6, {-1, 1, -2, 0, 0, 0, 0}, ""},  // of names in small letters: no stress is in millipascals
    Symbol{"bar", 1e5, {-1, 1, -2, 0, 0, 0, 0}, "mk"},
    Symbol{"psi", 6894.757293168, {-1, 1, -2, 0, 0, 0, 0}, ""},
    Symbol{"lbf", 4.4482216152605, {1, 1, -2, 0, 0, 0, 0}, ""},
    Symbol{"ozf", 0.27801385095378125, {1, 1, -2, 0, 0, 0, 0}, ""},
    Symbol{"kip", 4448.2216152605, {1, 1, -2, 0, 0, 0, 0}, ""},
    Symbol{"dyn", 1e-5, {1, 1, -2, 0, 0, 0, 0}, ""},
    Symbol{"lb", 0.45359237, {0, 1, 0, 0, 0, 0, 0}, ""},
    Symbol{"Hz", 1, {0, 0, -1, 0, 0, 0, 1}, "mkMG"},
    Symbol{"hz", 1, {0, 0, -1, 0, 0, 0, 1}, "k"},
    Symbol{"rad", 1, {0, 0, 0, 1, 0, 0, 0}, "um"},
    Symbol{"deg", turn / 360, {0, 0, 0, 1, 0, 0, 0}, ""},
    Symbol{"rev", turn, {0, 0, 0, 1, 0, 0, 0}, ""},
    Symbol{"turn", turn, {0, 0, 0, 1, 0, 0, 0}, ""},
    Symbol{"rpm", turn / 60, {0, 0, -1, 1, 0, 0, 0}, ""},
    Symbol{"K", 1, {0, 0, 0, 0, 1, 0, 0}, ""},
    Symbol{"degC", 1, {0, 0, 0, 0, 1, 0, 0}, ""},
    Symbol{"V", 1, {0, 0, 0, 0, 0, 1, 0}, "um"},
    Symbol{"v", 1, {0, 0, 0, 0, 0, 1, 0}, ""},
    Symbol{"volt", 1, {0, 0, 0, 0, 0, 1, 0}, ""},
    Symbol{"volts", 1, {0, 0, 0, 0, 0, 1, 0}, ""},
    Symbol{"%", 1e-2, {}, ""},
    Symbol{"1", 1, {}, ""},
};

struct Kind {
  Quantity quantity;
  Dimensions dimensions;
  std::string_view name, example;
};

constexpr std::array kinds = {
    Kind{Quantity::dimensionless, {}, "dimensionless number", "0.3 or 30 %"},
    Kind{Quantity::time, {0, 0, 1, 0, 0, 0, 0}, "time", "0.5s or 20ms"},
    Kind{Quantity::length, {1, 0, 0, 0, 0, 0, 0}, "length", "15mm or 0.015m"},
    Kind{Quantity::velocity, {1, 0, -1, 0, 0, 0, 0}, "velocity", "6.3mm/s"},
    Kind{Quantity::angular_velocity, {0, 0, -1, 1, 0, 0, 0}, "angular velocity", "4rpm or 0.419rad/s"},
    Kind{Quantity::acceleration, {1, 0, -2, 0, 0, 0, 0}, "acceleration", "0.5m/s^2"},
    Kind{Quantity::force, {1, 1, -2, 0, 0, 0, 0}, "force", "50N"},
    Kind{Quantity::torque, {2, 1, -2, 0, 0, 0, 0}, "torque", "2.5Nm"},
    Kind{Quantity::mass, {0, 1, 0, 0, 0, 0, 0}, "mass", "0.1kg"},
    Kind{Quantity::stiffness, {0, 1, -2, 0, 0, 0, 0}, "stiffness", "12N/mm"},
    Kind{Quantity::damping, {0, 1, -1, 0, 0, 0, 0}, "damping", "3Ns/m"},
    Kind{Quantity::frequency, {0, 0, -1, 0, 0, 0, 1}, "frequency", "20kHz"},
    Kind{Quantity::angle, {0, 0, 0, 1, 0, 0, 0}, "angle", "90deg or 1.57rad"},
    Kind{Quantity::temperature, {0, 0, 0, 0, 1, 0, 0}, "temperature", "23degC"},
    Kind{Quantity::voltage, {0, 0, 0, 0, 0, 1, 0}, "voltage", "10V"},
    Kind{Quantity::inverse_velocity, {-1, 0, 1, 0, 0, 0, 0}, "inverse velocity", "0.05s/mm"},
    Kind{
        Quantity::inverse_square_of_velocity, {-2, 0, 2, 0, 0, 0, 0}, "inverse square of a velocity", "0.0001s^2/mm^2"},
    Kind{Quantity::inverse_length, {-1, 0, 0, 0, 0, 0, 0}, "inverse length", "100/mm"},
    Kind{Quantity::inverse_time, {0, 0, -1, 0, 0, 0, 0}, "inverse time", "0.001 1/s"},
    Kind{Quantity::inverse_temperature, {0, 0, 0, 0, -1, 0, 0}, "inverse temperature", "0.002 1/K"},
    Kind{Quantity::pressure, {-1, 1, -2, 0, 0, 0, 0}, "stress", "5MPa"},
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
    if (name == symbol.name) return Term{symbol.factor, symbol.dimensions};
  }
  for (const Symbol& symbol : symbols) {
    if (name.size() == symbol.name.size() + 1 && name.substr(1) == symbol.name &&
        symbol.prefixes.find(name[0]) != std::string_view::npos) {
      return Term{prefix_factor(name[0]) * symbol.factor, symbol.dimensions};
    }
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
    std::size_t length = 0;
    while (length < rest_.size() &&
           std::string_view(" /*^()-0123456789").find(rest_[length]) == std::string_view::npos) {
      ++length;
    }
    const auto result = find_word(rest_.substr(0, length));
    rest_.remove_prefix(length);
    return result;
  }

  std::string_view rest_;
};

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
  static const std::vector<std::string> names = {
      "s",    "ms",   "us",    "min",      "h",     "m",     "mm",    "um",     "cm",  "in",   "m/s", "mm/s",
      "um/s", "cm/s", "rad/s", "rpm",      "deg/s", "rev/s", "m/s^2", "mm/s^2", "N",   "mN",   "kN",  "MN",
      "kgf",  "gf",   "lbf",   "kip",      "Nm",    "mNm",   "Nmm",   "kNm",    "kg",  "g",    "N/m", "N/mm",
      "kN/m", "Ns/m", "Ns/mm", "Hz",       "kHz",   "MHz",   "rad",   "deg",    "rev", "degC", "K",   "V",
      "mV",   "s/m",  "s/mm",  "s^2/mm^2", "1/m",   "1/mm",  "1/s",   "1/min",  "1/K", "%"};
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
