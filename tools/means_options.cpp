#include "means_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "stated_value.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/study/sweep.hpp"

using namespace tribofit;

namespace {

constexpr std::size_t kLevelsOfRange = 4;  // 1rpm..8rpm: 1, 2, 4 and 8 rpm

std::vector<std::string> parts_of(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t at; (at = text.find(separator, begin)) != std::string::npos; begin = at + separator.size()) {
    parts.push_back(text.substr(begin, at - begin));
  }
  parts.push_back(text.substr(begin));
  return parts;
}

/// One value with its unit, greater than zero. A bare number would be taken in SI, which nobody means here.
double value_of(const std::string& text, Quantity quantity, const std::string& option) {
  const bool is_bare = !text.empty() && text.find_first_not_of("+-.0123456789eE ") == std::string::npos;
  if (text.empty() || is_bare) {
    throw InputError(fmt::format("{}: '{}' has no {}", option, text, text.empty() ? "value" : "unit"),
                     fmt::format("write it as {}", example_of(quantity)));
  }
  const double value = stated_value(text, quantity, option);
  if (value > 0) return value;
  throw InputError(fmt::format("{}: '{}' is not greater than zero", option, text),
                   fmt::format("give {} such as {}", to_string(quantity), example_of(quantity)));
}

/// A number as a person sets it: of two digits, within 5 %.
double two_digits(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  return std::round(x / unit) * unit;
}

/// "1rpm..8rpm" as a few values in equal ratios, those between the ends of two digits in the unit of the range where
/// that keeps them apart, or "9mm,12mm" as they are. Empty: none.
template <class ValueOf>
std::vector<double> values_of(const std::string& text, const std::string& option, ValueOf&& value) {
  if (text.empty()) return {};
  const std::vector<std::string> ends = parts_of(text, "..");
  if (ends.size() == 1) {
    std::vector<double> values;
    for (const std::string& part : parts_of(text, ",")) values.push_back(value(part));
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
  }
  if (ends.size() != 2)
    throw InputError(option + ": '" + text + "' is not a range", "write it as 1rpm..8rpm, or as a list 1rpm,2rpm,8rpm");
  // The unit may stand behind the upper end alone: 1..8rpm.
  const auto is_bare = [](const std::string& end) {
    return !end.empty() && end.find_first_not_of("+-.0123456789eE ") == std::string::npos;
  };
  std::string lower = ends[0];
  if (is_bare(lower)) lower += ends[1].substr(std::min(ends[1].size(), ends[1].find_first_not_of("+-.0123456789eE ")));
  const double low = value(lower), high = value(ends[1]);
  if (!(high > low)) throw InputError(option + ": '" + text + "' does not rise", "write the lower value first");
  std::vector<double> levels = evenly_spaced(low, high, kLevelsOfRange, true);
  const double unit = low / std::stod(lower);
  for (std::size_t k = 1; high > 1.5 * low && k + 1 < levels.size(); ++k)
    levels[k] = unit * two_digits(levels[k] / unit);
  return levels;
}

std::vector<double> values_of(const std::string& text, Quantity quantity, const std::string& option) {
  return values_of(text, option, [&](const std::string& part) { return value_of(part, quantity, option); });
}

/// Of the disc, or at the radius.
double disc_speed(const std::string& text, const std::string& radius) {
  const std::string option = "--speeds";
  const std::size_t unit_at = text.find_first_not_of("+-.0123456789eE ");
  const std::string unit = unit_at == std::string::npos ? "" : text.substr(unit_at);
  if (find_unit(unit, Quantity::velocity) && !find_unit(unit, Quantity::angular_velocity)) {
    if (radius.empty())
      throw InputError(option + ": '" + text + "' is a speed at the radius, which is not known",
                       "give --radius 15mm, or speeds in rpm");
    return value_of(text, Quantity::velocity, option) / stated_value(radius, Quantity::length, "--radius");
  }
  return value_of(text, Quantity::angular_velocity, option);
}

}  // namespace

void add_means_options(const Command& app, MeansOptions& m) {
  const auto add = [&](const char* name, std::string& value, const char* help) {
    app.add_option(name, value, help).group(section::kMeans);
  };
  add("--speeds", m.speeds, "Disc speeds, a range 1rpm..8rpm or a list 1rpm,8rpm");
  add("--radii", m.radii, "Friction radii, 9mm,12mm,18mm");
  add("--loads", m.loads, "Normal forces, 20N..100N");
  add("--springs", m.springs, "Other springs, by their stiffness, 5N/mm,20N/mm");
  add("--rates", m.rates, "Rates of sampling, 50kHz");
  add("--minutes", m.minutes, "Longest time of all runs of an experiment together (default 10)");
  add("--pauses", m.pauses, "The disc can be stopped between slides, for up to 100s");
  add("--mass-below", m.mass_below, "Mass that can be added below the force sensor, 100g");
  app.add_flag("--reversing", m.reversing, "The disc can turn forth and back").group(section::kMeans);
  app.add_flag("--tap", m.tap, "The block can be tapped, and both channels recorded").group(section::kMeans);
  app.add_flag("--lift", m.lift, "The block can be lifted off the disc, and the force sensor read")
      .group(section::kMeans);
  app.add_flag("--accelerometer", m.accelerometer, "There is an accelerometer for the block").group(section::kMeans);
}

Means means_from(const MeansOptions& m, const std::string& radius) {
  Means means;
  means.speeds = values_of(m.speeds, "--speeds", [&](const std::string& part) { return disc_speed(part, radius); });
  means.radii = values_of(m.radii, Quantity::length, "--radii");
  means.loads = values_of(m.loads, Quantity::force, "--loads");
  means.springs = values_of(m.springs, Quantity::stiffness, "--springs");
  means.rates = values_of(m.rates, Quantity::frequency, "--rates");
  const std::vector<double> pauses = values_of(m.pauses, Quantity::time, "--pauses");
  if (!pauses.empty()) means.longest_pause = pauses.back();
  if (!m.mass_below.empty()) means.mass_below = value_of(m.mass_below, Quantity::mass, "--mass-below");
  if (!m.minutes.empty()) {
    const bool is_bare = m.minutes.find_first_not_of("+-.0123456789eE ") == std::string::npos;
    means.longest = stated_value(is_bare ? m.minutes + "min" : m.minutes, Quantity::time, "--minutes");
    if (!(means.longest > 0))
      throw InputError("--minutes: '" + m.minutes + "' is no time to measure in", "give it as e.g. 10");
  }
  means.reversing = m.reversing;
  means.tap = m.tap;
  means.lift = m.lift;
  means.accelerometer = m.accelerometer;
  return means;
}
