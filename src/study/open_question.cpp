#include "open_question.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "diagnosis/conclusions.hpp"
#include "diagnosis/diagnose_traces.hpp"
#include "diagnosis/ruling.hpp"
#include "fit/fit_laws.hpp"
#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/friction/effect_pairs.hpp"

namespace tribofit {

namespace {

/// The effect as the ladder has it: in the form that a rung holds. Nothing for one that shows in the motion and not in
/// friction.
std::optional<Effect> effect_of(const DiagnosedTraces& diagnosed, const std::string& key) {
  for (const Fit& rung : diagnosed.rungs) {
    for (const Effect& effect : rung.model.effects()) {
      if (describe(effect).key == key) return effect;
    }
  }
  for (const Effect& effect : effect_catalogue()) {
    if (describe(effect).key == key && !is_kinematic(effect)) return effect;
  }
  return std::nullopt;
}

/// The first group of the ladder with more than one effect of friction or of its reading.
void ask_about_group(OpenQuestion& question) {
  for (const Rung& rung : question.diagnosed.diagnosis.ladder) {
    std::vector<std::string> keys = {rung.added};
    keys.insert(keys.end(), rung.equivalent.begin(), rung.equivalent.end());
    std::vector<Effect> asked;
    for (const std::string& key : keys) {
      if (std::optional<Effect> effect = effect_of(question.diagnosed, key)) asked.push_back(std::move(*effect));
    }
    if (rung.added.empty() || asked.size() < 2 || asked.size() < keys.size()) continue;
    question.kind = QuestionKind::group;
    question.asked = std::move(asked);
    std::erase_if(question.beside, [&](const Effect& effect) { return describe(effect).key == rung.added; });
    return;
  }
}

/// The likeliest of those that are possible, and what is possible too and looks like it: a run that shows that there is
/// something must also show which of them.
void ask_about_possible(OpenQuestion& question) {
  std::vector<const EffectFinding*> possible;
  for (const EffectFinding& finding : question.diagnosed.diagnosis.effects) {
    const bool asked = finding.status == EffectStatus::possible && !finding.parameters.empty();
    if (asked && effect_of(question.diagnosed, finding.key)) possible.push_back(&finding);
  }
  if (possible.empty()) return;
  std::stable_sort(possible.begin(), possible.end(),
                   [](const auto* a, const auto* b) { return a->p_value < b->p_value; });
  const std::vector<LookAlike> alike = look_alikes(possible.front()->key);
  question.kind = QuestionKind::possible;
  for (const EffectFinding* finding : possible) {
    const bool looks_like_it =
        std::any_of(alike.begin(), alike.end(), [&](const LookAlike& other) { return other.key == finding->key; });
    if (finding != possible.front() && !looks_like_it) continue;
    question.asked.push_back(*effect_of(question.diagnosed, finding->key));
    question.p_values.push_back(finding->p_value);
  }
}

/// The model of each answer, not yet fitted.
void add_models(OpenQuestion& question) {
  const auto add = [&](std::string name, std::vector<Effect> effects) {
    ModelInQuestion& model = question.models.emplace_back();
    model.name = std::move(name);
    model.fit.model = FrictionModel(question.law, std::move(effects), question.diagnosed.traces.size());
  };
  for (const Effect& effect : question.asked) {
    std::vector<Effect> effects = question.beside;
    effects.push_back(effect);
    add(describe(effect).spelled(), std::move(effects));
  }
  if (question.kind == QuestionKind::possible) add("", question.beside);
}

/// Values of the parameters of a model, from the last rung and from what was found of the effect.
std::vector<double> start_of(const FrictionModel& model, const DiagnosedTraces& diagnosed) {
  std::vector<double> start;
  for (const FrictionModel::Slot& slot : model.parameters()) {
    double value = slot.parameter.start * slot.parameter.si;
    const auto take = [&](const std::vector<FitParameter>& found) {
      for (const FitParameter& p : found) {
        if (p.effect == slot.effect && p.parameter.name == slot.parameter.name) value = p.value;
      }
    };
    for (const EffectFinding& finding : diagnosed.diagnosis.effects) take(finding.parameters);
    take(diagnosed.rungs.back().parameters);
    start.push_back(value);
  }
  return start;
}

/// Fits an answer, puts its machine together and draws those that are as plausible.
void identify_answer(OpenQuestion& question, std::size_t k) {
  ModelInQuestion& answer = question.models[k];
  const FrictionModel model = answer.fit.model;
  const std::vector<Record> records = question.records();
  FitOptions warm = question.options.fit;
  warm.start = start_of(model, question.diagnosed);
  warm.threads = 1;
  answer.fit = fit_model(model, records, observations_for(model, records), question.options.instruments, warm);
  const Fit own = diagnosis::of_first_record(answer.fit);
  const Motion& motion = question.own().motion;
  const Segmentation& segmentation = question.own().segmentation;
  const RigFit rig = rig_beside(own, motion, segmentation, question.options.instruments);
  question.machines[k] = identified_machine(own, rig, motion, segmentation);
  answer.reason = question.machines[k].reason;
  if (answer.reason.empty()) question.draws[k] = PlausibleDraws(question.machines[k], {&motion, &segmentation}, own);
}

/// The trace that most is known of: the longest that sticks and slips.
std::size_t trace_to_continue(const DiagnosedTraces& diagnosed) {
  const auto cycles = [](const Identification& trace) {
    return trace.segmentation.kind == MotionKind::stick_slip ? trace.segmentation.cycles.size() : 0;
  };
  const auto& all = diagnosed.traces;
  const auto best =
      std::max_element(all.begin(), all.end(), [&](const auto& a, const auto& b) { return cycles(a) < cycles(b); });
  return static_cast<std::size_t>(best - all.begin());
}

/// The least odds, for no effect over any, that a p-value leaves of even ones (T. Sellke, M. J. Bayarri, J. O. Berger,
/// Amer. Statist. 55 (2001) 62, doi:10.1198/000313001300339950).
double least_odds_of_nothing(double p_value) {
  return p_value > 0 && p_value < 1 / std::numbers::e ? -std::numbers::e * p_value * std::log(p_value) : 1;
}

/// How likely each answer is by the held-out errors so far: exp(-behind/(2 t)) with the temper t, since no model is
/// the exact one that a likelihood takes it for; of effects that are possible by their p-values.
void weigh(OpenQuestion& question) {
  std::vector<double> weights(question.models.size(), 1.0);
  question.behind.assign(weights.size(), 0.0);
  if (question.kind == QuestionKind::group) {
    const diagnosis::Ruling now = diagnosis::rule_between(question.records(), question.law, question.beside,
                                                          question.asked, question.options.instruments);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      question.behind[k] = now.effects[k].behind;
      weights[k] = std::exp(-std::clamp(now.effects[k].behind, 0.0, kMostBehind) / (2 * kTemper));
    }
  } else {
    const double least = least_odds_of_nothing(question.p_values.front());
    double something = 0;
    for (std::size_t k = 0; k < question.p_values.size(); ++k) {
      weights[k] = least / least_odds_of_nothing(question.p_values[k]);
      something += weights[k];
    }
    weights.back() = something * least / kOddsOfSomething;
  }
  double sum = 0;
  for (const double w : weights) sum += w;
  for (std::size_t k = 0; k < weights.size(); ++k) question.models[k].probability = weights[k] / sum;
}

/// The record, its noise and its scatter.
RecordToContinue record_of(const OpenQuestion& question) {
  const Identification& trace = question.own();
  const Fit& fit = question.models.front().fit;
  RecordToContinue out;
  out.motion = &trace.motion;
  out.noise = noise_of_record(trace.motion, trace.segmentation, fit.floor);
  out.scatter = question.machines.front().scatter;
  out.rate = 1 / trace.motion.step;
  out.reference_load = fit.mean_load;
  out.reference_temperature = fit.mean_temperature;
  const double slip = trace.segmentation.slip_time.value;
  out.simulated_rate = slip > 0 ? static_cast<double>(kSamplesOfSlip) / slip : out.rate;
  return out;
}

}  // namespace

std::vector<Record> OpenQuestion::records() const {
  std::vector<Record> records;
  for (const Identification& one : diagnosed.traces) records.push_back({&one.motion, &one.segmentation});
  return records;
}

OpenQuestion open_question(const DiagnosedTraces& diagnosed, const PlanOptions& options) {
  OpenQuestion question{diagnosed, options};
  if (diagnosed.rungs.empty()) {
    question.reason = "the records could not be diagnosed";
    return question;
  }
  question.law = diagnosed.diagnosis.law;
  const std::span<const Effect> found = diagnosed.rungs.back().model.effects();
  question.beside.assign(found.begin(), found.end());
  ask_about_group(question);
  if (question.kind == QuestionKind::nothing) ask_about_possible(question);
  if (question.kind == QuestionKind::nothing) return question;
  question.trace = trace_to_continue(diagnosed);
  if (question.own().segmentation.kind != MotionKind::stick_slip) {
    question.reason = "nothing sticks and slips in these records: only stick-slip is simulated";
    return question;
  }
  add_models(question);
  question.machines.resize(question.models.size());
  question.draws.resize(question.models.size());
  run_tasks(question.models.size(), options.threads, [&](std::size_t k) { identify_answer(question, k); });
  for (const ModelInQuestion& model : question.models) {
    if (question.reason.empty()) question.reason = model.reason;
  }
  if (!question.reason.empty()) return question;
  weigh(question);
  question.record = record_of(question);
  return question;
}

}  // namespace tribofit
