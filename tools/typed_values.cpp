#include "typed_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <system_error>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

using namespace tribofit;

namespace {

/// The largest value in SI. Each is far beyond what is built or measured: they hold for any rig.
double largest(Quantity quantity) {
  static const std::map<Quantity, double> limits = {{Quantity::time, 1e9},  // thirty years
                                                    {Quantity::length, 1e4},
                                                    {Quantity::velocity, 1e5},  // beyond what leaves the solar system
                                                    {Quantity::angular_velocity, 1e7},
                                                    {Quantity::frequency, 1e10},
                                                    {Quantity::inverse_time, 1e10},
                                                    {Quantity::temperature, 1e5},
                                                    {Quantity::dimensionless, 1e6},
                                                    {Quantity::angle, 1e9}};
  const auto found = limits.find(quantity);
  return found == limits.end() ? 1e15 : found->second;
}

/// The smallest value in SI that is not zero: below it squares and reciprocals leave the range of doubles.
constexpr double kSmallest = 1e-20;

/// A bare 15 is millimetres to one reader and metres to another; 0 is the same in all units but those of temperature.
void refuse_without_unit(std::string_view text, double value, Quantity quantity, const std::string& option) {
  if (quantity == Quantity::dimensionless || (value == 0 && quantity != Quantity::temperature)) return;
  std::string meant;
  for (const std::string& example : split(example_of(quantity), " or "))
    meant += (meant.empty() ? "" : " or ") + std::string(trimmed(text)) +
             example.substr(example.find_first_not_of("0123456789."));
  throw UsageError(fmt::format("{}: '{}' has no unit; write {}", option, trimmed(text), meant));
}

}  // namespace

double stated_value(std::string_view text, Quantity quantity, const std::string& option) {
  const double value = parse_quantity(text, quantity, option);
  if (is_bare_number(text)) refuse_without_unit(text, value, quantity, option);
  const double size = std::abs(value);
  if (size == 0 || (size >= kSmallest && size <= largest(quantity))) return value;
  throw InputError(
      fmt::format("{}: '{}' is {} than any machine has", option, text, size < 1 ? "less" : "more"),
      fmt::format("check the number and its unit; {} such as {} is meant", to_string(quantity), example_of(quantity)));
}

double positive_value(std::string_view text, Quantity quantity, const std::string& option) {
  const double value = stated_value(text, quantity, option);
  if (value > 0) return value;
  throw InputError(fmt::format("{}: '{}' is not greater than zero", option, text),
                   fmt::format("give {} such as {}", with_article(to_string(quantity)), example_of(quantity)));
}

std::string unit_of(std::string_view text) {
  const std::size_t at = text.find_first_not_of("+-.0123456789eE ");
  return at == std::string_view::npos ? "" : std::string(text.substr(at));
}

bool is_bare_number(std::string_view text) {
  return !trimmed(text).empty() && unit_of(text).empty();
}

std::pair<std::string, std::string> range_ends(const std::string& text, const std::string& option,
                                               const std::string& example) {
  const std::vector<std::string> ends = split(text, "..");
  if (ends.size() != 2)
    throw InputError(fmt::format("{}: '{}' is not a range", option, text), "write it as " + example);
  return {is_bare_number(ends[0]) ? ends[0] + unit_of(ends[1]) : ends[0], ends[1]};
}

std::pair<std::string, std::string> two_parts(const std::string& text, std::string_view separator,
                                              const std::string& option, const std::string& example) {
  const std::vector<std::string> parts = split(text, separator);
  if (parts.size() == 2) return {parts[0], parts[1]};
  throw InputError(fmt::format("{}: '{}' does not have two parts", option, text), "write it as " + example);
}

NamedTexts named_texts(const std::vector<std::string>& texts, const std::string& option, const std::string& example) {
  NamedTexts out;
  std::vector<std::string> parts;
  for (const std::string& text : texts) {
    for (std::string& part : split(text, ',')) parts.push_back(std::move(part));
  }
  for (const std::string& part : parts) {
    const std::size_t equals = part.find('=');
    const std::string name(trimmed(std::string_view(part).substr(0, equals)));
    if (equals == std::string::npos || name.empty() || equals + 1 == part.size())
      throw UsageError(fmt::format("{}: '{}' is not {}", option, trimmed(part), example));
    if (std::any_of(out.begin(), out.end(), [&](const auto& known) { return known.first == name; }))
      throw UsageError(fmt::format("{}: '{}' is given twice", option, name));
    out.emplace_back(name, trimmed(std::string_view(part).substr(equals + 1)));
  }
  return out;
}

std::uint64_t stated_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc{} && last == end) return seed;
  throw UsageError("--seed: '" + text + "' is not a whole number from 0 to 18446744073709551615");
}
