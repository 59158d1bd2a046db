#include "figures_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace tribofit {
namespace {

using Json = nlohmann::json;
using Ordered = nlohmann::ordered_json;

Ordered number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

Ordered numbers(const std::vector<double>& values) {
  Ordered list = Ordered::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

double value_of(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> values_of(const Json& list) {
  std::vector<double> values;
  values.reserve(list.size());
  for (const Json& value : list) values.push_back(value_of(value));
  return values;
}

Ordered curve_json(const ErrorCurve& curve) {
  return {{"law", curve.law},
          {"protocol", curve.protocol},
          {"below_0.08", number(curve.below_limit)},
          {"bins_below_0.08", number(curve.bins_below_limit)},
          {"largest_of_bins", number(curve.largest_of_bins)},
          {"mean_relative", number(curve.mean_relative)},
          {"max_relative", number(curve.max_relative)},
          {"fitted", numbers(curve.fitted)},
          {"bin_mean_relative", numbers(curve.bin_mean_relative)},
          {"bin_max_relative", numbers(curve.bin_max_relative)}};
}

ErrorCurve curve_from(const Json& json) {
  ErrorCurve curve;
  curve.law = json.at("law").get<std::string>();
  curve.protocol = json.at("protocol").get<std::string>();
  curve.below_limit = value_of(json.at("below_0.08"));
  curve.bins_below_limit = value_of(json.at("bins_below_0.08"));
  curve.largest_of_bins = value_of(json.at("largest_of_bins"));
  curve.mean_relative = value_of(json.at("mean_relative"));
  curve.max_relative = value_of(json.at("max_relative"));
  curve.fitted = values_of(json.at("fitted"));
  curve.bin_mean_relative = values_of(json.at("bin_mean_relative"));
  curve.bin_max_relative = values_of(json.at("bin_max_relative"));
  return curve;
}

}  // namespace

std::string figures_text(const RunFigures& figures) {
  Ordered errors = Ordered::array(), harmonics = Ordered::array();
  for (const ErrorCurve& curve : figures.errors) errors.push_back(curve_json(curve));
  for (const Harmonic& line : figures.harmonics) {
    harmonics.push_back({{"frequency_hz", number(line.frequency)}, {"amplitude_mm_s", number(line.amplitude)}});
  }
  const Ordered json = {{"bin_width_mm_s", number(figures.bin_width)},
                        {"bin_samples", figures.bin_samples},
                        {"bin_friction", numbers(figures.bin_friction)},
                        {"errors", std::move(errors)},
                        {"spectrum_step_hz", number(figures.spectrum_step)},
                        {"spectrum_mm_s", numbers(figures.spectrum)},
                        {"harmonics", std::move(harmonics)},
                        {"time_s", numbers(figures.time)},
                        {"velocity_mm_s", numbers(figures.velocity)},
                        {"friction", numbers(figures.friction)}};
  return json.dump();
}

RunFigures figures_from(const Json& json) {
  RunFigures figures;
  figures.bin_width = value_of(json.at("bin_width_mm_s"));
  figures.bin_samples = json.at("bin_samples").get<std::vector<std::size_t>>();
  figures.bin_friction = values_of(json.at("bin_friction"));
  for (const Json& curve : json.at("errors")) figures.errors.push_back(curve_from(curve));
  figures.spectrum_step = value_of(json.at("spectrum_step_hz"));
  figures.spectrum = values_of(json.at("spectrum_mm_s"));
  for (const Json& line : json.at("harmonics")) {
    figures.harmonics.push_back({value_of(line.at("frequency_hz")), value_of(line.at("amplitude_mm_s"))});
  }
  figures.time = values_of(json.at("time_s"));
  figures.velocity = values_of(json.at("velocity_mm_s"));
  figures.friction = values_of(json.at("friction"));
  return figures;
}

}  // namespace tribofit
