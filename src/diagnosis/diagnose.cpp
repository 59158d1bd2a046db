#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "findings.hpp"
#include "fit/assessment.hpp"
#include "fit/fit_laws.hpp"
#include "fit/points.hpp"
#include "fit/spectral_lines.hpp"
#include "imitations.hpp"
#include "limits.hpp"
#include "nearby_models.hpp"
#include "record_evidence.hpp"
#include "stepwise.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {

namespace {

using namespace diagnosis;

/// Says what is being done, one thread at a time.
class ProgressReporter {
 public:
  explicit ProgressReporter(const DiagnosisOptions& options) : progress_(options.progress) {}
  void say(std::string_view what, double part) {
    const std::lock_guard lock(mutex_);
    if (progress_) progress_(what, part);
  }

 private:
  const std::function<void(std::string_view, double)>& progress_;
  std::mutex mutex_;
};

Diagnosis too_few_cycles(std::span<const Record> records, std::size_t cycles) {
  Diagnosis out;
  out.verdict = Verdict::not_enough_data;
  if (are_points(records)) {
    out.messages.push_back(
        fmt::format("there are {} points; {} are needed to hold some of them out", cycles, limits::kFewestCycles));
    out.next_experiment = "Measure more points, most of them where friction changes with speed.";
    return out;
  }
  out.messages.push_back(
      fmt::format("there are {} cycles; {} are needed to hold some of them out", cycles, limits::kFewestCycles));
  double duration = 0;
  for (const Record& record : records) duration += record.motion->duration();
  out.next_experiment =
      cycles > 0
          ? fmt::format("Record for at least {} s under the same conditions.",
                        fixed(std::ceil(1.2 * duration * limits::kFewestCycles / static_cast<double>(cycles)), 0))
          : "Record until the block has broken away a dozen times.";
  out.next_experiment += " If the block never stuck, say so: --never-sticks.";
  return out;
}

/// The law and the effects that these data ask for.
Ladder search(const DiagnosisContext& context, const std::vector<Law>& laws, const std::vector<Candidate>& all,
              const DiagnosisOptions& options, ProgressReporter& progress) {
  std::vector<Candidate> from_the_start;
  for (const Effect& effect : options.from_the_start) from_the_start.push_back({effect, describe(effect), {}, {}});
  Limits least;
  least.least_size = std::max(least.least_size, context.shared);
  return climb(context, laws, from_the_start, all, least, {options.most_effects, options.until},
               [&](std::string_view what, double part) { progress.say(what, 0.05 + 0.75 * part); });
}

/// Whether a fit ended where the ladder had found the model: within its 95 % intervals.
bool ends_at(const std::vector<double>& found, const Fit& fit) {
  if (fit.parameters.size() != found.size()) return false;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!(found[k] >= fit.parameters[k].lower95 && found[k] <= fit.parameters[k].upper95)) return false;
  }
  return true;
}

/// A fit of a model as `identify` makes it, from where the ladder found it. A search that ends on a bound may have gone
/// to the wrong valley: it is made from the starts of `identify` as well, and where they lead elsewhere the lower of
/// the two holds. at_bound: whether the ladder found it there.
Fit fit_as_identify(const FrictionModel& model, std::span<const Record> records, const Instruments& instruments,
                    const FitOptions& cold, std::vector<double> found, bool at_bound) {
  const Observations own = observations_for(model, records);
  const auto fit_cold = [&] { return fit_model(model, records, own, instruments, cold); };
  if (model.effects().empty()) return fit_cold();
  std::optional<Fit> again;
  if (at_bound) again = fit_cold();
  if (again && ends_at(found, *again)) return std::move(*again);
  FitOptions warm = cold;
  warm.start = std::move(found);
  Fit fit = fit_model(model, records, own, instruments, warm);
  if (std::ranges::none_of(fit.parameters, &FitParameter::at_bound)) return fit;
  if (!again) again = fit_cold();
  return !again->parameters.empty() && again->error.rmse <= fit.error.rmse ? std::move(*again) : fit;
}

/// Fits every rung. The first and the last, which are reported with all their figures, are fitted to what `identify`
/// fits them to, so that both say the same of one model. Rungs above the one that predicts best at full resolution go.
std::vector<Fit> fit_rungs(const DiagnosisContext& context, const Instruments& instruments, FitOptions options,
                           Ladder& ladder) {
  options.threads = context.threads;  // the last rung takes most of the time
  std::vector<Fit> fits(ladder.steps.size());
  run_tasks(ladder.steps.size(), context.threads, [&](std::size_t k) {
    const Trial& trial = ladder.steps[k].trial;
    if (k == 0 || k + 1 == ladder.steps.size()) {
      const bool at_bound = std::ranges::find(trial.at_bound, true) != trial.at_bound.end();
      fits[k] = fit_as_identify(trial.model, context.records, instruments, options, trial.p, at_bound);
      return;
    }
    FitOptions warm = options;
    warm.start = trial.p;
    fits[k] = fit_model(trial.model, context.records, context.fine.observations, instruments, warm);
  });
  // The last one is the one that predicts best: what comes after it has earned nothing.
  const auto error_of = [](const Fit& fit) {
    const double error = fit.parameters.empty() ? HUGE_VAL : fit.error.held_out_rmse;
    return std::isfinite(error) ? error : HUGE_VAL;
  };
  const auto last = std::ranges::min_element(fits, {}, error_of);
  if (last != fits.begin() && last + 1 != fits.end()) {
    const bool at_bound = std::ranges::any_of(last->parameters, &FitParameter::at_bound);
    *last = fit_as_identify(last->model, context.records, instruments, options, last->values(), at_bound);
  }
  fits.erase(last + 1, fits.end());
  ladder.steps.resize(fits.size());
  return fits;
}

/// Fits of laws that these data do not distinguish from that of a fitted model: with the same effects they predict
/// held-out cycles as well, by the comparison that `identify` makes of two laws too.
std::vector<Fit> rival_fits(const Ladder& ladder, const Fit& fitted, const DiagnosisContext& context,
                            const Instruments& instruments, const FitOptions& options) {
  std::vector<Fit> rivals(ladder.rivals.size());
  // Every law of the list holds friction that is constant in slip as a special case.
  if (!fitted.converged || constant_in_slip(fitted.model.law())) return {};
  run_tasks(ladder.rivals.size(), context.threads, [&](std::size_t k) {
    const Trial& other = ladder.rivals[k];
    FitOptions warm = options;
    if (!other.model.effects().empty()) warm.start = other.p;
    rivals[k] =
        fit_model(other.model, context.records, observations_for(other.model, context.records), instruments, warm);
  });
  std::erase_if(rivals, [&](const Fit& rival) {
    if (!rival.converged) return true;
    const Comparison comparison = compare_held_out(fitted, rival);
    return comparison.first_better && comparison.p_value < kClearlyBetter;
  });
  return rivals;
}

/// What a parameter may be over all models that the data do not distinguish: its interval in any of them.
void add_ranges(const std::vector<Fit>& rivals, Fit& fit) {
  for (FitParameter& own : fit.parameters) {
    for (const Fit& rival : rivals) {
      const auto other = std::ranges::find_if(rival.parameters, [&](const FitParameter& p) {
        return p.parameter.name == own.parameter.name && p.effect == own.effect &&
               p.parameter.unit == own.parameter.unit;
      });
      if (other == rival.parameters.end()) continue;
      if (!own.range) own.range = {own.lower95, own.upper95};
      own.range->lower = std::min(own.range->lower, other->lower95);
      own.range->upper = std::max(own.range->upper, other->upper95);
    }
  }
}

/// Points that are far apart in speed differ by more than noise: what the best rung leaves is no less than that.
double noise_of_points(double noise, const std::vector<Fit>& fits) {
  for (const Fit& rung : fits) noise = std::min(noise, rung.floor.noise);
  return noise;
}

/// One noise floor for all rungs, since it is a property of the records: the sensor noise, and the least of what the
/// rungs make of the scatter of break-away. A richer model that calls more of the error scatter has not explained it.
double share_floor(double noise, std::vector<Fit>& fits) {
  const auto of_scatter = [](const Fit& rung) {
    return std::max(0.0, std::pow(rung.floor.rmse, 2) - std::pow(rung.floor.noise, 2));
  };
  const auto least = std::min_element(fits.begin(), fits.end(),
                                      [&](const Fit& a, const Fit& b) { return of_scatter(a) < of_scatter(b); });
  const double scatter = of_scatter(*least);
  Floor floor = least->floor;
  floor.noise = noise;
  floor.rmse = std::sqrt(floor.noise * floor.noise + scatter);
  for (Fit& rung : fits) set_floor(floor, rung);
  return floor.rmse;
}

/// Where the base law fails, and what the last rung leaves.
void add_shares(const Ladder& ladder, const std::vector<Probe>& structure, Diagnosis& diagnosis) {
  double left = 0;
  for (const Probe& probe : structure) left = std::max(left, probe.fall);
  const double climbed = ladder.steps[0].trial.held_out_squares - ladder.top().held_out_squares;
  diagnosis.where = shares_of(ladder.steps.front().probes, climbed + left);
  add_share_of_stick(ladder, climbed + left, diagnosis.where);
  diagnosis.remaining = shares_of(ladder.steps.back().probes, left);
}

std::vector<Rung> rungs_of(const Ladder& ladder, const std::vector<Candidate>& all, const std::vector<Fit>& fits) {
  std::vector<Rung> rungs;
  for (std::size_t s = 0; s < ladder.steps.size(); ++s) {
    const LadderStep& step = ladder.steps[s];
    Rung rung;
    if (step.added) rung.added = all[*step.added].info.key;
    rung.rmse = fits[s].error.rmse;
    rung.held_out_rmse = fits[s].error.held_out_rmse;
    rung.held_out_std_error = held_out_std_error(fits[s]);
    for (const std::size_t k : step.equivalent) rung.equivalent.push_back(all[k].info.key);
    rungs.push_back(std::move(rung));
  }
  return rungs;
}

/// The effects that were found remove less than they leave of what the base law has above the noise floor, and what
/// they leave is beyond the error of the held-out error.
bool is_most_left(const std::vector<Fit>& fits, double floor) {
  const double first = fits.front().error.held_out_rmse, last = fits.back().error.held_out_rmse;
  const bool clear = last > kAtFloor * floor && last - limits::kClearOfFloor * held_out_std_error(fits.back()) > floor;
  return fits.size() > 1 && clear &&
         last * last - floor * floor > limits::kMostOfTheError * (first * first - floor * floor);
}

/// Most of what the last rung leaves above the noise floor is a level of friction that wanders slowly.
bool wanders(const Trial& top, const Fit& fit) {
  const double above = std::pow(fit.error.held_out_rmse, 2) - std::pow(fit.floor.rmse, 2);
  return slow_noise_of(top.evidence).variance_within() > limits::kMostOfTheError * above;
}

/// Far above the noise floor, an error that no recorded variable explains is not explained either.
void decide(const std::vector<Fit>& fits, bool structured, const Trial& top, Diagnosis& diagnosis) {
  const bool added = fits.size() > 1;
  diagnosis.verdict = structured ? Verdict::unexplained : added ? Verdict::effect_found : Verdict::sufficient;
  const bool possible = std::any_of(diagnosis.effects.begin(), diagnosis.effects.end(),
                                    [](const EffectFinding& f) { return f.status == EffectStatus::possible; });
  if (possible) diagnosis.verdict = Verdict::unexplained;
  // Slow noise that the floor does not hold in full is no structure either.
  const bool slow = wanders(top, fits.back());
  const double far = added || slow ? limits::kFarAboveAfterEffects : limits::kFarAboveFloor;
  const double error = fits.back().error.held_out_rmse, left_over = error / diagnosis.floor_rmse;
  if (structured || possible) return;
  if (is_most_left(fits, diagnosis.floor_rmse)) {
    diagnosis.verdict = Verdict::unexplained;
    diagnosis.messages.push_back("the effects found explain less than half of the error above the noise floor");
    return;
  }
  // Few cycles that wander say little of a noise floor, and as little of an error, unless it is many times as large.
  const bool beyond_chance =
      over_floor(fits.back()) > far &&
      error - limits::kClearOfFloor * held_out_std_error(fits.back()) > far * diagnosis.floor_rmse;
  if (!beyond_chance && !is_clearly_above_floor(fits.back())) return;
  diagnosis.verdict = Verdict::unexplained;
  diagnosis.messages.push_back(
      fmt::format("what remains is {} times the noise floor and no recorded variable explains it beyond chance: {}",
                  fixed(left_over, 1),
                  slow ? "most of it wanders slowly over time, as slow noise does"
                       : "it changes from cycle to cycle, or with something that was not recorded"));
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::sufficient:
      return "sufficient";
    case Verdict::effect_found:
      return "effect-found";
    case Verdict::unexplained:
      return "unexplained";
    case Verdict::unconfirmed:
      return "unconfirmed";
    case Verdict::unfinished:
      return "unfinished";
    case Verdict::not_enough_data:
      break;
  }
  return "not-enough-data";
}

std::string_view to_string(EffectStatus status) {
  switch (status) {
    case EffectStatus::found:
      return "missing";
    case EffectStatus::equivalent:
      return "equivalent";
    case EffectStatus::possible:
      return "possible";
    case EffectStatus::superseded:
      return "superseded";
    case EffectStatus::not_supported:
      return "unsupported";
    case EffectStatus::untried:
      return "untried";
    case EffectStatus::untestable:
      break;
  }
  return "untestable";
}

std::string_view status_text(EffectStatus status) {
  if (status == EffectStatus::found) return "found";
  if (status == EffectStatus::untried) return "not tried";
  return status == EffectStatus::not_supported ? "not supported by the data" : to_string(status);
}

Diagnosed diagnose(std::span<const Record> records, const std::vector<Law>& given, const std::vector<Effect>& own,
                   const Instruments& instruments, const FitOptions& fit, const DiagnosisOptions& options) {
  Diagnosed out;
  Diagnosis& diagnosis = out.diagnosis;
  const std::size_t cycles = count_cycles(records);
  if (cycles < limits::kFewestCycles) return {too_few_cycles(records, cycles), {}};
  ProgressReporter progress(options);
  progress.say("reading slips", 0.02);
  const RecordEvidence evidence(records, options.threads, fit.given);
  const DiagnosisContext& context = evidence.context;
  const std::vector<Candidate> all = candidates(records, evidence.fine, own, instruments);

  for (const Effect& effect : options.from_the_start) diagnosis.from_the_start.push_back(describe(effect).spelled());
  Ladder ladder = search(context, competing_laws(given, options.from_the_start), all, options, progress);
  diagnosis.law = ladder.top().model.law();
  if (!ladder.top().usable) {
    diagnosis.verdict = Verdict::not_enough_data;
    diagnosis.messages.push_back("no base law could be fitted");
    return out;
  }
  progress.say("fitting every rung", 0.85);
  out.fits = fit_rungs(context, instruments, fit, ladder);
  diagnosis.floor_rmse =
      share_floor(are_points(records) ? noise_of_points(context.noise, out.fits) : context.noise, out.fits);
  diagnosis.floor_is_sampling = evidence.floor.sampling > 0;
  const std::vector<Probe> structure = remaining_structure(ladder.steps.back().probes, context.shared);
  add_shares(ladder, structure, diagnosis);
  diagnosis.effects = findings_of(context, ladder, all, out.fits, diagnosis.floor_rmse);
  diagnosis.ladder = rungs_of(ladder, all, out.fits);
  if (ladder.out_of_time) {
    diagnosis.verdict = Verdict::unfinished;
    return out;
  }
  const std::vector<Fit> rivals = rival_fits(ladder, out.fits.back(), context, instruments, fit);
  for (const Fit& rival : rivals) diagnosis.rival_laws.push_back(rival.model.law());
  add_ranges(rivals, out.fits.back());
  decide(out.fits, !structure.empty(), ladder.top(), diagnosis);
  diagnosis.next_experiment = next_experiment(ladder, all, structure);
  progress.say("a closed form of the rest", 0.95);
  if (!structure.empty()) diagnosis.formula = closed_form(context, ladder.top(), structure.front());
  progress.say("done", 1);
  return out;
}

std::vector<ResidualVariable> remaining_over(std::span<const Record> records, const Fit& fit, int threads) {
  if (!fit.converged || count_cycles(records) < limits::kFewestCycles) return {};
  const RecordEvidence evidence(records, threads);
  const DiagnosisContext& context = evidence.context;
  const Trial fine = try_model(context, context.fine, fit.model, fit.values(), threads);
  if (!fine.usable) return {};
  const Trial coarse = try_model(context, context.coarse, fit.model, fine.p, threads);
  std::vector<ResidualVariable> out;
  const auto probes = probe_all(context, coarse, fine, residual_of(context, fine));
  for (const Probe& probe : remaining_structure(probes, context.shared)) out.push_back(probe.variable);
  return out;
}

}  // namespace tribofit
