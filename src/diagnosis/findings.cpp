#include "findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "fit/assessment.hpp"
#include "fit/starts.hpp"
#include "limits.hpp"
#include "tribofit/friction/effect_pairs.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::diagnosis {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool contains(const std::vector<std::size_t>& list, std::size_t value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

/// The last time a candidate was judged, with the step beside which it was.
struct LastResult {
  const CandidateResult* judged = nullptr;
  std::size_t step = 0;  ///< it stood beside this step of the ladder
  bool ever_passed = false;
};

LastResult last_result(const Ladder& ladder, std::size_t candidate) {
  LastResult out;
  const auto look = [&](const std::vector<CandidateResult>& list, std::size_t step) {
    for (const CandidateResult& judged : list) {
      if (judged.candidate != candidate || !judged.trial.usable) continue;
      out.judged = &judged;
      out.step = step;
      out.ever_passed |= judged.passes || (judged.hopeless && judged.plausible && judged.p_value < limits::kChance);
    }
  };
  for (std::size_t s = 1; s < ladder.steps.size(); ++s) look(ladder.steps[s].judged, s - 1);
  look(ladder.last, ladder.steps.size() - 1);
  return out;
}

/// The first parameter on its bound, and that bound; empty where none is.
std::string bound_reached(const CandidateResult& judged, const Candidate& candidate, const Observations& observations) {
  const Trial& trial = judged.trial;
  const std::size_t offset = trial.model.offset_of(candidate.info.key);
  for (std::size_t k = 0; k < candidate.info.parameters.size(); ++k) {
    if (!trial.at_bound[offset + k]) continue;
    const Parameter q = on_scale_of(candidate.info.parameters[k], observations);
    return fmt::format("{} beyond {}{}{}", q.name, general(trial.p[offset + k] / q.si, 3), q.unit == "1" ? "" : " ",
                       q.unit == "1" ? "" : q.unit);
  }
  return "";
}

std::string why_not(const CandidateResult& judged, const Candidate& candidate, const Observations& observations) {
  const double value = judged.trial.p[judged.trial.model.offset_of(candidate.info.key)];
  if (candidate.allowed && !candidate.allowed->holds(value)) {
    return candidate.allowed->is_uncertainty ? "it would need a value outside the uncertainty in the instruments file"
                                             : "it would need a value below what the instruments file states";
  }
  if (!judged.plausible) {
    const std::string bound = bound_reached(judged, candidate, observations);
    return bound.empty() ? "it would help only with values that are not plausible"
                         : "it would help only with " + bound + ", the end of what is plausible";
  }
  if (judged.fall <= 0) return "it does not lower the error on held-out cycles";
  if (judged.p_value >= limits::kChance)
    return fmt::format("what it explains may be chance (p = {})", general(judged.p_value, 2));
  return fmt::format("what it explains is {} % of what noise leaves, too little to be named",
                     fixed(100 * judged.size, 1));
}

/// Parameters of a trial as the report shows them, without intervals.
std::vector<FitParameter> parameters_of(const Trial& trial, const Observations& observations, const std::string& key) {
  std::vector<FitParameter> out;
  for (std::size_t k = 0; k < trial.p.size(); ++k) {
    const auto& slot = trial.model.parameters()[k];
    if (slot.effect != key) continue;
    FitParameter parameter;
    parameter.parameter = on_scale_of(slot.parameter, observations);
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

/// What findings are made from.
struct FindingInputs {
  const DiagnosisContext& context;
  const Ladder& ladder;
  const std::vector<Candidate>& all;
  const std::vector<Fit>& fits;  ///< one a step of the ladder
  double above;                  ///< mean square of the base law above the noise floor
};

/// Share of the squares above the noise floor that a fall of the RMSE takes away; squares: after the fall.
double reduction(const FindingInputs& in, double before, double squares) {
  return std::clamp((before * before - squares) / in.above, -1.0, 1.0);
}

/// It is part of every model.
bool stands_from_the_start(const Ladder& ladder, const std::string& key) {
  const Trial& base = ladder.steps.front().trial;
  return base.model.offset_of(key) < base.p.size();
}

void describe_from_the_start(const FindingInputs& in, EffectFinding& finding) {
  finding.status = EffectStatus::found;
  finding.held_out_rmse = in.fits.front().error.held_out_rmse;
  finding.held_out_std_error = held_out_std_error(in.fits.front());
  finding.parameters = parameters_of(in.fits.back(), finding.key);
  finding.reason = "it is part of the model from the start";
}

/// Error and parameters of a candidate where it was judged last.
void describe_last_trial(const FindingInputs& in, const LastResult& last, EffectFinding& finding) {
  // Whitened squares fall as the squares themselves do.
  const double before = in.fits[last.step].error.held_out_rmse;
  const auto in_stick = [](const Trial& trial) { return trial.stick.rigid - trial.stick.left; };
  const Trial& trial = last.judged->trial;
  const double in_slip = last.judged->fall - in_stick(trial) + in_stick(in.ladder.steps[last.step].trial);
  const double squared = std::max(0.0, before * before - in_slip / in.context.fine.samples);
  finding.held_out_rmse = std::sqrt(squared);
  finding.held_out_std_error = std_error_of_rmse(trial.plain_cycles, in.context.fine.samples, finding.held_out_rmse);
  finding.p_value = last.judged->p_value;
  finding.parameters = parameters_of(trial, in.context.fine.observations, finding.key);
  finding.error_reduction = reduction(in, before, squared);
}

/// The candidate is significant, and all that is against it is that a parameter of it would go beyond its bound:
/// something that acts like it remains. (Not where the instruments file or the end of the record is against it.)
bool acts_beyond_bounds(const Candidate& candidate, const CandidateResult& judged) {
  const Trial& trial = judged.trial;
  const std::size_t offset = trial.model.offset_of(candidate.info.key);
  if (judged.p_value >= limits::kChanceBeyondBounds) return false;
  if (candidate.allowed && !candidate.allowed->holds(trial.p[offset])) return false;
  const auto first = trial.at_bound.begin() + static_cast<std::ptrdiff_t>(offset);
  const auto last = first + static_cast<std::ptrdiff_t>(candidate.info.parameters.size());
  return std::find(first, last, true) != last;
}

/// What stands against a candidate beside the last step of the ladder is chance alone, though it would take away much
/// of what is left above the noise floor (at the noise floor nothing is left). Or its bounds alone, also at the noise
/// floor: another effect may take its place there.
bool is_possible(const FindingInputs& in, std::size_t k, const LastResult& last) {
  if (last.judged == nullptr || last.step + 1 != in.ladder.steps.size()) return false;
  const CandidateResult& judged = *last.judged;
  if (!(judged.size > limits::kLeastPossible) || !(judged.fall > 0)) return false;
  if (!judged.plausible) return acts_beyond_bounds(in.all[k], judged);
  if (in.fits.back().error.held_out_rmse <= kAtFloor * in.fits.back().floor.rmse) return false;
  const double excess = in.ladder.top().held_out_squares - in.context.noise_squares();
  return judged.p_value < limits::kChanceOfPossible && judged.fall > limits::kPossiblePart * excess;
}

/// Status and reason of a candidate that may not be on the ladder.
void say_why_not(const FindingInputs& in, std::size_t k, const LastResult& last, EffectFinding& finding) {
  finding.status = last.ever_passed ? EffectStatus::superseded : EffectStatus::not_supported;
  finding.reason = last.ever_passed         ? "another effect explains the same error better"
                   : last.judged != nullptr ? why_not(*last.judged, in.all[k], in.context.fine.observations)
                                            : "screening predicts no fall of the held-out error";
  if (finding.status == EffectStatus::not_supported && is_possible(in, k, last)) {
    finding.status = EffectStatus::possible;
    finding.reason =
        last.judged->plausible
            ? fmt::format("it would take away much of what remains, but that may be chance (p = {}); to decide: {}",
                          general(last.judged->p_value, 2), in.all[k].info.experiment)
            : finding.reason + ": something that acts like it remains (p = " +
                  fmt::format("{}); to decide: {}", general(last.judged->p_value, 2), in.all[k].info.experiment);
  }
  if (in.ladder.out_of_time && (last.judged == nullptr || last.step + 1 != in.ladder.steps.size())) {
    finding.status = EffectStatus::untried;
    finding.reason = in.ladder.steps.size() > 1 ? "the time was over before it was tried beside what was found"
                                                : "the time was over first";
  }
  if (!contains(in.ladder.withdrawn, k)) return;
  finding.status = EffectStatus::not_supported;
  finding.reason = "the error that is left is larger than what it explains";
}

/// What a candidate is on the ladder: added by one of its steps, or equivalent to what a step added.
void describe_place(const FindingInputs& in, std::size_t k, EffectFinding& finding) {
  for (std::size_t s = 1; s < in.ladder.steps.size(); ++s) {
    const LadderStep& step = in.ladder.steps[s];
    if (contains(step.equivalent, k)) {
      finding.status = EffectStatus::equivalent;
      finding.reason = fmt::format("with these data not distinguishable from {}", in.all[*step.added].info.key);
    }
    if (*step.added != k) continue;
    finding.status = EffectStatus::found;
    finding.held_out_rmse = in.fits[s].error.held_out_rmse;
    finding.held_out_std_error = held_out_std_error(in.fits[s]);
    finding.error_reduction = reduction(in, in.fits[s - 1].error.held_out_rmse, std::pow(finding.held_out_rmse, 2));
    finding.parameters = parameters_of(in.fits.back(), finding.key);
    const auto decided = std::find_if(step.judged.begin(), step.judged.end(),
                                      [&](const CandidateResult& judged) { return judged.candidate == k; });
    if (decided != step.judged.end()) finding.p_value = decided->p_value;
    finding.reason = "with it the held-out error falls";
    return;
  }
}

/// Why neither these data nor this law can show an effect; empty where they can.
std::string obstacle_of(const FindingInputs& in, std::size_t k) {
  const Candidate& candidate = in.all[k];
  return candidate.untestable.empty() ? obstacle_on(in.ladder.top().model.law(), candidate.effect)
                                      : candidate.untestable;
}

/// k: the candidate that stands for the effect.
EffectFinding finding_of(const FindingInputs& in, std::size_t k) {
  EffectFinding finding;
  finding.key = in.all[k].info.key;
  finding.held_out_rmse = finding.error_reduction = finding.p_value = kNaN;
  if (stands_from_the_start(in.ladder, finding.key)) {
    describe_from_the_start(in, finding);
  } else if (const std::string why = obstacle_of(in, k); !why.empty()) {
    finding.status = EffectStatus::untestable;
    finding.reason = why;
  } else {
    const LastResult last = last_result(in.ladder, k);
    if (last.judged != nullptr) describe_last_trial(in, last, finding);
    say_why_not(in, k, last, finding);
    describe_place(in, k, finding);
  }
  return finding;
}

}  // namespace

std::vector<EffectFinding> findings_of(const DiagnosisContext& context, const Ladder& ladder,
                                       const std::vector<Candidate>& all, const std::vector<Fit>& fits, double floor) {
  const double base = fits.front().error.held_out_rmse;
  const FindingInputs in = {context, ladder, all, fits, std::max(1e-300, base * base - floor * floor)};
  std::vector<EffectFinding> out;
  for (std::size_t effect = 0; effect < all.size(); ++effect) {
    if (all[effect].info.option.empty()) out.push_back(finding_of(in, form_of(ladder, all, effect)));
  }
  return out;
}

std::vector<Share> shares_of(const std::vector<Probe>& probes, double above) {
  std::vector<Share> out;
  double most = std::max(above, 1e-300);
  for (const Probe& probe : probes) most = std::max(most, probe.fall);
  for (const Probe& probe : probes) {
    const double p = std::min(1.0, probe.p_value * static_cast<double>(probes.size()));
    out.push_back({probe.variable, p < limits::kChanceOfPossible ? std::max(0.0, probe.fall) / most : 0.0, p});
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
  const Share share = {ResidualVariable::stick, std::min(1.0, gain / above), p_value};
  const auto below = [&](const Share& other) { return other.share < share.share; };
  shares.insert(std::find_if(shares.begin(), shares.end(), below), share);
}

std::string next_experiment(const Ladder& ladder, const std::vector<Candidate>& all,
                            const std::vector<Probe>& structure) {
  std::string text;
  const auto say = [&](std::string_view sentence) {
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
  if (!structure.empty()) say(describe(structure.front().variable).experiment);
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

}  // namespace tribofit::diagnosis
