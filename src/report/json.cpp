#include "tribofit/report/json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "json_parts.hpp"
#include "measures.hpp"
#include "numbers.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

Json interval(double lower, double upper) {
  return Json::array({number(lower), number(upper)});
}

std::string_view name_of(HealthItem::Status status) {
  switch (status) {
    case HealthItem::Status::ok:
      return "ok";
    case HealthItem::Status::warning:
      return "warning";
    case HealthItem::Status::problem:
      break;
  }
  return "problem";
}

Json measure_json(const Estimate& measure, double unit) {
  const Interval ci = interval_of(measure);
  return {{"value", number(measure.value / unit)},
          {"std_error", number(measure.std_error / unit)},
          {"ci95", interval(ci.lower / unit, ci.upper / unit)}};
}

std::string_view name_of(MotionKind kind) {
  switch (kind) {
    case MotionKind::stick_slip:
      return "stick-slip";
    case MotionKind::always_slipping:
      return "always-slipping";
    case MotionKind::always_sticking:
      break;
  }
  return "always-sticking";
}

}  // namespace

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json tool_json(const JsonOptions& options) {
  return {{"name", "tribofit"}, {"version", version}, {"arguments", options.arguments}};
}

Json conditions_json(const Conditions& conditions) {
  return {{"radius_mm", number(conditions.radius.value / kMillimetre)},
          {"speed_rpm", number(conditions.speed.value / kRpm)},
          {"speed_source", text_or_null(conditions.speed.source)},
          {"load_N", number(conditions.load.value)},
          {"radius_source", text_or_null(conditions.radius.source)},
          {"load_source", text_or_null(conditions.load.source)}};
}

Json trace_json(const Identification& result) {
  return {{"path", result.path},
          {"samples", result.samples},
          {"duration_s", number(result.duration)},
          {"rate_hz", number(result.rate)},
          {"checksum", fmt::format("{:016x}", result.checksum)},
          {"friction_unit", friction_unit(result.motion)},
          {"trimmed_s", number(static_cast<double>(result.motion.trimmed) * result.motion.step)},
          {"notes", result.notes}};
}

Json conditions_of(const Motion& motion) {
  Json json = conditions_json(motion.conditions);
  if (motion.steps.size() < 2) return json;
  Json steps = Json::array();
  for (const Step& step : motion.steps) {
    Json item = {{"label", step.label}, {"begin", step.begin}, {"end", step.end}};
    item.update(conditions_json(step.conditions));
    steps.push_back(std::move(item));
  }
  json["steps"] = std::move(steps);
  return json;
}

Json health_json(const Motion& motion) {
  Json items = Json::array();
  for (const HealthItem& item : motion.health) {
    items.push_back({{"check", item.check}, {"status", name_of(item.status)}, {"message", item.message}});
  }
  return items;
}

Json stick_slip_json(const Identification& result) {
  const Segmentation& s = result.segmentation;
  Json json = {{"cycles", count_of_cycles(s)},
               {"frequency_hz", measure_json(s.frequency, 1)},
               {"amplitude_mm_s", number(s.amplitude.value / kMillimetre)},
               {"rms_velocity_mm_s", number(s.rms_velocity / kMillimetre)},
               {"stick_time_s", number(s.stick_time.value)},
               {"amplitude_std_error_mm_s", number(s.amplitude.std_error / kMillimetre)},
               {"stick_time_std_error_s", number(s.stick_time.std_error)},
               {"slip_time_s", number(s.slip_time.value)},
               {"slip_time_std_error_s", number(s.slip_time.std_error)},
               {"slips", s.cycles.size()},
               {"sticks_over_1_s", long_sticks(s).count},
               {"longest_stick_s", number(long_sticks(s).longest)},
               {"branch_difference", number(s.branch_difference.value)},
               {"branch_difference_std_error", number(s.branch_difference.std_error)},
               {"motion", name_of(s.kind)},
               {"notes", s.notes}};
  const SpectralPeak& peak = result.spectral_peak;
  json["spectrum"] = {{"peak_hz", number(peak.frequency)},
                      {"amplitude_mm_s", number(peak.amplitude / kMillimetre)},
                      {"plain_fft_bin_hz", number(peak.bin_frequency)},
                      {"plain_fft_bin_width_hz", number(peak.bin_width)}};
  return json;
}

Json parameter_json(const FitParameter& p, const Motion& motion) {
  const auto in_unit = [&](double si) { return number(shown(p, si)); };
  return {{"name", p.parameter.name},
          {"value", in_unit(p.value)},
          {"std_error", in_unit(p.std_error)},
          {"ci95", Json::array({in_unit(p.lower95), in_unit(p.upper95)})},
          {"unit", shown_unit(p, motion)},
          {"effect", text_or_null(p.effect)},
          {"systematic_error", p.systematic > 0 ? in_unit(p.systematic) : Json(nullptr)},  // none: not declared
          {"profile_ci95", Json::array({in_unit(p.profile_lower95), in_unit(p.profile_upper95)})},
          {"start", in_unit(p.start)},
          {"bounds", Json::array({number(p.parameter.lower), number(p.parameter.upper)})},
          {"at_bound", p.at_bound},
          {"determined", p.determined}};
}

namespace {

/// In the units in which the parameters are shown; empty where it is not known.
Json covariance_json(const Fit& fit) {
  Json rows = Json::array();
  const std::size_t n = fit.parameters.size();
  if (fit.covariance.size() != n * n) return rows;
  for (std::size_t i = 0; i < n; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < n; ++j) {
      row.push_back(number(shown(fit.parameters[i], shown(fit.parameters[j], fit.covariance[i * n + j]))));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json fit_json(const Fit& fit, const Motion& motion) {
  Json parameters = Json::array();
  for (const FitParameter& p : fit.parameters) parameters.push_back(parameter_json(p, motion));
  Json correlations = Json::array();
  for (const Correlation& c : fit.correlations) {
    correlations.push_back(
        {{"parameters", {fit.parameters[c.first].parameter.name, fit.parameters[c.second].parameter.name}},
         {"value", number(c.value)}});
  }
  return {{"law", to_string(fit.model.law())},
          {"protocol", to_string(fit.protocol)},
          {"effects", fit.model.effect_keys()},
          {"effect_names", fit.model.effect_names()},
          {"parameters", std::move(parameters)},
          {"error",
           {{"rmse", number(fit.error.rmse)},
            {"mean_relative", number(fit.error.mean_relative)},
            {"max_relative", number(fit.error.max_relative)},
            {"held_out_rmse", number(fit.error.held_out_rmse)}}},
          {"floor_rmse", number(fit.floor.rmse)},
          {"converged", fit.converged},
          {"messages", fit.messages},
          {"floor",
           {{"noise", number(fit.floor.noise)}, {"scatter", number(fit.floor.scatter)}, {"source", fit.floor.source}}},
          {"explained", number(fit.explained)},
          {"stick_creep_rmse_mm_s", number(fit.stick_rmse / kMillimetre)},
          {"fastest_mm_s", number(fit.fastest / kMillimetre)},
          {"samples", fit.observations},
          {"cycles", fit.cycles},
          {"correlations", std::move(correlations)},
          {"covariance", covariance_json(fit)},
          {"degrees_of_freedom", number(fit.degrees_of_freedom)}};
}

Json comparison_json(const LawComparison& c) {
  return {{"first", c.first},
          {"second", c.second},
          {"difference", number(c.comparison.difference)},
          {"std_error", number(c.comparison.std_error)},
          {"p_value", number(c.comparison.p_value)},
          {"first_better", c.comparison.first_better}};
}

}  // namespace

Json fits_json(std::span<const Fit> fits, const Motion& motion) {
  Json list = Json::array();
  for (const Fit& fit : fits) list.push_back(fit_json(fit, motion));
  return list;
}

Json comparisons_json(std::span<const Fit> fits, std::size_t best) {
  Json list = Json::array();
  for (const LawComparison& c : compare_laws(fits, best)) list.push_back(comparison_json(c));
  return list;
}

std::string text_of(const Json& json) {
  // File names and headers need not be valid UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json identification_json(const Identification& result, const JsonOptions& options) {
  return {{"tool", tool_json(options)},
          {"trace", trace_json(result)},
          {"conditions", conditions_of(result.motion)},
          {"health", health_json(result.motion)},
          {"stick_slip", stick_slip_json(result)},
          {"fits", fits_json(result.fits, result.motion)},
          {"best", result.fits.empty() ? Json(nullptr) : Json(result.best)},
          {"law_comparison", comparisons_json(result.fits, result.best)},
          {"analysed", result.analysed},
          {"warnings", result.warnings}};
}

std::string to_json(const Identification& result, const JsonOptions& options) {
  return text_of(identification_json(result, options));
}

}  // namespace tribofit
