#include <fmt/format.h>

#include <cmath>

#include "campaign/described_results.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "rate_state.hpp"

namespace tribofit {
namespace {

constexpr double kUmPerSecond = 1e-6;

Json estimate_of(const Estimate& e, double unit = 1) {
  return object("value", e.value / unit, "std_error", e.std_error / unit);
}

/// In the units in which the parameters are shown: of D and k the search has the covariance of the logarithm.
std::vector<std::vector<double>> covariance_of(const RateStateFit& fit) {
  const std::size_t n = fit.parameters.size();
  std::vector<std::vector<double>> rows(n);
  const auto scale = [&](std::size_t k) {
    const FitParameter& p = fit.parameters[k];
    const bool logarithmic = p.parameter.unit != "1";
    return logarithmic ? shown(p, p.value) : 1.0;
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) rows[i].push_back(scale(i) * scale(j) * fit.covariance[i * n + j]);
  }
  return rows;
}

Json stability_json(const RateStateFit& fit) {
  constexpr double kPerMicrometre = 1e6;
  return object("a_minus_b",
                object("value", fit.rate_dependence.value, "std_error", fit.rate_dependence.std_error, "ci95",
                       interval_json(fit.rate_dependence_lower95, fit.rate_dependence_upper95)),
                "critical_stiffness_per_um", fit.critical_stiffness / kPerMicrometre, "stiffness_over_critical",
                fit.stiffness_ratio, "stiffness_over_critical_ci95",
                std::isfinite(fit.stiffness_ratio)
                    ? interval_json(fit.stiffness_ratio_lower95, fit.stiffness_ratio_upper95)
                    : interval_json(std::nan(""), std::nan("")));
}

Json step_json(const RateStateAnalysis& analysis, std::size_t s, const Motion& motion) {
  const VelocityStep& step = analysis.steps[s];
  Json json = object("time_s", step.time, "time_std_error_s", step.time_std_error, "recorded_time_s", step.recorded,
                     "from_um_s", step.before / kUmPerSecond, "to_um_s", step.after / kUmPerSecond, "hold_s", step.hold,
                     "samples", step.samples, "window_s", interval_json(step.from, step.to));
  const bool whole = analysis.fitted();
  const bool over_time = analysis.detrend == Detrend::time;
  json["mu_0"] = whole ? estimate_of(analysis.fits[analysis.best].base_friction[s]) : Json(nullptr);
  json["trend"] = whole && analysis.detrend != Detrend::none
                      ? estimate_of(analysis.fits[analysis.best].trend[s], over_time ? 1 : 1 / kMillimetre)
                      : Json(nullptr);
  json["own_fit"] = nullptr;
  if (s >= analysis.each.size() || !analysis.each[s].converged) return json;
  const RateStateFit& own = analysis.each[s];
  json["own_fit"] =
      object("parameters", list_of(own.parameters, [&](const FitParameter& p) { return parameter_json(p, motion); }),
             "rmse", own.rmse, "messages", own.messages);
  json["own_fit"].update(stability_json(own));
  return json;
}

Json healing_json(const Healing& healing) {
  return object("holds",
                list_of(healing.holds,
                        [](const HoldMeasures& hold) {
                          return object("step_index", hold.step, "hold_s", hold.duration, "sliding",
                                        estimate_of(hold.sliding), "peak", estimate_of(hold.peak), "healing",
                                        hold.healing, "relaxation", hold.relaxation);
                        }),
                "per_decade", estimate_of(healing.per_decade), "per_decade_model", healing.per_decade_model);
}

}  // namespace

Json rate_state_fits_json(const RateStateAnalysis& analysis, const Motion& motion) {
  return list_of(analysis.fits, [&](const RateStateFit& fit) {
    ResultFit out;
    out.law = law_name(fit.evolution);
    out.protocol = "joint";
    add_parameters(fit.parameters, fit.correlations, motion, out);
    if (fit.converged) out.covariance = covariance_of(fit);
    out.degrees_of_freedom = fit.degrees_of_freedom;
    out.rmse = fit.rmse;
    out.held_out_rmse = fit.held_out_rmse;
    out.floor_rmse = std::hypot(fit.noise_white, fit.noise_slow);
    out.noise = fit.noise_white;
    out.slow_noise = fit.noise_slow;
    out.floor_source = "residuals";
    out.mean_relative = out.max_relative = out.explained = out.stick_creep = out.fastest = std::nan("");
    out.converged = fit.converged;
    out.samples = fit.samples;
    out.messages = fit.messages;
    return json_of(out);
  });
}

Json rate_state_json(const RateStateAnalysis& analysis, const Motion& motion) {
  Json steps = Json::array();
  for (std::size_t s = 0; s < analysis.steps.size(); ++s) steps.push_back(step_json(analysis, s, motion));
  Json json = object("v0_um_s", analysis.reference_speed / kUmPerSecond, "v0_source", analysis.reference_source,
                     "load_point_source", source_text(motion.load_point_source), "detrend", to_string(analysis.detrend),
                     "normal_stress_MPa", motion.normal_stress.value / 1e6, "states",
                     analysis.fits.empty() ? Json(nullptr) : Json(analysis.states), "states_p_value",
                     analysis.states_p_value, "answer_p_value", analysis.answer_p_value, "law_p_value",
                     analysis.law_p_value, "sharing_p_value", analysis.sharing_p_value);
  json["stability"] = analysis.is_answered() ? stability_json(analysis.fits[analysis.best]) : Json(nullptr);
  json["steps"] = std::move(steps);
  json["healing"] = analysis.healing ? healing_json(*analysis.healing) : Json(nullptr);
  json["messages"] = analysis.messages;
  json["reason"] = text_or_null(analysis.reason);
  return json;
}

}  // namespace tribofit
