#include "tribofit/study/plan.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "diagnosis/conclusions.hpp"
#include "experiments.hpp"
#include "limits.hpp"
#include "open_question.hpp"
#include "tribofit/statistics/parallel.hpp"
#include "tribofit/statistics/stop.hpp"
#include "weighing.hpp"

namespace tribofit {

namespace {

/// Says how far the work is, one thread at a time.
class PlanProgress {
 public:
  explicit PlanProgress(const PlanOptions& options) : say_(options.progress) {}
  void say(std::string_view what, double part) {
    const std::lock_guard lock(mutex_);
    if (say_) say_(what, part);
  }

 private:
  const std::function<void(std::string_view, double)>& say_;
  std::mutex mutex_;
};

/// Probability over the models that were simulated, by how likely each is so far.
double over_models(const OpenQuestion& question, const std::vector<double>& of_models) {
  double sum = 0, weights = 0;
  for (std::size_t m = 0; m < of_models.size(); ++m) {
    if (!std::isfinite(of_models[m])) continue;
    sum += question.models[m].probability * of_models[m];
    weights += question.models[m].probability;
  }
  return weights > 0 ? sum / weights : 0;
}

/// An effect of the motion that moves the plateau of stick.
bool is_of_plateau(const std::string& key) {
  return std::any_of(effect_catalogue().begin(), effect_catalogue().end(),
                     [&](const Effect& effect) { return describe(effect).key == key && is_kinematic(effect); });
}

double worth(const PlannedExperiment& one) {
  return one.probability - kCostOfMinute * one.minutes();
}

void rank(std::vector<PlannedExperiment>& all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const PlannedExperiment& a, const PlannedExperiment& b) { return worth(a) > worth(b); });
}

/// Models that are likely enough to be simulated as the true one.
std::vector<std::size_t> likely_models(const OpenQuestion& question) {
  std::vector<std::size_t> likely;
  for (std::size_t m = 0; m < question.models.size(); ++m) {
    if (question.models[m].probability >= kLeastLikely) likely.push_back(m);
  }
  return likely;
}

/// Expected chances of the first `count` experiments for draw number `draw` of every likely model, averaged with those
/// of the draws before it.
void expect(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const PlanOptions& options,
            std::size_t count, std::uint64_t draw, const std::function<void(double)>& say,
            std::vector<PlannedExperiment>& all) {
  const std::vector<std::size_t> likely = likely_models(question);
  std::vector<Chance> chances(std::min(count, all.size()) * likely.size());
  std::atomic<std::size_t> done{0};
  run_tasks(chances.size(), options.threads, [&](std::size_t t) {
    const Experiment& experiment = all[t / likely.size()].experiment;
    chances[t] = expected_chance(diagnosed, question, experiment, likely[t % likely.size()], draw, options);
    say(static_cast<double>(++done) / static_cast<double>(chances.size()));
  });
  const double before = static_cast<double>(draw);
  for (std::size_t e = 0; e < std::min(count, all.size()); ++e) {
    PlannedExperiment& one = all[e];
    if (draw == 0) one.of_models.assign(question.models.size(), std::numeric_limits<double>::quiet_NaN());
    bool any = false;
    for (std::size_t k = 0; k < likely.size(); ++k) {
      const Chance& chance = chances[e * likely.size() + k];
      double& mean = one.of_models[likely[k]];
      mean = draw == 0 ? chance.named : (mean * before + chance.named) / (before + 1);
      any |= chance.simulated;
    }
    if (!any) one.reason = "its motion could not be simulated";
    one.expected = one.probability = over_models(question, one.of_models);
  }
}

/// Cycles of all records, as many as a run of this length has, too.
double cycles_with(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const Experiment& experiment) {
  double cycles = 0;
  for (const Identification& trace : diagnosed.traces) cycles += static_cast<double>(trace.segmentation.cycles.size());
  const Identification& own = diagnosed.traces[question.trace];
  const double frequency = static_cast<double>(own.segmentation.cycles.size()) / std::max(1e-9, own.duration);
  return cycles + frequency * experiment.duration();
}

/// Diagnoses simulated records of the best experiments in full.
void diagnose_best(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const PlanOptions& options,
                   PlanProgress& progress, std::vector<PlannedExperiment>& all) {
  struct Task {
    std::size_t experiment, model;
    std::uint64_t draw;
    Answer answer = Answer::open;
    bool done = false;
  };
  std::vector<Task> tasks;
  const std::vector<std::size_t> likely = likely_models(question);
  std::size_t chosen = 0;
  for (std::size_t e = 0; e < all.size() && chosen < kExperimentsInFull; ++e) {
    if (all[e].experiment.runs.empty() || !all[e].reason.empty() || all[e].expected < 0.5 * kHopeless) continue;
    ++chosen;
    const double records = kMostDiagnosedCycles / static_cast<double>(kExperimentsInFull) /
                           cycles_with(diagnosed, question, all[e].experiment);
    const auto draws = static_cast<std::size_t>(options.effort * records / static_cast<double>(likely.size()));
    const std::size_t least = chosen == 1 && options.effort > 0 ? 1 : 0;  // the first is always looked at in full
    for (std::size_t draw = 0; draw < std::clamp(draws, least, kMostDrawsInFull); ++draw) {
      for (const std::size_t m : likely) tasks.push_back({e, m, 500 + draw});
    }
  }
  std::atomic<std::size_t> done{0};
  run_tasks(tasks.size(), options.threads, [&](std::size_t t) {
    Task& task = tasks[t];
    if (options.until && std::chrono::steady_clock::now() >= *options.until) return;
    task.answer =
        diagnose_simulated(diagnosed, question, all[task.experiment].experiment, task.model, task.draw, options);
    task.done = true;
    progress.say("diagnosing simulated records",
                 0.6 + 0.3 * static_cast<double>(++done) / static_cast<double>(tasks.size()));
  });
  for (std::size_t e = 0; e < all.size(); ++e) {
    for (const std::size_t m : likely) {
      double named = 0, count = 0;
      for (const Task& task : tasks) {
        if (task.experiment != e || task.model != m || !task.done) continue;
        named += task.answer == Answer::named ? 1 : 0;
        count += 1;
        all[e].wrong += task.answer == Answer::wrong ? 1 : 0;
      }
      all[e].simulated += static_cast<std::size_t>(count);
      all[e].named += static_cast<std::size_t>(named);
      double& chance = all[e].of_models[m];
      chance = (kWeightOfExpected * chance + named) / (kWeightOfExpected + count);
    }
    all[e].probability = over_models(question, all[e].of_models);
  }
}

/// What moves the plateau acts alike in every run: only a measurement of the instrument itself settles it. With an
/// accelerometer on the block, dv_b/dt over its reading is the gain of the vibrometer.
void plan_for_plateau(const DiagnosedTraces& diagnosed, const Means& means, RunPlan& out) {
  for (const Rung& rung : found_effects(diagnosed.diagnosis)) {
    if (rung.equivalent.empty() || !is_of_plateau(rung.added)) continue;
    out.kind = QuestionKind::plateau;
    std::vector<std::string> names = {rung.added};
    names.insert(names.end(), rung.equivalent.begin(), rung.equivalent.end());
    for (const std::string& name : names) {
      out.models.emplace_back();
      out.models.back().name = name;
      out.models.back().probability = 1 / static_cast<double>(names.size());
    }
    const double gap = std::abs(diagnosed.traces.front().motion.plateau_ratio - 1);
    if (means.accelerometer && std::isfinite(gap)) {
      PlannedExperiment one{.experiment = {.runs = {}, .accelerometer = true}};
      one.probability = one.expected = chance_beyond(gap / kErrorOfAccelerometer);
      one.of_models.assign(names.size(), one.probability);
      out.experiments.push_back(std::move(one));
    }
    out.hopeless = out.experiments.empty() || out.experiments.front().probability < kHopeless;
    return;
  }
}

/// Effects that the records cannot show.
std::vector<std::string> not_shown(const Diagnosis& diagnosis) {
  std::vector<std::string> keys;
  for (const EffectFinding& finding : diagnosis.effects) {
    if (finding.status == EffectStatus::untestable) keys.push_back(finding.key);
  }
  return keys;
}

}  // namespace

std::string_view to_string(QuestionKind kind) {
  switch (kind) {
    case QuestionKind::group:
      return "group";
    case QuestionKind::possible:
      return "possible";
    case QuestionKind::plateau:
      return "plateau";
    case QuestionKind::nothing:
      break;
  }
  return "nothing";
}

RunPlan plan_runs(const DiagnosedTraces& diagnosed, const PlanOptions& options) {
  RunPlan out;
  PlanProgress progress(options);
  progress.say("what is open", 0.02);
  OpenQuestion question = open_question(diagnosed, options);
  out.kind = question.kind;
  out.reason = question.reason;
  out.not_asked = not_shown(diagnosed.diagnosis);
  out.usual_means = options.means.empty();
  if (!out.reason.empty() || out.kind == QuestionKind::nothing) {
    out.models = std::move(question.models);
    if (out.reason.empty()) plan_for_plateau(diagnosed, options.means, out);
    return out;
  }
  const Identification& trace = diagnosed.traces[question.trace];
  const Means means = out.usual_means ? usual_means(trace, options.means.longest) : options.means;
  out.own = conditions_of_record(question, trace);
  for (Experiment& experiment : experiments_for(question, trace, means)) {
    out.experiments.push_back({.experiment = std::move(experiment)});
  }
  expect(
      diagnosed, question, options, out.experiments.size(), 0,
      [&](double part) { progress.say("weighing experiments", 0.05 + 0.4 * part); }, out.experiments);
  rank(out.experiments);
  for (std::uint64_t draw = 1; draw < kDrawsOfModel; ++draw) {
    expect(
        diagnosed, question, options, kExperimentsDrawnAgain, draw,
        [&](double part) { progress.say("weighing the best again", 0.45 + 0.15 * part); }, out.experiments);
  }
  rank(out.experiments);
  diagnose_best(diagnosed, question, options, progress, out.experiments);
  rank(out.experiments);
  out.hopeless = out.experiments.empty() || out.experiments.front().probability < kHopeless;
  for (std::size_t e = 0; e < std::min(kExperimentsToSee, out.experiments.size()); ++e) {
    progress.say("what is to be seen", 0.9 + 0.02 * static_cast<double>(e));
    out.experiments[e].predictions = predict_seen(question, out.experiments[e].experiment, options);
  }
  if (!out.experiments.empty()) out.curves = predict_curves(question, out.experiments.front().experiment, options);
  out.models = std::move(question.models);
  progress.say("done", 1);
  return out;
}

}  // namespace tribofit
