#include "tribofit/study/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "diagnosis/conclusions.hpp"
#include "limits.hpp"
#include "open_question.hpp"
#include "step_counter.hpp"
#include "tribofit/execution/parallel.hpp"

namespace tribofit {

namespace {

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

/// An experiment with what its simulated runs say.
struct Weighed {
  PlannedExperiment planned;
  std::vector<std::vector<Evidence>> draws = {};  ///< of each model
  bool drawn_again = false;                       ///< these are all of them, and not the first one
  bool looked_at = false;                         ///< in full, or that takes too long
  std::vector<double> expected_of = {};           ///< of each model, by the draws alone

  double worth() const { return planned.probability - kCostOfMinute * planned.minutes(); }
  bool is_by_hand() const { return planned.experiment.is_by_hand(); }
  /// A full diagnosis of simulated records says more than its draws.
  bool is_only_expected() const { return !is_by_hand() && planned.reason.empty() && planned.simulated == 0; }
};

/// Weighs the experiments of a question, the best ones more closely.
class Weighing {
 public:
  Weighing(const OpenQuestion& question, const Means& means) : question_(question), options_(question.options) {
    for (std::size_t m = 0; m < question.models.size(); ++m) {
      if (question.models[m].probability >= kLeastLikely) likely_.push_back(m);
    }
    for (Experiment& experiment : experiments_for(question, means)) {
      all_.push_back({{.experiment = std::move(experiment)}});
    }
    std::vector<std::size_t> every(all_.size());
    std::iota(every.begin(), every.end(), std::size_t{0});
    expect(every, 0, 1, part_of_work("weighing experiments", 0.05, 0.35));
    for (Weighed& one : all_) lengthen(means.longest, one);
    draw_best_again();
    diagnose_best();
    rank();
  }

  std::vector<PlannedExperiment> planned() {
    std::vector<PlannedExperiment> out;
    for (Weighed& one : all_) out.push_back(std::move(one.planned));
    return out;
  }

 private:
  /// Reports a part of the whole work.
  std::function<void(double)> part_of_work(std::string_view what, double begin, double length) const {
    return [this, what, begin, length](double part) {
      if (options_.progress) options_.progress(what, begin + length * part);
    };
  }
  bool is_late() const { return options_.until && std::chrono::steady_clock::now() >= *options_.until; }
  void rank() {
    std::stable_sort(all_.begin(), all_.end(),
                     [](const Weighed& a, const Weighed& b) { return a.worth() > b.worth(); });
  }
  /// Cycles of all records, as many as a run of this length has, too.
  double cycles_with(const Experiment& experiment) const {
    double cycles = 0;
    for (const Identification& trace : question_.diagnosed.traces) {
      cycles += static_cast<double>(trace.segmentation.cycles.size());
    }
    const Identification& own = question_.own();
    const double frequency = static_cast<double>(own.segmentation.cycles.size()) / std::max(1e-9, own.duration);
    return cycles + frequency * experiment.duration();
  }

  /// Chances of an experiment as they are expected, and as they come true: what is read by hand is no draw.
  void set_chances(Weighed& one, const std::vector<std::vector<Evidence>>& draws,
                   const Lengthening& lengthening) const {
    one.expected_of.assign(question_.models.size(), std::numeric_limits<double>::quiet_NaN());
    for (const std::size_t m : likely_) one.expected_of[m] = chance_to_name(question_, m, draws[m], lengthening);
    one.planned.expected = over_models(question_, one.expected_of);
    one.planned.of_models = one.is_by_hand() ? one.expected_of : calibrated(question_, one.expected_of);
    one.planned.probability = over_models(question_, one.planned.of_models);
  }

  /// draws: of every likely model in turn; some of them missing where the time was over.
  void set_draws(std::vector<std::optional<Evidence>> draws, Weighed& one) const {
    PlannedExperiment& planned = one.planned;
    const std::size_t each = draws.size() / likely_.size();
    if (!std::all_of(draws.begin(), draws.end(), [](const auto& draw) { return draw.has_value(); })) {
      if (!one.draws.empty()) return;
      planned.reason = "there was no time to weigh it";
      planned.of_models.assign(question_.models.size(), std::numeric_limits<double>::quiet_NaN());
      one.expected_of = planned.of_models;
      return;
    }
    one.drawn_again = !one.draws.empty();
    one.draws.assign(question_.models.size(), {});
    bool any = false;
    for (std::size_t t = 0; t < draws.size(); ++t) {
      any |= draws[t]->simulated;
      one.draws[likely_[t / each]].push_back(std::move(*draws[t]));
    }
    set_chances(one, one.draws, {});
    if (any) return;
    planned.reason = "its motion could not be simulated";
    planned.probability = 0;
    for (double& p : planned.of_models) {
      if (std::isfinite(p)) p = 0;  // and not those that were not simulated
    }
  }

  /// Simulates draws `first` and those behind it, `each` of every likely model, for some of the experiments.
  void expect(const std::vector<std::size_t>& experiments, std::uint64_t first, std::size_t each,
              const std::function<void(double)>& say) {
    const std::size_t draws = likely_.size() * each;
    std::vector<std::vector<std::optional<Evidence>>> found(experiments.size(),
                                                            std::vector<std::optional<Evidence>>(draws));
    StepCounter counter(experiments.size() * draws, say);
    run_tasks(experiments.size() * draws, options_.threads, [&](std::size_t t) {
      if (is_late()) return;
      const Experiment& experiment = all_[experiments[t / draws]].planned.experiment;
      found[t / draws][t % draws] = weigh_draw(question_, experiment, likely_[t % draws / each], first + t % each);
      counter.step();
    });
    for (std::size_t k = 0; k < experiments.size(); ++k) set_draws(std::move(found[k]), all_[experiments[k]]);
  }

  /// Makes the runs of an experiment as long as is worth it, within the time and what can be simulated.
  void lengthen(double longest, Weighed& one) const {
    if (!one.is_only_expected() || !one.planned.experiment.runs.front().pauses.empty()) return;
    const double before = cycles_with({}), all = cycles_with(one.planned.experiment);
    Weighed best{.planned = one.planned, .expected_of = one.expected_of};
    for (const double factor : kLongerRuns) {
      Weighed longer{.planned = one.planned};
      for (RunConditions& run : longer.planned.experiment.runs) run.duration *= factor;
      const double cycles = before + factor * (all - before);
      if (longer.planned.experiment.duration() > longest || cycles > kMostSimulatedCycles) break;
      set_chances(longer, one.draws, {factor, cycles / all});
      if (longer.worth() > best.worth()) best = std::move(longer);
    }
    one.planned = std::move(best.planned);
    one.expected_of = std::move(best.expected_of);
  }

  /// Draws again those that may be the best: the chances of one that leads by a single draw are too high. Those draws
  /// are not among the new ones.
  void draw_best_again() {
    for (std::size_t round = 0; round < kBestExperiments; ++round) {
      rank();
      const auto next = std::find_if(all_.begin(), all_.end(), [](const Weighed& one) { return !one.drawn_again; });
      const auto place = static_cast<std::size_t>(next - all_.begin());
      if (place == all_.size() || place >= kExperimentsInFull || is_late()) return;
      const double part = 0.2 / static_cast<double>(kBestExperiments);
      expect({place}, 1, kDrawsOfModel,
             part_of_work("weighing the best again", 0.4 + part * static_cast<double>(round), part));
    }
  }

  /// Lowers the chances of those that were not diagnosed in full by what full diagnoses made of the others: the
  /// expected chances know the models in question alone, not the whole catalogue.
  void lower_expected() {
    const double part = std::min(1.0, (kWeightOfExpected + named_) / (kWeightOfExpected + expected_));
    for (Weighed& one : all_) {
      if (!one.is_only_expected()) continue;
      std::vector<double> lowered = one.expected_of;
      for (double& p : lowered) p *= part;
      one.planned.of_models = calibrated(question_, std::move(lowered));
      one.planned.probability = over_models(question_, one.planned.of_models);
    }
  }

  /// Diagnoses simulated records of an experiment in full, at least so many of each model: what is named counts beside
  /// the expected chance.
  void diagnose_in_full(std::size_t least, const std::function<void(double)>& say, Weighed& weighed) {
    PlannedExperiment& one = weighed.planned;
    const double cycles = cycles_with(one.experiment);
    const double records = options_.effort * kMostDiagnosedCycles / cycles;
    const auto worth_it = static_cast<std::size_t>(records / static_cast<double>(likely_.size()));
    const std::size_t draws = std::clamp(worth_it, least, kDrawsOfModel);
    std::vector<std::optional<Answer>> answers(draws * likely_.size());
    StepCounter counter(answers.size(), say);
    run_tasks(answers.size(), options_.threads, [&](std::size_t t) {
      if (is_late()) return;
      answers[t] = diagnose_simulated(question_, one.experiment, likely_[t % likely_.size()], 500 + t / likely_.size(),
                                      kTimesTheCycles * cycles);
      counter.step();
    });
    weighed.looked_at = true;
    const std::vector<double> before = calibrated(question_, weighed.expected_of);
    for (std::size_t l = 0; l < likely_.size(); ++l) {
      const std::size_t m = likely_[l];
      double named = 0, count = 0;
      for (std::size_t t = l; t < answers.size(); t += likely_.size()) {
        if (!answers[t]) continue;
        named += answers[t] == Answer::named ? 1 : 0;
        count += 1;
        one.wrong += answers[t] == Answer::wrong ? 1U : 0U;
      }
      one.simulated += static_cast<std::size_t>(count);
      one.named += static_cast<std::size_t>(named);
      named_ += named, expected_ += count * weighed.expected_of[m];
      one.of_models[m] = (kWeightOfExpected * before[m] + named) / (kWeightOfExpected + count);
    }
    one.probability = over_models(question_, one.of_models);
  }

  /// Diagnoses the best experiments in full, until the best of all is one of them.
  void diagnose_best() {
    for (std::size_t round = 0; round < kBestExperiments && !is_late(); ++round) {
      rank();
      const auto next = std::find_if(all_.begin(), all_.end(), [](const Weighed& one) {
        return one.is_only_expected() && !one.looked_at && one.planned.expected >= 0.5 * kHopeless;
      });
      if (next == all_.end() || (round >= kExperimentsInFull && next != all_.begin())) break;
      const double part = 0.3 / static_cast<double>(kBestExperiments);
      // The first is always looked at, however long it takes.
      diagnose_in_full(round == 0 && options_.effort > 0 ? 1 : 0,
                       part_of_work("diagnosing simulated records", 0.6 + part * static_cast<double>(round), part),
                       *next);
      lower_expected();
    }
  }

  const OpenQuestion& question_;
  const PlanOptions& options_;
  std::vector<std::size_t> likely_;  ///< models that are likely enough to be simulated as the true one
  std::vector<Weighed> all_;
  double named_ = 0, expected_ = 0;  ///< full diagnoses that name the truth, and as many as were expected to
};

/// An effect of the motion that moves the plateau of stick.
bool is_of_plateau(const std::string& key) {
  return std::any_of(effect_catalogue().begin(), effect_catalogue().end(),
                     [&](const Effect& effect) { return describe(effect).key == key && is_kinematic(effect); });
}

/// What moves the plateau acts alike in every run: only a measurement of the instrument itself settles it. With an
/// accelerometer on the block, dv_b/dt over its reading is the gain of the vibrometer.
void plan_for_plateau(const DiagnosedTraces& diagnosed, const Means& means, RunPlan& out) {
  for (const Rung& rung : found_effects(diagnosed.diagnosis)) {
    if (rung.equivalent.empty() || !is_of_plateau(rung.added)) continue;
    out.kind = QuestionKind::plateau;
    out.models.push_back({.name = rung.added});
    for (const std::string& name : rung.equivalent) out.models.push_back({.name = name});
    for (ModelInQuestion& model : out.models) model.probability = 1 / static_cast<double>(out.models.size());
    const double gap = std::abs(diagnosed.traces.front().motion.plateau_ratio - 1);
    if (means.accelerometer && std::isfinite(gap)) {
      PlannedExperiment one{.experiment = {.runs = {}, .accelerometer = true}};
      one.probability = one.expected = chance_beyond(gap / kErrorOfAccelerometer);
      one.of_models.assign(out.models.size(), one.probability);
      out.experiments.push_back(std::move(one));
    }
    out.hopeless = out.experiments.empty() || out.experiments.front().probability < kHopeless;
    return;
  }
}

}  // namespace

std::string_view to_string(QuestionKind kind) {
  constexpr std::string_view kNames[] = {"nothing", "group", "possible", "plateau"};
  return kNames[static_cast<std::size_t>(kind)];
}

RunPlan plan_runs(const DiagnosedTraces& diagnosed, const PlanOptions& options) {
  RunPlan out;
  const auto say = [&](std::string_view what, double part) {
    if (options.progress) options.progress(what, part);
  };
  say("what is open", 0.02);
  OpenQuestion question = open_question(diagnosed, options);
  out.kind = question.kind;
  out.reason = question.reason;
  for (const EffectFinding& finding : diagnosed.diagnosis.effects) {
    if (finding.status == EffectStatus::untestable) out.not_asked.push_back(finding.key);
  }
  out.usual_means = options.means.empty();
  if (!out.reason.empty() || out.kind == QuestionKind::nothing) {
    out.models = std::move(question.models);
    if (out.reason.empty()) plan_for_plateau(diagnosed, options.means, out);
    return out;
  }
  Means means = out.usual_means ? usual_means(question.own(), options.means.longest) : options.means;
  if (!(means.longest > 0)) means.longest = kUsualLongest;
  out.own = question.own_conditions();
  out.experiments = Weighing(question, means).planned();
  out.hopeless = out.experiments.empty() || out.experiments.front().probability < kHopeless;
  for (std::size_t e = 0; e < std::min(kBestExperiments, out.experiments.size()); ++e) {
    if (e > 0 && options.until && std::chrono::steady_clock::now() >= *options.until) break;
    say("what is to be seen", 0.9 + 0.02 * static_cast<double>(e));
    predict_seen(question, out.experiments[e], e == 0 ? &out.curves : nullptr);
  }
  out.models = std::move(question.models);
  say("done", 1);
  return out;
}

}  // namespace tribofit
