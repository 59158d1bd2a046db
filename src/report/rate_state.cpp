#include "rate_state.hpp"

#include <algorithm>
#include <cmath>

#include "campaign/described_results.hpp"
#include "json_parts.hpp"
#include "report_parts.hpp"

namespace tribofit {
namespace {

std::string critical_stiffness_text(const RateStateFit& fit) {
  return fit.states > 1 ? "k_c of two states" : "k_c = (b - a)/D_c";
}

/// " (p = 0.03)".
std::string chance(double p_value) {
  return " (" + p_value_text(p_value) + ")";
}

ReportTable parameter_table_of(const RateStateFit& fit, const Motion& motion) {
  std::vector<ResultParameter> values = results_of(fit.parameters, motion);
  std::vector<std::string> remarks;
  for (std::size_t k = 0; k < values.size(); ++k) remarks.push_back(remarks_on(fit.parameters, fit.correlations, k));
  const Estimate& rate = fit.rate_dependence;
  if (std::isfinite(rate.value)) {
    values.push_back({{rate.value, rate.std_error, fit.rate_dependence_lower95, fit.rate_dependence_upper95},
                      "a - b",
                      friction_unit(motion)});
    remarks.emplace_back();
  }
  const double lower = fit.stiffness_ratio_lower95, upper = fit.stiffness_ratio_upper95;
  if (std::isfinite(fit.stiffness_ratio)) {
    const double std_error = fit.stiffness_ratio * 0.25 * std::log(upper / lower);
    values.push_back({{fit.stiffness_ratio, std_error, lower, upper}, "k/k_c", "1"});
    remarks.push_back(critical_stiffness_text(fit));
  }
  ReportTable table = value_table("parameter", values);
  table.add({"remarks"}, std::move(remarks));
  return table;
}

void add_law(const RateStateAnalysis& analysis, std::size_t k, const Motion& motion, ReportSection& section) {
  const RateStateFit& fit = analysis.fits[k];
  const std::size_t steps = analysis.steps.size();
  section.heading(fmt::format("{} law, {}{}", capitalised(std::string(to_string(fit.evolution))),
                              fit.step     ? fmt::format("step {}", *fit.step + 1)
                              : steps == 1 ? "one step"
                                           : fmt::format("{} steps together", steps),
                              k == analysis.best && analysis.fits.size() > 1 ? " (best)" : ""));
  section.soft(fmt::format("mu = mu_0 + a ln(v/v0) + b ln(v0 theta/D_c){}, {}, dmu/dt = k (v_lp - v)",
                           fit.states > 1 ? " + b_2 ln(v0 theta_2/D_c2)" : "", equation_of(fit.evolution)));
  if (!fit.converged) {
    for (const std::string& message : fit.messages) section.warning(message);
    return;
  }
  section.add(parameter_table_of(fit, motion));
  std::string held, wanders;
  if (std::isfinite(fit.error.held_out_rmse)) held = ", on steps held out " + significant(fit.error.held_out_rmse, 3);
  if (fit.noise_time > 0) {
    wanders = fmt::format(", and {} that wanders over {} s", significant(fit.floor.slow_noise, 2),
                          significant(fit.noise_time, 2));
  }
  section.soft(fmt::format("RMSE {}{}; noise of a sample {}{}.", significant(fit.error.rmse, 3), held,
                           significant(fit.floor.noise, 2), wanders));
  for (const std::string& message : fit.messages) section.item(message);
}

/// That a second state variable was asked for by the data, or not.
std::string states_sentence(const RateStateAnalysis& analysis) {
  if (analysis.second_state == SecondState::not_needed)
    return "A second state variable describes these steps no better than chance would (--states 2 shows it).";
  if (analysis.second_state != SecondState::found) return "";
  if (!std::isfinite(analysis.states_p_value))
    return "Two state variables describe these steps; no fit of one converged.";
  return "A second state variable describes these steps better than one" + chance(analysis.states_p_value) + ".";
}

ReportTable steps_table(const RateStateAnalysis& analysis) {
  ReportTable table("Steps");
  const bool moved =
      !std::ranges::equal(analysis.steps, analysis.steps, {}, &VelocityStep::time, &VelocityStep::recorded);
  const bool over_time = analysis.detrend == Detrend::time;
  table.numbers({"no.", "time [s]"});
  if (moved) table.numbers({"recorded [s]"});
  table.numbers({"from [um/s]", "to [um/s]"}).numbers({"hold [s]", "samples"}, 1);
  table.numbers({"interval [s]"}, 2).numbers({"mu_0"}, 1).numbers({"trend"}, 2);
  const RateStateFit* fit = analysis.fitted() ? &analysis.fits[analysis.best] : nullptr;
  for (std::size_t s = 0; s < analysis.steps.size(); ++s) {
    const VelocityStep& step = analysis.steps[s];
    std::string base, trend;
    if (fit != nullptr) base = estimate_text(fit->base_friction[s]);
    if (fit != nullptr && analysis.detrend != Detrend::none)
      trend = over_time ? estimate_text(fit->trend[s], 1, "1/s") : estimate_text(fit->trend[s], 1e3, "1/mm");
    auto& row = table.rows.emplace_back();
    row = {std::to_string(s + 1),
           std::isfinite(step.time_std_error) ? with_error(step.time, step.time_std_error) : significant(step.time, 6)};
    if (moved) row.push_back(significant(step.recorded, 6));
    row.insert(row.end(), {significant(step.before / kMicrometre, 4), significant(step.after / kMicrometre, 4),
                           step.hold > 0 ? significant(step.hold, 4) : "", grouped(step.samples),
                           significant(step.interval, 3), base, trend});
  }
  return table;
}

ReportTable each_table(const RateStateAnalysis& analysis, const Motion& motion) {
  ReportTable table("Each step by itself");
  table.numbers({"no."});
  for (const FitParameter& p : analysis.fits[analysis.best].parameters)
    table.numbers({with_unit(p.parameter.name, shown_unit(p, motion))});
  table.numbers({"a - b"}).numbers({"k/k_c", "RMSE"}, 1);
  for (const RateStateFit& fit : analysis.each) {
    auto& row = table.rows.emplace_back(1, std::to_string(*fit.step + 1));
    row.resize(fit.converged ? 1 : table.columns.size(), "-");
    if (!fit.converged) continue;
    for (const FitParameter& p : fit.parameters)
      row.push_back(p.determined ? with_error(shown(p, p.value), shown(p, p.std_error)) : "not determined");
    row.push_back(std::isfinite(fit.rate_dependence.value) ? estimate_text(fit.rate_dependence) : "-");
    row.insert(row.end(), {significant(fit.stiffness_ratio, 3), significant(fit.error.rmse, 3)});
  }
  return table;
}

void add_holds(const Healing& healing, ReportSection& section) {
  section.heading("Holds");
  ReportTable table;
  table.numbers({"no.", "hold [s]", "sliding", "peak", "healing", "relaxation"});
  for (const HoldMeasures& hold : healing.holds) {
    table.rows.push_back({std::to_string(hold.step + 1), significant(hold.duration, 4), estimate_text(hold.sliding),
                          estimate_text(hold.peak), significant(hold.healing, 3), significant(hold.relaxation, 3)});
  }
  section.add(std::move(table));
  if (std::isfinite(healing.per_decade.value)) {
    section.plain(fmt::format("Healing rate: {} for a tenfold time at rest; the response that was fitted heals by {}.",
                              estimate_text(healing.per_decade), significant(healing.per_decade_model, 3)));
  } else {
    section.soft("A healing rate needs three holds of different length.");
  }
}

void add_which_law(const RateStateAnalysis& analysis, ReportSection& section) {
  if (analysis.fits.size() != 2 || !std::isfinite(analysis.law_p_value)) return;
  const RateStateFit &best = analysis.fits[analysis.best], &other = analysis.fits[1 - analysis.best];
  const auto against = [](double a, double b) { return significant(a, 4) + " against " + significant(b, 4); };
  std::string figures = "RMSE " + against(best.error.rmse, other.error.rmse);
  if (std::isfinite(best.error.held_out_rmse) && std::isfinite(other.error.held_out_rmse))
    figures += ", on steps held out " + against(best.error.held_out_rmse, other.error.held_out_rmse);
  constexpr double kDistinguished = 0.05;
  const bool lacks = best.lacks.value_or(false), distinguished = analysis.law_p_value < kDistinguished;
  section.heading("Which law");
  section.plain(fmt::format(
      fmt::runtime(lacks ? "Neither law describes these steps; the {0} law is nearer ({2}). Which of them holds can be "
                           "judged once the model has what it lacks."
                   : distinguished
                       ? "The {0} law describes these steps better than the {1} law ({2}, {3})."
                       : "These data do not distinguish the {0} law from the {1} law ({2}, {3}). Steps of a factor of "
                         "ten or more, up and down, would."),
      to_string(best.evolution), to_string(other.evolution), figures, p_value_text(analysis.law_p_value)));
  if (!lacks && !distinguished && std::isfinite(other.rate_dependence.value))
    section.plain(fmt::format("The result below is that of the {} law; by the {} law a - b = {}.",
                              to_string(best.evolution), to_string(other.evolution),
                              estimate_text(other.rate_dependence)));
}

const char* source_text(LoadPointSource source) {
  constexpr const char* kTexts[] = {"stated", "its recorded speed", "its recorded displacement"};
  return kTexts[static_cast<std::size_t>(source)];
}

/// Speeds that last, in order; those of the way from one to the other aside.
std::vector<double> speeds_of(const Motion& motion, const RateStateAnalysis* analysis) {
  std::vector<double> speeds;
  if (analysis == nullptr || analysis->steps.empty()) {
    for (const LoadPointPhase& phase : motion.load_point) speeds.push_back(phase.speed);
    return speeds;
  }
  for (const VelocityStep& step : analysis->steps) {
    if (speeds.empty() || speeds.back() != step.before) speeds.push_back(step.before);
    if (step.hold > 0) speeds.push_back(0);
    speeds.push_back(step.after);
  }
  return speeds;
}

}  // namespace

std::string sliding_speed_text(double speed) {
  if (speed == 0) return "0";
  if (speed < 0.1 * kMicrometre) return brief(1e9 * speed) + " nm/s";
  return speed < kMillimetre ? brief(speed / kMicrometre) + " um/s" : brief(speed / kMillimetre) + " mm/s";
}

Facts load_point_facts(const Motion& motion, const RateStateAnalysis* analysis) {
  constexpr std::size_t kMost = 12;
  std::vector<std::string> speeds;
  const std::vector<double> all = speeds_of(motion, analysis);
  for (std::size_t k = 0; k < std::min(all.size(), kMost); ++k) speeds.push_back(sliding_speed_text(all[k]));
  if (all.size() > kMost) speeds.push_back(fmt::format("... ({} in all)", all.size()));
  Facts facts;
  const auto add = [&](const char* name, const std::string& value, const std::string& source) {
    facts.emplace_back(name, value + " (" + source + ")");
  };
  add("load point", fmt::format("{}", fmt::join(speeds, ", ")), source_text(motion.load_point_source));
  if (const Condition& stress = motion.normal_stress; stress.known())
    add("normal stress", brief(1e-6 * stress.value) + " MPa", stress.source);
  if (analysis == nullptr || !(analysis->reference_speed > 0)) return facts;
  add("v0", sliding_speed_text(analysis->reference_speed), analysis->reference_source);
  const char* line = analysis->detrend == Detrend::none   ? "none is taken off"
                     : analysis->detrend == Detrend::time ? "a line over time is taken off each step"
                                                          : "a line over the displacement of the load point is taken "
                                                            "off each step";
  facts.emplace_back("trend", line);
  return facts;
}

void add_rate_state(const RateStateAnalysis& analysis, const Motion& motion, ReportSection& section) {
  section.add(steps_table(analysis));
  if (analysis.fitted() && !analysis.is_answered()) section.warning(verdict_on(analysis));
  for (std::size_t k = 0; k < analysis.fits.size(); ++k) add_law(analysis, k, motion, section);
  if (!analysis.is_answered()) return;
  add_which_law(analysis, section);
  section.plain(states_sentence(analysis));
  section.add(each_table(analysis, motion));
  if (std::isfinite(analysis.sharing_p_value)) {
    constexpr double kDiffer = 0.01;
    const std::string tested = chance(analysis.sharing_p_value);
    section.plain(analysis.sharing_p_value < kDiffer
                      ? "The steps differ by more than their errors" + tested +
                            ": the values of each step count, and those of all together are a compromise."
                      : "The steps agree within their errors" + tested + ".");
  }
  if (analysis.healing) add_holds(*analysis.healing, section);
}

std::string verdict_on(const RateStateAnalysis& analysis) {
  if (!analysis.fitted()) return capitalised(analysis.reason) + ".";
  const RateStateFit& fit = analysis.fits[analysis.best];
  if (!analysis.is_answered())
    return "Friction answers the steps by no more than noise would" + chance(analysis.answer_p_value) +
           ": these data say nothing of the law.";
  const std::string unknown = "Whether steady friction rises or falls with speed is not known from these data";
  if (!std::isfinite(fit.rate_dependence.value)) return unknown + ": a or b ended at a bound.";
  const std::string rate = " (a - b = " + estimate_text(fit.rate_dependence) + ")";
  const bool rises = fit.rate_dependence_lower95 > 0, two = fit.states > 1,
             limited = std::isfinite(fit.stiffness_ratio);
  if (!rises && !(fit.rate_dependence_upper95 < 0)) return unknown + rate + ".";
  std::string text = fmt::format("Steady friction {} with speed{}", rises ? "rises" : "falls", rate);
  if (!limited && !rises) return text + ": sliding is not stable on a machine that is soft enough.";
  if (!limited)
    return text + ": sliding is stable on any machine" +
           (two ? ", but perhaps a soft one, where the quicker state alone lets it fall." : ", however soft.");
  const FitParameter &distance = fit.parameters[2], &stiffness = fit.parameters.back();
  const std::string& unit = stiffness.parameter.unit;
  text += fmt::format("{} sliding is unstable, and sticks and slips, on a machine softer than {}{} {} {}{}",
                      rises ? ", and yet" : ":", critical_stiffness_text(fit), two ? "," : " =",
                      significant(fit.critical_stiffness * kMicrometre, 3), unit,
                      unit == "1/um" ? " per normal force" : "");
  if (!stiffness.determined || !distance.determined) return text + "; k of this one is not resolved.";
  // With two states it rises while the quick one alone falls.
  return text + fmt::format(fmt::runtime(fit.stiffness_ratio_lower95 > 1
                                             ? ". This machine is {0} times as stiff: it slides steadily."
                                         : fit.stiffness_ratio_upper95 < 1
                                             ? ". This machine has {0} of that: it {1} stick and slip (--kind "
                                               "stick-slip)."
                                             : ". This machine has {0} of that, which the data do not tell from the "
                                               "critical stiffness."),
                            significant(fit.stiffness_ratio, 3), rises ? "may" : "will");
}

namespace {

Json estimate_of(const Estimate& e, double unit = 1) {
  return object("value", e.value / unit, "std_error", e.std_error / unit);
}

Json stability_json(const RateStateFit& fit) {
  const bool limited = std::isfinite(fit.stiffness_ratio);
  Json rate = estimate_of(fit.rate_dependence);
  rate["ci95"] = interval_json(fit.rate_dependence_lower95, fit.rate_dependence_upper95);
  return object("a_minus_b", rate, "critical_stiffness_per_um", fit.critical_stiffness / 1e6, "stiffness_over_critical",
                fit.stiffness_ratio, "stiffness_over_critical_ci95",
                interval_json(limited ? fit.stiffness_ratio_lower95 : std::nan(""),
                              limited ? fit.stiffness_ratio_upper95 : std::nan("")));
}

Json step_json(const RateStateAnalysis& analysis, std::size_t s, const Motion& motion) {
  const VelocityStep& step = analysis.steps[s];
  const RateStateFit* whole = analysis.fitted() ? &analysis.fits[analysis.best] : nullptr;
  const bool trended = whole != nullptr && analysis.detrend != Detrend::none;
  const RateStateFit* own = s < analysis.each.size() && analysis.each[s].converged ? &analysis.each[s] : nullptr;
  Json json = object("time_s", step.time, "time_std_error_s", step.time_std_error, "recorded_time_s", step.recorded,
                     "from_um_s", step.before / kMicrometre, "to_um_s", step.after / kMicrometre, "hold_s", step.hold,
                     "samples", step.samples, "window_s", interval_json(step.from, step.to), "mu_0", nullptr, "trend",
                     nullptr, "own_fit", nullptr);
  if (whole != nullptr) json["mu_0"] = estimate_of(whole->base_friction[s]);
  if (trended) json["trend"] = estimate_of(whole->trend[s], analysis.detrend == Detrend::time ? 1 : 1 / kMillimetre);
  if (own == nullptr) return json;
  json["own_fit"] = object("parameters", json_of(results_of(own->parameters, motion)), "rmse", own->error.rmse,
                           "messages", own->messages);
  json["own_fit"].update(stability_json(*own));
  return json;
}

Json healing_json(const Healing& healing) {
  const auto hold = [](const HoldMeasures& h) {
    return object("step_index", h.step, "hold_s", h.duration, "sliding", estimate_of(h.sliding), "peak",
                  estimate_of(h.peak), "healing", h.healing, "relaxation", h.relaxation);
  };
  return object("holds", list_of(healing.holds, hold), "per_decade", estimate_of(healing.per_decade),
                "per_decade_model", healing.per_decade_model);
}

}  // namespace

Json rate_state_fits_json(const RateStateAnalysis& analysis, const Motion& motion) {
  return list_of(analysis.fits, [&](const RateStateFit& fit) {
    ResultFit out;
    static_cast<FitSummary&>(out) = fit;
    out.law = law_name(fit.evolution);
    out.protocol = "joint";
    add_parameters(fit.parameters, fit.correlations, motion, out);
    const std::size_t n = fit.parameters.size();
    // In the units shown: of D and k the search has the covariance of the logarithm.
    const auto scale = [&](std::size_t k) {
      const FitParameter& p = fit.parameters[k];
      return p.parameter.unit != "1" ? shown(p, p.value) : 1.0;
    };
    out.covariance.resize(fit.converged ? n : 0);
    for (std::size_t i = 0; i < out.covariance.size(); ++i) {
      for (std::size_t j = 0; j < n; ++j) out.covariance[i].push_back(scale(i) * scale(j) * fit.covariance[i * n + j]);
    }
    out.samples = fit.samples;
    return json_of(out);
  });
}

Json rate_state_json(const RateStateAnalysis& analysis, const Motion& motion) {
  const bool none = analysis.fits.empty();
  Json steps = Json::array();
  for (std::size_t s = 0; s < analysis.steps.size(); ++s) steps.push_back(step_json(analysis, s, motion));
  return object("v0_um_s", analysis.reference_speed / kMicrometre, "v0_source", analysis.reference_source,
                "load_point_source", source_text(motion.load_point_source), "detrend", to_string(analysis.detrend),
                "normal_stress_MPa", motion.normal_stress.value / 1e6, "states",
                none ? Json(nullptr) : Json(analysis.states), "states_p_value", analysis.states_p_value,
                "answer_p_value", analysis.answer_p_value, "law_p_value", analysis.law_p_value, "sharing_p_value",
                analysis.sharing_p_value, "stability",
                analysis.is_answered() ? stability_json(analysis.fits[analysis.best]) : Json(nullptr), "steps",
                std::move(steps), "healing", analysis.healing ? healing_json(*analysis.healing) : Json(nullptr),
                "messages", analysis.messages, "reason", text_or_null(analysis.reason));
}

}  // namespace tribofit
