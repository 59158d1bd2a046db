#include "rate_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "numbers.hpp"
#include "report_parts.hpp"

namespace tribofit {
namespace {

constexpr double kMicrometre = 1e-6;

std::string of_steps(const RateStateFit& fit, std::size_t steps) {
  if (fit.step) return fmt::format("step {}", *fit.step + 1);
  return steps == 1 ? "one step" : fmt::format("{} steps together", steps);
}

std::string critical_stiffness_text(const RateStateFit& fit) {
  return fit.states > 1 ? "k_c of two states" : "k_c = (b - a)/D_c";
}

ReportTable parameter_table_of(const RateStateFit& fit, const Motion& motion) {
  std::vector<ShownValue> values = shown_values(fit.parameters, motion);
  std::vector<std::string> remarks;
  for (std::size_t k = 0; k < values.size(); ++k) remarks.push_back(remarks_on(fit.parameters, fit.correlations, k));
  const Estimate& rate = fit.rate_dependence;
  if (std::isfinite(rate.value)) {
    values.push_back({"a - b", rate.value, rate.std_error, fit.rate_dependence_lower95, fit.rate_dependence_upper95,
                      friction_unit(motion)});
    remarks.emplace_back();
  }
  if (std::isfinite(fit.stiffness_ratio)) {
    const double half = 0.25 * std::log(fit.stiffness_ratio_upper95 / fit.stiffness_ratio_lower95);
    values.push_back({"k/k_c", fit.stiffness_ratio, fit.stiffness_ratio * half, fit.stiffness_ratio_lower95,
                      fit.stiffness_ratio_upper95, "1"});
    remarks.push_back(critical_stiffness_text(fit));
  }
  ReportTable table = value_table("parameter", values);
  table.add({"remarks"}, std::move(remarks));
  return table;
}

void add_law(const RateStateAnalysis& analysis, std::size_t k, const Motion& motion, ReportSection& section) {
  const RateStateFit& fit = analysis.fits[k];
  const bool best = k == analysis.best && analysis.fits.size() > 1;
  section.heading(fmt::format("{} law, {}{}", capitalised(std::string(to_string(fit.evolution))),
                              of_steps(fit, analysis.steps.size()), best ? " (best)" : ""));
  const bool two = fit.states > 1;
  section.soft(fmt::format("mu = mu_0 + a ln(v/v0) + b ln(v0 theta/D_c){}, {}, dmu/dt = k (v_lp - v)",
                           two ? " + b_2 ln(v0 theta_2/D_c2)" : "", equation_of(fit.evolution)));
  if (!fit.converged) {
    for (const std::string& message : fit.messages) section.warning(message);
    return;
  }
  section.add(parameter_table_of(fit, motion));
  const std::string held =
      std::isfinite(fit.held_out_rmse) ? ", on steps held out " + significant(fit.held_out_rmse, 3) : "";
  const std::string wanders = fit.noise_time > 0
                                  ? fmt::format(", and {} that wanders over {} s", significant(fit.noise_slow, 2),
                                                significant(fit.noise_time, 2))
                                  : "";
  section.soft(fmt::format("RMSE {}{}; noise of a sample {}{}.", significant(fit.rmse, 3), held,
                           significant(fit.noise_white, 2), wanders));
  for (const std::string& message : fit.messages) section.item(message);
}

/// That a second state variable was asked for by the data, or not.
void add_states(const RateStateAnalysis& analysis, ReportSection& section) {
  if (analysis.second_state == SecondState::found) {
    section.plain(std::isfinite(analysis.states_p_value)
                      ? fmt::format("A second state variable describes these steps better than one ({}).",
                                    p_value_text(analysis.states_p_value))
                      : "Two state variables describe these steps; no fit of one converged.");
  }
  if (analysis.second_state == SecondState::not_needed)
    section.plain("A second state variable describes these steps no better than chance would (--states 2 shows it).");
}

ReportTable steps_table(const RateStateAnalysis& analysis) {
  ReportTable table("Steps");
  const bool moved = std::any_of(analysis.steps.begin(), analysis.steps.end(),
                                 [](const VelocityStep& step) { return step.time != step.recorded; });
  table.numbers({"no."}).numbers({"time [s]"});
  if (moved) table.numbers({"recorded [s]"});
  table.numbers({"from [um/s]", "to [um/s]"})
      .numbers({"hold [s]"}, 1)
      .numbers({"samples"}, 1)
      .numbers({"interval [s]"}, 2)
      .numbers({"mu_0"}, 1)
      .numbers({"trend"}, 2);
  const RateStateFit* fit = analysis.fitted() ? &analysis.fits[analysis.best] : nullptr;
  for (std::size_t s = 0; s < analysis.steps.size(); ++s) {
    const VelocityStep& step = analysis.steps[s];
    const bool over_time = analysis.detrend == Detrend::time;
    const double unit = over_time ? 1 : 1 / kMillimetre;
    std::string base, trend;
    if (fit != nullptr) {
      base = with_error(fit->base_friction[s].value, fit->base_friction[s].std_error);
      if (analysis.detrend != Detrend::none)
        trend = with_error(fit->trend[s].value / unit, fit->trend[s].std_error / unit) + (over_time ? " 1/s" : " 1/mm");
    }
    std::vector<std::string> row = {std::to_string(s + 1)};
    row.push_back(std::isfinite(step.time_std_error) ? with_error(step.time, step.time_std_error)
                                                     : significant(step.time, 6));
    if (moved) row.push_back(significant(step.recorded, 6));
    row.insert(row.end(), {significant(step.before / kMicrometre, 4), significant(step.after / kMicrometre, 4),
                           step.hold > 0 ? significant(step.hold, 4) : "", grouped(step.samples),
                           significant(step.interval, 3), base, trend});
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable each_table(const RateStateAnalysis& analysis, const Motion& motion) {
  ReportTable table("Each step by itself");
  table.numbers({"no."});
  for (const FitParameter& p : analysis.fits[analysis.best].parameters)
    table.numbers({with_unit(p.parameter.name, shown_unit(p, motion))});
  table.numbers({"a - b"}).numbers({"k/k_c"}, 1).numbers({"RMSE"}, 1);
  for (const RateStateFit& fit : analysis.each) {
    std::vector<std::string> row = {std::to_string(*fit.step + 1)};
    if (!fit.converged) {
      row.resize(table.columns.size(), "-");
      table.rows.push_back(std::move(row));
      continue;
    }
    for (const FitParameter& p : fit.parameters)
      row.push_back(p.determined ? with_error(shown(p, p.value), shown(p, p.std_error)) : "not determined");
    row.push_back(std::isfinite(fit.rate_dependence.value)
                      ? with_error(fit.rate_dependence.value, fit.rate_dependence.std_error)
                      : "-");
    row.push_back(std::isfinite(fit.stiffness_ratio) ? significant(fit.stiffness_ratio, 3) : "-");
    row.push_back(significant(fit.rmse, 3));
    table.rows.push_back(std::move(row));
  }
  return table;
}

void add_holds(const Healing& healing, ReportSection& section) {
  section.heading("Holds");
  ReportTable table;
  table.numbers({"no.", "hold [s]", "sliding", "peak", "healing", "relaxation"});
  for (const HoldMeasures& hold : healing.holds) {
    table.rows.push_back({std::to_string(hold.step + 1), significant(hold.duration, 4),
                          with_error(hold.sliding.value, hold.sliding.std_error),
                          with_error(hold.peak.value, hold.peak.std_error), significant(hold.healing, 3),
                          significant(hold.relaxation, 3)});
  }
  section.add(std::move(table));
  if (!std::isfinite(healing.per_decade.value)) {
    section.soft("A healing rate needs three holds of different length.");
    return;
  }
  section.plain(fmt::format("Healing rate: {} for a tenfold time at rest; the response that was fitted heals by {}.",
                            with_error(healing.per_decade.value, healing.per_decade.std_error),
                            significant(healing.per_decade_model, 3)));
}

void add_which_law(const RateStateAnalysis& analysis, ReportSection& section) {
  if (analysis.fits.size() != 2 || !std::isfinite(analysis.law_p_value)) return;
  const RateStateFit &best = analysis.fits[analysis.best], &other = analysis.fits[1 - analysis.best];
  const bool held = std::isfinite(best.held_out_rmse) && std::isfinite(other.held_out_rmse);
  const std::string figures =
      fmt::format("RMSE {} against {}{}", significant(best.rmse, 4), significant(other.rmse, 4),
                  held ? fmt::format(", on steps held out {} against {}", significant(best.held_out_rmse, 4),
                                     significant(other.held_out_rmse, 4))
                       : "");
  const std::string p_value = p_value_text(analysis.law_p_value);
  section.heading("Which law");
  if (best.lacks.value_or(false)) {
    section.plain(
        fmt::format("Neither law describes these steps; the {} law is nearer ({}). Which of them holds can be "
                    "judged once the model has what it lacks.",
                    to_string(best.evolution), figures));
    return;
  }
  constexpr double kDistinguished = 0.05;
  const bool distinguished = analysis.law_p_value < kDistinguished;
  section.plain(
      distinguished
          ? fmt::format("The {} law describes these steps better than the {} law ({}, {}).", to_string(best.evolution),
                        to_string(other.evolution), figures, p_value)
          : fmt::format("These data do not distinguish the {} law from the {} law ({}, {}). Steps of a factor "
                        "of ten or more, up and down, would.",
                        to_string(best.evolution), to_string(other.evolution), figures, p_value));
  if (!distinguished && std::isfinite(other.rate_dependence.value))
    section.plain(fmt::format("The result below is that of the {} law; by the {} law a - b = {}.",
                              to_string(best.evolution), to_string(other.evolution),
                              with_error(other.rate_dependence.value, other.rate_dependence.std_error)));
}

}  // namespace

std::string source_text(LoadPointSource source) {
  constexpr std::array<const char*, 3> kTexts = {"stated", "its recorded speed", "its recorded displacement"};
  return kTexts.at(static_cast<std::size_t>(source));
}

std::string sliding_speed_text(double speed) {
  if (speed == 0) return "0";
  if (speed < 0.1 * kMicrometre) return brief(1e9 * speed) + " nm/s";
  return speed < kMillimetre ? brief(speed / kMicrometre) + " um/s" : brief(speed / kMillimetre) + " mm/s";
}

namespace {

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

Facts load_point_facts(const Motion& motion, const RateStateAnalysis* analysis) {
  constexpr std::size_t kMost = 12;
  std::vector<std::string> speeds;
  const std::vector<double> all = speeds_of(motion, analysis);
  for (const double speed : all) {
    if (speeds.size() < kMost) speeds.push_back(sliding_speed_text(speed));
  }
  if (all.size() > kMost) speeds.push_back(fmt::format("... ({} in all)", all.size()));
  Facts facts = {
      {"load point", fmt::format("{} ({})", fmt::join(speeds, ", "), source_text(motion.load_point_source))}};
  if (motion.normal_stress.known())
    facts.emplace_back("normal stress", fmt::format("{} MPa ({})", brief(1e-6 * motion.normal_stress.value),
                                                    motion.normal_stress.source));
  if (analysis == nullptr || !(analysis->reference_speed > 0)) return facts;
  facts.emplace_back("v0",
                     fmt::format("{} ({})", sliding_speed_text(analysis->reference_speed), analysis->reference_source));
  const bool none = analysis->detrend == Detrend::none;
  facts.emplace_back(
      "trend", none ? "none is taken off"
                    : fmt::format("a line over {} is taken off each step",
                                  analysis->detrend == Detrend::time ? "time" : "the displacement of the load point"));
  return facts;
}

void add_rate_state(const RateStateAnalysis& analysis, const Motion& motion, ReportSection& section) {
  section.add(steps_table(analysis));
  if (analysis.fitted() && !analysis.is_answered()) section.warning(verdict_on(analysis));
  for (std::size_t k = 0; k < analysis.fits.size(); ++k) add_law(analysis, k, motion, section);
  if (!analysis.is_answered()) return;
  add_which_law(analysis, section);
  add_states(analysis, section);
  section.add(each_table(analysis, motion));
  if (std::isfinite(analysis.sharing_p_value)) {
    constexpr double kDiffer = 0.01;
    section.plain(
        analysis.sharing_p_value < kDiffer
            ? fmt::format("The steps differ by more than their errors ({}): the values of each step count, "
                          "and those of all together are a compromise.",
                          p_value_text(analysis.sharing_p_value))
            : fmt::format("The steps agree within their errors ({}).", p_value_text(analysis.sharing_p_value)));
  }
  if (analysis.healing) add_holds(*analysis.healing, section);
}

std::string verdict_on(const RateStateAnalysis& analysis) {
  if (!analysis.fitted()) return capitalised(analysis.reason) + ".";
  const RateStateFit& fit = analysis.fits[analysis.best];
  if (!analysis.is_answered())
    return fmt::format(
        "Friction answers the steps by no more than noise would ({}): these data say nothing of the law.",
        p_value_text(analysis.answer_p_value));
  if (!std::isfinite(fit.rate_dependence.value))
    return "Whether steady friction rises or falls with speed is not known from these data: a or b ended at a bound.";
  const std::string rate = with_error(fit.rate_dependence.value, fit.rate_dependence.std_error);
  if (fit.rate_dependence_lower95 > 0 && !std::isfinite(fit.stiffness_ratio))
    return fmt::format(
        "Steady friction rises with speed (a - b = {}): sliding is stable on any machine{}.", rate,
        fit.states > 1 ? ", but perhaps a soft one, where the quicker state alone lets it fall" : ", however soft");
  const bool rises = fit.rate_dependence_lower95 > 0;  // while the quick one of two states alone falls
  if (!rises && !(fit.rate_dependence_upper95 < 0))
    return fmt::format("Whether steady friction rises or falls with speed is not known from these data (a - b = {}).",
                       rate);
  std::string text = fmt::format("Steady friction {} with speed (a - b = {})", rises ? "rises" : "falls", rate);
  if (!std::isfinite(fit.stiffness_ratio)) return text + ": sliding is not stable on a machine that is soft enough.";
  const FitParameter &distance = fit.parameters[2], &stiffness = fit.parameters.back();
  text += fmt::format("{} sliding is unstable, and sticks and slips, on a machine softer than {}{} {} {}{}",
                      rises ? ", and yet" : ":", critical_stiffness_text(fit), fit.states > 1 ? "," : " =",
                      significant(fit.critical_stiffness * kMicrometre, 3), stiffness.parameter.unit,
                      stiffness.parameter.unit == "1/um" ? " per normal force" : "");
  if (!stiffness.determined || !distance.determined) return text + "; k of this one is not resolved.";
  const std::string ratio = significant(fit.stiffness_ratio, 3);
  if (fit.stiffness_ratio_lower95 > 1)
    return text + fmt::format(". This machine is {} times as stiff: it slides steadily.", ratio);
  if (fit.stiffness_ratio_upper95 < 1)
    return text + fmt::format(". This machine has {} of that: it {} stick and slip (--kind stick-slip).", ratio,
                              rises ? "may" : "will");
  return text +
         fmt::format(". This machine has {} of that, which the data do not tell from the critical stiffness.", ratio);
}

}  // namespace tribofit
