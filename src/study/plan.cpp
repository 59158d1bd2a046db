#include "tribofit/study/plan.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "diagnosis/conclusions.hpp"
#include "experiments.hpp"
#include "limits.hpp"
#include "open_question.hpp"
#include "seen_in_runs.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/execution/stop.hpp"
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

/// Expected chances as they come true: those of all models are moved alike, so that their mean is calibrated.
std::vector<double> calibrated(const OpenQuestion& question, std::vector<double> of_models) {
  const double expected = over_models(question, of_models), stated = calibrated_chance(expected);
  for (double& p : of_models)
    p = stated < expected ? p * stated / expected : 1 - (1 - p) * (1 - stated) / (1 - expected);
  return of_models;
}

/// An effect of the motion that moves the plateau of stick.
bool is_of_plateau(const std::string& key) {
  return std::any_of(effect_catalogue().begin(), effect_catalogue().end(),
                     [&](const Effect& effect) { return describe(effect).key == key && is_kinematic(effect); });
}

/// An experiment with what its simulated runs say.
struct Weighed {
  PlannedExperiment planned;
  std::vector<std::vector<Evidence>> draws = {};  ///< of each model
  bool drawn_again = false;                       ///< these are all of them, and not the first one
  bool looked_at = false;                         ///< in full, or that takes too long
  std::vector<double> expected_of = {};           ///< of each model, by the draws alone
};

double worth(const PlannedExperiment& one) {
  return one.probability - kCostOfMinute * one.minutes();
}

void rank(std::vector<Weighed>& all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Weighed& a, const Weighed& b) { return worth(a.planned) > worth(b.planned); });
}

bool is_late(const PlanOptions& options) {
  return options.until && std::chrono::steady_clock::now() >= *options.until;
}

/// Models that are likely enough to be simulated as the true one.
std::vector<std::size_t> likely_models(const OpenQuestion& question) {
  std::vector<std::size_t> likely;
  for (std::size_t m = 0; m < question.models.size(); ++m) {
    if (question.models[m].probability >= kLeastLikely) likely.push_back(m);
  }
  return likely;
}

/// Cycles of all records, as many as a run of this length has, too.
double cycles_with(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const Experiment& experiment) {
  double cycles = 0;
  for (const Identification& trace : diagnosed.traces) cycles += static_cast<double>(trace.segmentation.cycles.size());
  const Identification& own = diagnosed.traces[question.trace];
  const double frequency = static_cast<double>(own.segmentation.cycles.size()) / std::max(1e-9, own.duration);
  return cycles + frequency * experiment.duration();
}

/// What is known of the chances of an experiment from its draws. lengthening: see Lengthening.
std::vector<double> chances_of(const OpenQuestion& question, const Weighed& one, const Lengthening& lengthening = {}) {
  std::vector<double> chances(question.models.size(), std::numeric_limits<double>::quiet_NaN());
  for (const std::size_t m : likely_models(question)) {
    chances[m] = chance_to_name(question, m, one.draws[m], lengthening);
  }
  return chances;
}

/// Chances of an experiment as they are expected, and as they come true: what is read by hand is no draw.
void set_chances(const OpenQuestion& question, std::vector<double> expected, Weighed& one) {
  PlannedExperiment& planned = one.planned;
  planned.expected = over_models(question, expected);
  planned.of_models = planned.experiment.is_by_hand() ? expected : calibrated(question, expected);
  planned.probability = over_models(question, planned.of_models);
  one.expected_of = std::move(expected);
}

/// Simulates draws number `range.first` to `range.second` (not itself) of every likely model for some of the
/// experiments, which say the expected chances.
void expect(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const PlanOptions& options,
            const std::vector<std::size_t>& experiments, std::pair<std::uint64_t, std::uint64_t> range,
            const std::function<void(double)>& say, std::vector<Weighed>& all) {
  const std::vector<std::size_t> likely = likely_models(question);
  const std::size_t each = range.second - range.first;
  std::vector<std::optional<Evidence>> found(experiments.size() * likely.size() * each);
  std::atomic<std::size_t> done{0};
  run_tasks(found.size(), options.threads, [&](std::size_t t) {
    if (is_late(options)) return;
    const Experiment& experiment = all[experiments[t / each / likely.size()]].planned.experiment;
    found[t] =
        weigh_draw(diagnosed, question, experiment, likely[t / each % likely.size()], range.first + t % each, options);
    say(static_cast<double>(++done) / static_cast<double>(found.size()));
  });
  for (std::size_t k = 0; k < experiments.size(); ++k) {
    Weighed& weighed = all[experiments[k]];
    const std::span own(found.data() + k * likely.size() * each, likely.size() * each);
    if (!std::all_of(own.begin(), own.end(), [](const auto& draw) { return draw.has_value(); })) {
      if (!weighed.draws.empty()) continue;
      weighed.planned.reason = "there was no time to weigh it";
      weighed.planned.of_models.assign(question.models.size(), std::numeric_limits<double>::quiet_NaN());
      weighed.expected_of = weighed.planned.of_models;
      continue;
    }
    weighed.draws.assign(question.models.size(), {});
    bool any = false;
    for (std::size_t t = 0; t < own.size(); ++t) {
      any |= own[t]->simulated;
      weighed.draws[likely[t / each]].push_back(std::move(*own[t]));
    }
    weighed.drawn_again = range.first > 0;
    PlannedExperiment& one = weighed.planned;
    if (!any) one.reason = "its motion could not be simulated";
    set_chances(question, chances_of(question, weighed), weighed);
    if (any) continue;
    one.probability = 0;
    for (double& p : one.of_models) {
      if (std::isfinite(p)) p = 0;  // and not those that were not simulated
    }
  }
}

/// Makes the runs of an experiment as long as is worth it, within the time and what can be simulated.
void lengthen(const DiagnosedTraces& diagnosed, const OpenQuestion& question, double longest, Weighed& one) {
  PlannedExperiment& planned = one.planned;
  const std::vector<RunConditions>& runs = planned.experiment.runs;
  if (planned.experiment.is_by_hand() || !planned.reason.empty() || !runs.front().pauses.empty()) return;
  const double before = cycles_with(diagnosed, question, {}),
               all = cycles_with(diagnosed, question, planned.experiment);
  Weighed best{.planned = planned, .expected_of = one.expected_of};
  for (const double factor : kLongerRuns) {
    PlannedExperiment longer = planned;
    for (RunConditions& run : longer.experiment.runs) run.duration *= factor;
    const double cycles = before + factor * (all - before);
    if (longer.experiment.duration() > longest || cycles > kMostSimulatedCycles) break;
    Weighed as_long{.planned = std::move(longer)};
    set_chances(question, chances_of(question, one, {factor, cycles / all}), as_long);
    if (worth(as_long.planned) > worth(best.planned)) best = std::move(as_long);
  }
  planned = std::move(best.planned);
  one.expected_of = std::move(best.expected_of);
}

/// Draws again those that may be the best: the chances of one that leads by a single draw are too high. Those draws are
/// not among the new ones.
void draw_best_again(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const PlanOptions& options,
                     PlanProgress& progress, std::vector<Weighed>& all) {
  for (std::size_t round = 0; round < kExperimentsDrawnAgain; ++round) {
    rank(all);
    std::size_t next = 0;
    while (next < all.size() && all[next].drawn_again) ++next;
    if (next == all.size() || next >= kExperimentsInFull || is_late(options)) return;
    const auto say = [&](double part) {
      progress.say("weighing the best again",
                   0.4 + 0.2 * (static_cast<double>(round) + part) / static_cast<double>(kExperimentsDrawnAgain));
    };
    expect(diagnosed, question, options, {next}, {1, 1 + kDrawsOfModel}, say, all);
  }
}

/// An experiment of which a full diagnosis of simulated records says more than its draws.
bool is_only_expected(const Weighed& one) {
  return !one.planned.experiment.is_by_hand() && one.planned.reason.empty() && one.planned.simulated == 0;
}

/// Full diagnoses beside what was expected of them.
struct Verified {
  double named = 0, expected = 0;
  /// Of the expected chances of other experiments: they know the models in question alone, not the whole catalogue.
  double part() const { return std::min(1.0, (kWeightOfExpected + named) / (kWeightOfExpected + expected)); }
};

/// Lowers the chances of those that were not diagnosed in full by what full diagnoses made of the others.
void lower_expected(const OpenQuestion& question, const Verified& verified, std::vector<Weighed>& all) {
  for (Weighed& one : all) {
    if (!is_only_expected(one)) continue;
    std::vector<double> lowered = one.expected_of;
    for (double& p : lowered) p *= verified.part();
    one.planned.of_models = calibrated(question, std::move(lowered));
    one.planned.probability = over_models(question, one.planned.of_models);
  }
}

/// Diagnoses simulated records of an experiment in full: what is named counts beside the expected chance.
void diagnose_in_full(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const PlanOptions& options,
                      bool at_least_one, const std::function<void(double)>& say, Weighed& weighed, Verified& verified) {
  struct Task {
    std::size_t model;
    std::uint64_t draw;
    std::optional<Answer> answer = {};
  };
  PlannedExperiment& one = weighed.planned;
  const std::vector<std::size_t> likely = likely_models(question);
  const double cycles = cycles_with(diagnosed, question, one.experiment);
  const double records = options.effort * kMostDiagnosedCycles / cycles;
  const auto worth_it = static_cast<std::size_t>(records / static_cast<double>(likely.size()));
  const std::size_t least = at_least_one ? 1U : 0U, draws = std::clamp(worth_it, least, kMostDrawsInFull);
  std::vector<Task> tasks;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    for (const std::size_t m : likely) tasks.push_back({m, 500 + draw});
  }
  std::atomic<std::size_t> done{0};
  run_tasks(tasks.size(), options.threads, [&](std::size_t t) {
    if (is_late(options)) return;
    tasks[t].answer = diagnose_simulated(diagnosed, question, one.experiment, tasks[t].model, tasks[t].draw,
                                         kTimesTheCycles * cycles, options);
    say(static_cast<double>(++done) / static_cast<double>(tasks.size()));
  });
  weighed.looked_at = true;
  const std::vector<double> before = calibrated(question, weighed.expected_of);
  for (const std::size_t m : likely) {
    double named = 0, count = 0;
    for (const Task& task : tasks) {
      if (task.model != m || !task.answer) continue;
      named += *task.answer == Answer::named ? 1 : 0;
      count += 1;
      one.wrong += *task.answer == Answer::wrong ? 1U : 0U;
    }
    one.simulated += static_cast<std::size_t>(count);
    one.named += static_cast<std::size_t>(named);
    verified.named += named, verified.expected += count * weighed.expected_of[m];
    one.of_models[m] = (kWeightOfExpected * before[m] + named) / (kWeightOfExpected + count);
  }
  one.probability = over_models(question, one.of_models);
}

/// Diagnoses the best experiments in full, until the best of all is one of them.
void diagnose_best(const DiagnosedTraces& diagnosed, const OpenQuestion& question, const PlanOptions& options,
                   PlanProgress& progress, std::vector<Weighed>& all) {
  Verified verified;
  for (std::size_t round = 0; round < kMostExperimentsInFull && !is_late(options); ++round) {
    rank(all);
    const auto next = std::find_if(all.begin(), all.end(), [](const Weighed& one) {
      return is_only_expected(one) && !one.looked_at && one.planned.expected >= 0.5 * kHopeless;
    });
    if (next == all.end() || (round >= kExperimentsInFull && next != all.begin())) break;
    const auto say = [&](double part) {
      progress.say("diagnosing simulated records",
                   0.6 + 0.3 * (static_cast<double>(round) + part) / static_cast<double>(kMostExperimentsInFull));
    };
    // The first is always looked at, however long it takes.
    diagnose_in_full(diagnosed, question, options, round == 0 && options.effort > 0, say, *next, verified);
    lower_expected(question, verified, all);
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
  std::vector<Weighed> weighed;
  for (Experiment& experiment : experiments_for(question, trace, means)) {
    weighed.push_back({{.experiment = std::move(experiment)}});
  }
  std::vector<std::size_t> every(weighed.size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  expect(
      diagnosed, question, options, every, {0, 1},
      [&](double part) { progress.say("weighing experiments", 0.05 + 0.35 * part); }, weighed);
  const double longest = means.longest > 0 ? means.longest : kUsualLongest;
  for (Weighed& one : weighed) lengthen(diagnosed, question, longest, one);
  draw_best_again(diagnosed, question, options, progress, weighed);
  rank(weighed);
  diagnose_best(diagnosed, question, options, progress, weighed);
  rank(weighed);
  for (Weighed& one : weighed) out.experiments.push_back(std::move(one.planned));
  out.hopeless = out.experiments.empty() || out.experiments.front().probability < kHopeless;
  for (std::size_t e = 0; e < std::min(kExperimentsToSee, out.experiments.size()); ++e) {
    if (e > 0 && is_late(options)) break;
    progress.say("what is to be seen", 0.9 + 0.02 * static_cast<double>(e));
    Seen seen = predict_seen(question, out.experiments[e].experiment, e == 0, options);
    out.experiments[e].predictions = std::move(seen.predictions);
    if (e == 0) out.curves = std::move(seen.curves);
  }
  out.models = std::move(question.models);
  progress.say("done", 1);
  return out;
}

}  // namespace tribofit
