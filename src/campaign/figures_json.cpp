#include "figures_json.hpp"

#include <limits>

#include "output/json.hpp"

namespace tribofit {
namespace {

constexpr int kDigits = 6;

Json numbers(const std::vector<double>& values) {
  return rounded_list(values, kDigits);
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

Json curve_json(const ErrorCurve& curve) {
  return object("law", curve.law, "protocol", curve.protocol, "below_0.08", rounded(curve.below_limit, kDigits),
                "bins_below_0.08", rounded(curve.bins_below_limit, kDigits), "largest_of_bins",
                rounded(curve.largest_of_bins, kDigits), "mean_relative", rounded(curve.mean_relative, kDigits),
                "max_relative", rounded(curve.max_relative, kDigits), "fitted", numbers(curve.fitted),
                "bin_mean_relative", numbers(curve.bin_mean_relative), "bin_max_relative",
                numbers(curve.bin_max_relative));
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
  const auto harmonic = [](const Harmonic& line) {
    return object("frequency_hz", rounded(line.frequency, kDigits), "amplitude_mm_s", rounded(line.amplitude, kDigits));
  };
  return line_of(object("bin_width_mm_s", rounded(figures.bin_width, kDigits), "bin_samples", figures.bin_samples,
                        "bin_friction", numbers(figures.bin_friction), "errors", list_of(figures.errors, curve_json),
                        "spectrum_step_hz", rounded(figures.spectrum_step, kDigits), "spectrum_mm_s",
                        numbers(figures.spectrum), "harmonics", list_of(figures.harmonics, harmonic), "time_s",
                        numbers(figures.time), "velocity_mm_s", numbers(figures.velocity), "friction",
                        numbers(figures.friction)));
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
