#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "findings.hpp"
#include "limits.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit::diagnosis {

namespace {

/// The user has not thought of it already.
bool is_new(const FrictionModel& model, const Formula& formula) {
  return std::none_of(model.effects().begin(), model.effects().end(), [&](const Effect& effect) {
    const auto* known = std::get_if<Formula>(&effect);
    return known != nullptr && (known->info().key == formula.info().key || known->same_as(formula));
  });
}

/// Humps over v_r about the largest bulge of a probe. largest: bound of their height [1 or N].
std::vector<std::string> humps(const Probe& probe, double largest) {
  // About the straight line between the ends, which the law itself can take up.
  const auto bulge = [&](std::size_t k) {
    const double u = (probe.at[k] - probe.at.front()) / (probe.at.back() - probe.at.front());
    return probe.value[k] - (1 - u) * probe.value.front() - u * probe.value.back();
  };
  std::size_t peak = 1;
  for (std::size_t k = 1; k + 1 < probe.at.size(); ++k) {
    if (std::abs(bulge(k)) > std::abs(bulge(peak))) peak = k;
  }
  std::vector<std::string> forms;
  const double width = 1.2 * (probe.at[1] - probe.at[0]) * 1e3, last = probe.at.back() * 1e3;
  for (std::size_t k = peak > 1 ? peak - 1 : 1; k <= std::min(peak + 1, probe.at.size() - 2); ++k) {
    for (const double w : {width, 2 * width}) {
      forms.push_back(
          fmt::format("hump = a*exp(-((v-v0)/w)^2); a={}[{},{}], v0={}mm/s[0,{}], "
                      "w={}mm/s[{},{}]",
                      general(bulge(peak), 4), general(-largest, 4), general(largest, 4), general(probe.at[k] * 1e3, 4),
                      general(last, 4), general(w, 4), general(0.3 * width, 4), general(last, 4)));
    }
  }
  return forms;
}

/// The swing over time that a probe found. level: friction that it scales [1 or N].
std::string swing(const Probe& probe, double level, double largest) {
  return fmt::format(
      "swing = a*cos(6.283185307*t/T-phi); a={}[0,{}], T={}s[{},{}], "
      "phi={}[-6.3,6.3]",
      general(probe.value[0] * level, 4), general(largest, 4), general(probe.period, 6), general(0.8 * probe.period, 6),
      general(1.25 * probe.period, 6), general(probe.value[1], 4));
}

/// What dies away with the distance since a reversal, as a probe found it.
std::vector<std::string> decays(const Probe& probe, double largest) {
  std::vector<std::string> forms;
  const double span = 1e3 * (probe.at.back() - probe.at.front());
  for (const double part : {0.03, 0.1, 0.3}) {
    forms.push_back(fmt::format("reversal = a*exp(-reversal_distance/L); a={}[{},{}], L={}mm[{},{}]",
                                general(probe.value.front() - probe.value.back(), 4), general(-largest, 4),
                                general(largest, 4), general(part * span, 4), general(1e-3 * span, 4),
                                general(3 * span, 4)));
  }
  return forms;
}

std::vector<std::string> forms_of(const DiagnosisContext& context, const Trial& top, const Probe& probe) {
  // A coefficient is of the order of one, a force of the order of what was recorded; probes may overshoot either.
  double largest = context.fine.observations.friction_scale;
  for (const double value : probe.value) largest = std::max(largest, 5 * std::abs(value));
  if (probe.variable == ResidualVariable::velocity && probe.at.size() > 4) return humps(probe, largest);
  if (probe.variable == ResidualVariable::reversal_distance && probe.at.size() > 2) return decays(probe, largest);
  if (probe.variable == ResidualVariable::time && probe.period > 0 && probe.value.size() == 2) {
    const double level = kinetic_friction(top.model.law(), top.p, context.fine.observations.fastest);
    return {swing(probe, std::abs(level), largest)};
  }
  return {};
}

/// A form beside the model of a trial at low resolution: the fitted text, and the squares on held-out cycles.
struct FittedForm {
  std::string text;
  double held_out_squares = 0;
};

std::optional<FittedForm> fit_form(const DiagnosisContext& context, const Trial& top, const std::string& form) {
  const Formula formula(form);
  if (!is_new(top.model, formula)) return std::nullopt;
  const FrictionModel model = with_effect(top.model, formula);
  const EffectInfo info = formula.info();
  const std::size_t offset = model.offset_of(info.key);
  std::vector<double> start = top.p, values;
  for (const Parameter& q : info.parameters) values.push_back(q.start * q.si);
  start.insert(start.begin() + static_cast<std::ptrdiff_t>(offset), values.begin(), values.end());
  const Trial trial = try_model(context, context.coarse, model, start);
  if (!trial.usable) return std::nullopt;
  std::string text = form.substr(0, form.find(';')) + "; ";
  for (std::size_t k = 0; k < info.parameters.size(); ++k) {
    const Parameter& q = info.parameters[k];
    text += fmt::format("{}{}={}", k == 0 ? "" : ", ", q.name, general(trial.p[offset + k] / q.si, 4));
  }
  return FittedForm{std::move(text), trial.held_out_squares};
}

}  // namespace

std::string closed_form(const DiagnosisContext& context, const Trial& top, const Probe& probe) {
  const std::vector<std::string> forms = forms_of(context, top, probe);
  if (forms.empty()) return {};
  std::string best_form;
  double best = probe.fall * limits::kFormPart;
  const Trial coarse_top = try_model(context, context.coarse, top.model, top.p);
  for (const std::string& form : forms) {
    std::optional<FittedForm> fitted = fit_form(context, top, form);
    if (!fitted || coarse_top.held_out_squares - fitted->held_out_squares < best) continue;
    best = coarse_top.held_out_squares - fitted->held_out_squares;
    best_form = std::move(fitted->text);
  }
  return best_form;
}

}  // namespace tribofit::diagnosis
