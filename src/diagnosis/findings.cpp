#include "findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "tribofit/friction/effect_pairs.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::diagnosis {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kChance = 0.01;  ///< p-value below which structure is not chance

bool contains(const std::vector<std::size_t>& list, std::size_t value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

/// The last time a candidate was judged, with the step beside which it was.
struct LastJudged {
  const CandidateResult* judged = nullptr;
  std::size_t step = 0;  ///< it stood beside this step of the ladder
  bool ever_passed = false;
};

LastJudged last_judged(const Ladder& ladder, std::size_t candidate) {
  LastJudged out;
  const auto look = [&](const std::vector<CandidateResult>& list, std::size_t step) {
    for (const CandidateResult& judged : list) {
      if (judged.candidate != candidate || !judged.trial.usable) continue;
      out.judged = &judged;
      out.step = step;
      out.ever_passed |= judged.passes || (judged.hopeless && judged.plausible && judged.p_value < kChance);
    }
  };
  for (std::size_t s = 1; s < ladder.steps.size(); ++s) look(ladder.steps[s].judged, s - 1);
  look(ladder.last, ladder.steps.size() - 1);
  return out;
}

std::string why_not(const CandidateResult& judged, const Candidate& candidate) {
  const double value = judged.trial.p[judged.trial.model.offset_of(candidate.info.key)];
  if (candidate.possible && !candidate.possible->holds(value)) {
    return "it would help only by more than the instruments file leaves room for";
  }
  if (!judged.plausible) return "it would help only with values that are not plausible";
  if (judged.fall <= 0) return "it does not lower the error on held-out cycles";
  if (judged.p_value >= kChance) return fmt::format("what it explains may be chance (p = {:.2g})", judged.p_value);
  return fmt::format("what it explains is {:.1f} % of what noise leaves, too little to be named", 100 * judged.size);
}

/// Parameters of a trial as the report shows them, without intervals.
std::vector<FitParameter> parameters_of(const Trial& trial, const std::string& key) {
  std::vector<FitParameter> out;
  for (std::size_t k = 0; k < trial.p.size(); ++k) {
    const auto& slot = trial.model.parameters()[k];
    if (slot.effect != key) continue;
    FitParameter parameter;
    parameter.parameter = slot.parameter;
    parameter.effect = key;
    parameter.value = trial.p[k];
    parameter.std_error = parameter.lower95 = parameter.upper95 = kNaN;
    parameter.profile_lower95 = parameter.profile_upper95 = kNaN;
    parameter.at_bound = trial.at_bound[k];
    out.push_back(parameter);
  }
  return out;
}

std::vector<FitParameter> parameters_of(const Fit& fit, const std::string& key) {
  std::vector<FitParameter> out;
  for (const FitParameter& parameter : fit.parameters) {
    if (parameter.effect == key) out.push_back(parameter);
  }
  return out;
}

/// The candidate that stands for an effect: the form of it that is on the ladder or in a group, else the effect itself.
std::size_t form_of(const Ladder& ladder, const std::vector<Candidate>& all, std::size_t effect) {
  for (const LadderStep& step : ladder.steps) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool stands = step.added == k || contains(step.equivalent, k);
      if (stands && all[k].info.key == all[effect].info.key) return k;
    }
  }
  return effect;
}

/// Standard error of a held-out RMSE from the squares of each cycle; samples: behind their mean.
double std_error_of_rmse(std::span<const double> squares, double samples, double rmse) {
  if (squares.size() < 3 || !(rmse > 0)) return kNaN;
  return standard_error_of_mean(squares).std_error * static_cast<double>(squares.size()) / samples / (2 * rmse);
}

/// The user has not thought of it already.
bool is_new(const FrictionModel& model, const Formula& formula) {
  return std::none_of(model.effects().begin(), model.effects().end(), [&](const Effect& effect) {
    const auto* known = std::get_if<Formula>(&effect);
    return known != nullptr && (known->info().key == formula.info().key || known->same_as(formula));
  });
}

}  // namespace

std::vector<EffectFinding> findings_of(const DiagnosisContext& bench, const Ladder& ladder,
                                       const std::vector<Candidate>& all, const std::vector<Fit>& fits, double floor) {
  std::vector<EffectFinding> out;
  const double base = fits.front().error.held_out_rmse;
  const double above = std::max(1e-300, base * base - floor * floor);
  for (std::size_t effect = 0; effect < all.size(); ++effect) {
    if (!all[effect].info.option.empty()) continue;
    const std::size_t k = form_of(ladder, all, effect);
    EffectFinding finding;
    finding.key = all[k].info.key;
    finding.held_out_rmse = finding.error_reduction = finding.p_value = kNaN;
    if (ladder.steps.front().trial.model.offset_of(finding.key) < ladder.steps.front().trial.p.size()) {
      finding.status = EffectStatus::missing;
      finding.held_out_rmse = base;
      finding.held_out_std_error = held_out_std_error(fits.front());
      finding.parameters = parameters_of(fits.back(), finding.key);
      finding.reason = "it is part of the model from the start";
      out.push_back(std::move(finding));
      continue;
    }
    if (!all[k].untestable.empty()) {
      finding.status = EffectStatus::untestable;
      finding.reason = all[k].untestable;
      out.push_back(finding);
      continue;
    }
    const LastJudged last = last_judged(ladder, k);
    if (last.judged != nullptr) {
      // Whitened squares fall as the squares themselves do.
      const double before = fits[last.step].error.held_out_rmse;
      const auto in_stick = [](const Trial& trial) { return trial.stick.rigid - trial.stick.left; };
      const double in_slip = last.judged->fall - in_stick(last.judged->trial) + in_stick(ladder.steps[last.step].trial);
      const double squared = std::max(0.0, before * before - in_slip / bench.fine.samples);
      finding.held_out_rmse = std::sqrt(squared);
      finding.held_out_std_error =
          std_error_of_rmse(last.judged->trial.plain_cycles, bench.fine.samples, finding.held_out_rmse);
      finding.p_value = last.judged->p_value;
      finding.parameters = parameters_of(last.judged->trial, finding.key);
      finding.error_reduction = std::clamp((before * before - squared) / above, -1.0, 1.0);
    }
    finding.status = EffectStatus::unsupported;
    finding.reason = last.judged != nullptr ? why_not(*last.judged, all[k]) : "it promises no fall of the error";
    if (last.ever_passed) {
      finding.status = EffectStatus::superseded;
      finding.reason = "another effect explains the same error better";
    }
    if (contains(ladder.withdrawn, k)) {
      finding.status = EffectStatus::unsupported;
      finding.reason = "more remains over its variable than it explains: its name would be wrong";
    }
    for (std::size_t s = 1; s < ladder.steps.size(); ++s) {
      const LadderStep& step = ladder.steps[s];
      if (contains(step.equivalent, k)) {
        finding.status = EffectStatus::equivalent;
        finding.reason = fmt::format("these data cannot tell it from {}", all[*step.added].info.key);
      }
      if (*step.added != k) continue;
      finding.status = EffectStatus::missing;
      finding.held_out_rmse = fits[s].error.held_out_rmse;
      finding.held_out_std_error = held_out_std_error(fits[s]);
      const double before = fits[s - 1].error.held_out_rmse;
      finding.error_reduction = std::clamp((before * before - std::pow(finding.held_out_rmse, 2)) / above, -1.0, 1.0);
      finding.parameters = parameters_of(fits.back(), finding.key);
      finding.reason = "with it the error on held-out cycles falls";
      break;
    }
    out.push_back(std::move(finding));
  }
  return out;
}

std::vector<Share> shares_of(const std::vector<Probe>& probes, double above) {
  std::vector<Share> out;
  double most = std::max(above, 1e-300);
  for (const Probe& probe : probes) most = std::max(most, probe.fall);
  for (const Probe& probe : probes) {
    const double p = std::min(1.0, probe.p_value * static_cast<double>(probes.size()));
    out.push_back({probe.variable, p < 0.05 ? std::max(0.0, probe.fall) / most : 0.0, p});
  }
  std::stable_sort(out.begin(), out.end(), [](const Share& a, const Share& b) { return a.share > b.share; });
  return out;
}

void add_share_of_stick(const Ladder& ladder, double above, std::vector<Share>& shares) {
  const Trial& top = ladder.top();
  const double gain = top.stick.rigid - top.stick.left;
  if (!(gain > 0) || !(above > 0)) return;
  double p_value = 1;
  const auto creeping = std::find_if(ladder.steps.begin(), ladder.steps.end(),
                                     [](const LadderStep& step) { return step.trial.stick.rows > 0; });
  for (const CandidateResult& judged : creeping->judged) {
    if (creeping->added == judged.candidate) p_value = judged.p_value;
  }
  const Share share = {"stick", std::min(1.0, gain / above), p_value};
  const auto below = [&](const Share& other) { return other.share < share.share; };
  shares.insert(std::find_if(shares.begin(), shares.end(), below), share);
}

std::string next_experiment(const Ladder& ladder, const std::vector<Candidate>& all,
                            const std::vector<Probe>& structure) {
  std::string text;
  const auto say = [&](const std::string& sentence) {
    if (!text.empty()) text += ' ';
    text += sentence;
  };
  for (const LadderStep& step : ladder.steps) {
    if (!step.added || step.equivalent.empty()) continue;
    const EffectInfo& leader = all[*step.added].info;
    std::vector<std::pair<std::string, std::string>> tests;  // with those of the group that each tells from the leader
    for (const std::size_t other : step.equivalent) {
      const std::string& key = all[other].info.key;
      std::string test = discriminating_experiment(leader.key, key);
      if (test.empty()) test = all[other].info.experiment;
      const auto same = std::find_if(tests.begin(), tests.end(), [&](const auto& t) { return t.first == test; });
      if (same == tests.end()) {
        tests.emplace_back(std::move(test), key);
      } else {
        same->second += " or " + key;
      }
    }
    for (const auto& [test, others] : tests) say(fmt::format("{} or {}: {}.", leader.key, others, test));
  }
  if (!structure.empty()) {
    const std::string& variable = structure.front().variable;
    say(variable == "velocity" ? "Repeat at another disc speed: what belongs to v_r stays at the same v_r."
        : variable == "time" ? "Repeat the run: what belongs to the clock or to the surface comes back at another time."
        : variable == "angle"     ? "Turn the disc by a quarter on its hub: a pattern of the disc turns with it."
        : variable == "load"      ? "Step the load up and down: what belongs to it comes back at the same load."
        : variable == "frequency" ? "Record with the disc at rest: a line that stays is picked up by the instruments."
                                  : "Run at 1, 2, 4 and 8 rpm: a loop that is constant in ms is a lag or a delay, one "
                                    "constant in um a memory.");
  }
  if (text.empty() && ladder.steps.size() > 1) {
    say(fmt::format("To confirm: {}.", all[*ladder.steps.back().added].info.experiment));
  }
  if (text.empty()) {
    for (const Candidate& candidate : all) {
      if (candidate.untestable.empty()) continue;
      say(fmt::format("These data cannot show {} ({}): {}.", candidate.info.key, candidate.untestable,
                      candidate.info.experiment));
      break;
    }
  }
  return text;
}

std::string closed_form(const DiagnosisContext& bench, const Trial& top, const Probe& probe) {
  std::vector<std::string> forms;
  // A coefficient is of the order of one, a force of the order of what was recorded; probes may overshoot either.
  double largest = std::max(1.0, bench.fine.observations.largest_friction);
  for (const double value : probe.value) largest = std::max(largest, 5 * std::abs(value));
  if (probe.variable == "velocity" && probe.at.size() > 4) {
    std::size_t peak = 1;
    // About the straight line between the ends, which the law itself can take up.
    const auto bulge = [&](std::size_t k) {
      const double u = (probe.at[k] - probe.at.front()) / (probe.at.back() - probe.at.front());
      return probe.value[k] - (1 - u) * probe.value.front() - u * probe.value.back();
    };
    for (std::size_t k = 1; k + 1 < probe.at.size(); ++k) {
      if (std::abs(bulge(k)) > std::abs(bulge(peak))) peak = k;
    }
    const double width = 1.2 * (probe.at[1] - probe.at[0]) * 1e3, last = probe.at.back() * 1e3;
    for (std::size_t k = peak > 1 ? peak - 1 : 1; k <= std::min(peak + 1, probe.at.size() - 2); ++k) {
      for (const double w : {width, 2 * width}) {
        forms.push_back(
            fmt::format("hump = a*exp(-((v-v0)/w)^2); a={:.4g}[{:.4g},{:.4g}], v0={:.4g}mm/s[0,{:.4g}], "
                        "w={:.4g}mm/s[{:.4g},{:.4g}]",
                        bulge(peak), -largest, largest, probe.at[k] * 1e3, last, w, 0.3 * width, last));
      }
    }
  } else if (probe.variable == "time" && probe.period > 0 && probe.value.size() == 2) {
    const double size = probe.value[0] * std::abs(top.p[1]);
    forms.push_back(
        fmt::format("swing = a*cos(6.283185307*t/T-phi); a={:.4g}[0,{:.4g}], T={:.6g}s[{:.6g},{:.6g}], "
                    "phi={:.4g}[-6.3,6.3]",
                    size, largest, probe.period, 0.8 * probe.period, 1.25 * probe.period, probe.value[1]));
  }
  // The form is worth offering when the fit takes up most of what the free function does.
  std::string best_form;
  double best = probe.fall * 0.6;
  const Trial coarse_top = try_model(bench, bench.coarse, top.model, top.p);
  for (const std::string& form : forms) {
    const Formula formula(form);
    if (!is_new(top.model, formula)) continue;
    const FrictionModel model = with_effect(top.model, formula);
    const std::vector<Parameter>& own = formula.info().parameters;
    const std::size_t offset = model.offset_of(formula.info().key);
    std::vector<double> start = top.p, values;
    for (const Parameter& q : own) values.push_back(q.start * q.si);
    start.insert(start.begin() + static_cast<std::ptrdiff_t>(offset), values.begin(), values.end());
    const Trial trial = try_model(bench, bench.coarse, model, start);
    if (!trial.usable || coarse_top.held_out_squares - trial.held_out_squares < best) continue;
    best = coarse_top.held_out_squares - trial.held_out_squares;
    std::string text;
    for (std::size_t k = 0; k < own.size(); ++k) {
      text += fmt::format("{}{}={:.4g}", k == 0 ? "" : ", ", own[k].name, trial.p[offset + k] / own[k].si);
    }
    best_form = form.substr(0, form.find(';')) + "; " + text;
  }
  return best_form;
}

}  // namespace tribofit::diagnosis
