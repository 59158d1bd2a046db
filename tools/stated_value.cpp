#include "stated_value.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

#include "exit_status.hpp"
#include "tribofit/ingest/input_error.hpp"

using namespace tribofit;

namespace {

/// The largest value in SI. Each is far beyond what is built or measured: they hold for any rig.
double largest(Quantity quantity) {
  switch (quantity) {
    case Quantity::time:
      return 1e9;  // thirty years
    case Quantity::length:
      return 1e4;
    case Quantity::velocity:
      return 1e5;  // beyond what leaves the solar system
    case Quantity::angular_velocity:
      return 1e7;
    case Quantity::frequency:
    case Quantity::inverse_time:
      return 1e10;
    case Quantity::temperature:
      return 1e5;
    case Quantity::dimensionless:
      return 1e6;
    case Quantity::angle:
      return 1e9;
    default:
      return 1e15;
  }
}

/// The smallest value in SI that is not zero: below it squares and reciprocals leave the range of doubles.
constexpr double kSmallest = 1e-20;

}  // namespace

double stated_value(std::string_view text, Quantity quantity, const std::string& option, std::string_view bare_unit) {
  const double value = parse_quantity(text, quantity, option, bare_unit);
  const double size = std::abs(value);
  if (size == 0 || (size >= kSmallest && size <= largest(quantity))) return value;
  throw InputError(
      fmt::format("{}: '{}' is {} than any machine has", option, text, size < 1 ? "less" : "more"),
      fmt::format("check the number and its unit; {} such as {} is meant", to_string(quantity), example_of(quantity)));
}

std::uint64_t stated_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc{} && last == end) return seed;
  throw UsageError("--seed: '" + text + "' is not a whole number from 0 to 18446744073709551615");
}

double given_or(const std::string& text, Quantity quantity, const char* option, std::string_view bare_unit,
                double otherwise) {
  return text.empty() ? otherwise : stated_value(text, quantity, option, bare_unit);
}
