#include "hidden_effects.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <mutex>

#include "tribofit/execution/parallel.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/pipeline.hpp"

namespace recovery {

using namespace tribofit;

namespace {

constexpr std::size_t kLargestGroup = 4;

const EffectFinding* finding(const Diagnosis& diagnosis, std::string_view key) {
  const auto at = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                               [&](const EffectFinding& f) { return f.key == key; });
  return at != diagnosis.effects.end() ? &*at : nullptr;
}

bool holds(const Name& name, const std::string& key) {
  return name.added == key || std::find(name.equivalent.begin(), name.equivalent.end(), key) != name.equivalent.end();
}

std::size_t size_of(const Name& name) {
  return 1 + name.equivalent.size();
}

/// Which of the names hold what was hidden; each name is used once.
Naming naming_of(const Case& c, Outcome& out) {
  std::vector<bool> used(out.names.size(), false);
  std::size_t hits = 0;
  bool alone = true;
  for (const Ingredient& what : c.hidden) {
    for (std::size_t i = 0; i < out.names.size(); ++i) {
      if (used[i] || !holds(out.names[i], what.key)) continue;
      out.group_size = std::max(out.group_size, size_of(out.names[i]));
      if (size_of(out.names[i]) > kLargestGroup) continue;
      used[i] = true;
      alone &= size_of(out.names[i]) == 1;
      ++hits;
      break;
    }
  }
  if (out.names.empty()) return Naming::missed;
  if (hits == 0) return Naming::wrong;
  if (hits < c.hidden.size()) return Naming::partly;
  if (hits < out.names.size()) return Naming::beside;
  return alone ? Naming::alone : Naming::group;
}

bool is_right(const Outcome& out) {
  switch (out.tested.kind) {
    case Kind::single:
    case Kind::pair:
    case Kind::triple:
      return out.naming == Naming::alone || out.naming == Naming::group;
    case Kind::look_alike:
      return out.split;
    case Kind::nothing:
      return out.names.empty() && out.verdict == Verdict::sufficient;
    case Kind::base_law:
      return out.names.empty() && out.verdict == Verdict::sufficient && out.law == out.tested.law;
    case Kind::alien:
      return out.verdict == Verdict::unexplained && out.remaining == out.tested.variable;
    case Kind::unknowable:
      return out.names.empty() && (out.status == "untestable" || out.status == "equivalent");
  }
  return false;
}

Recovered recovered(const Ingredient& what, std::size_t k, const FitParameter& p) {
  const double unit = p.parameter.si;
  return {what.key,         p.parameter.name, what.values[k],    p.value / unit,
          p.lower95 / unit, p.upper95 / unit, p.std_error / unit};
}

void compare_parameters(const DiagnosedTraces& diagnosed, Outcome& out) {
  const Diagnosis& diagnosis = diagnosed.diagnosis;
  if (diagnosis.law == out.tested.law && !diagnosed.rungs.empty()) {
    const std::vector<double>& truth = out.tested.friction;
    for (const FitParameter& p : diagnosed.rungs.back().parameters) {
      if (!p.effect.empty() || out.of_law.size() >= truth.size()) break;
      const double unit = p.parameter.si;
      out.of_law.push_back({std::string(to_string(diagnosis.law)), p.parameter.name, truth[out.of_law.size()] / unit,
                            p.value / unit, p.lower95 / unit, p.upper95 / unit, p.std_error / unit});
    }
  }
  for (const Ingredient& what : out.tested.hidden) {
    const EffectFinding* found = finding(diagnosis, what.key);
    if (found == nullptr || found->status != EffectStatus::found) continue;
    for (const std::size_t k : what.main_parameters) {
      if (k >= found->parameters.size()) continue;
      const FitParameter& p = found->parameters[k];
      out.parameters.push_back(recovered(what, k, p));
    }
  }
}

/// What the fit makes of the parameters where law and effects are known. What is read off the motion is not fitted.
void compare_known(const Simulated& simulated, Outcome& out) {
  for (const Ingredient& what : out.tested.hidden) {
    if (is_kinematic(make_effect(what.key))) return;
  }
  const Fit fit = fit_known(simulated).fit;
  for (const Ingredient& what : out.tested.hidden) {
    std::vector<FitParameter> own;
    std::copy_if(fit.parameters.begin(), fit.parameters.end(), std::back_inserter(own),
                 [&](const FitParameter& p) { return p.effect == what.key; });
    for (const std::size_t k : what.main_parameters) {
      if (k < own.size()) out.known.push_back(recovered(what, k, own[k]));
    }
  }
}

/// What the true law leaves over the slips that the diagnosis saw, all traces together [1]: where nothing sticks
/// rigidly those are not all of the simulated ones.
double true_error(const Simulated& simulated, const DiagnosedTraces& diagnosed) {
  Fit truth;
  truth.model = simulated.model;
  if (!diagnosed.fits.empty()) {  // what its parameters refer to
    truth.mean_load = diagnosed.fits.front().mean_load;
    truth.mean_temperature = diagnosed.fits.front().mean_temperature;
  }
  for (const double value : simulated.truth) {
    truth.parameters.emplace_back();
    truth.parameters.back().value = value;
  }
  double squares = 0, counts = 0;
  for (const Identification& trace : diagnosed.traces) {
    const Fit frozen = evaluate_frozen(truth, trace.motion, trace.segmentation);
    for (const double s : frozen.cycle_squares) squares += s;
    for (const double n : frozen.cycle_counts) counts += n;
  }
  return counts > 0 ? std::sqrt(squares / counts) : simulated.floor_rmse;
}

/// Time this thread has had a processor [s]: not the waiting beside other cases.
double processor_time() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

std::string_view to_string(Naming naming) {
  constexpr std::string_view kNames[] = {"alone", "group", "beside", "partly", "wrong", "missed"};
  return kNames[static_cast<std::size_t>(naming)];
}

void judge(Outcome& out) {
  out.naming = naming_of(out.tested, out);
  out.right = is_right(out);
}

std::vector<Name> names_of(const Diagnosis& diagnosis) {
  std::vector<EffectInfo> kinematic_effects;
  for (const Effect& effect : effect_catalogue()) {
    if (is_kinematic(effect)) kinematic_effects.push_back(describe(effect));
  }
  std::vector<Name> names;
  for (const Rung& rung : diagnosis.ladder) {
    const bool counted_below = std::any_of(kinematic_effects.begin(), kinematic_effects.end(),
                                           [&](const EffectInfo& info) { return info.key == rung.added; });
    if (!rung.added.empty() && !counted_below) names.push_back({rung.added, rung.equivalent});
  }
  for (const EffectInfo& info : kinematic_effects) {
    const EffectFinding* found = finding(diagnosis, info.key);
    if (found == nullptr || found->status != EffectStatus::found) continue;
    Name name{info.key, {}};
    for (const EffectInfo& other : kinematic_effects) {
      const EffectFinding* twin = finding(diagnosis, other.key);
      const bool both_of_plateau =
          info.plateau_correction != PlateauCorrection::none && other.plateau_correction != PlateauCorrection::none;
      if (both_of_plateau && twin != nullptr && twin->status == EffectStatus::equivalent) {
        name.equivalent.push_back(other.key);
      }
    }
    names.push_back(std::move(name));
  }
  return names;
}

DiagnosedTraces diagnose_case(const Simulated& simulated) {
  std::vector<TraceInput> inputs;
  for (const auto& trace : simulated.traces) inputs.push_back({trace->path, {}, trace});
  IdentifyOptions options;
  options.threads = 1;
  options.instruments = simulated.instruments;
  return diagnose(inputs, options);
}

namespace {

/// Whether the hidden effect is named apart from its partners after the experiment, or, where it was measured by hand
/// and declared, none of them is named.
bool splits(const Case& c, const Experiment& experiment, Outcome& out) {
  const std::string& key = c.hidden.front().key;
  const auto in = [](const std::string& k) { return [&k](const Name& n) { return holds(n, k); }; };
  out.after = names_of(diagnose_case(simulate_case(c, experiment)).diagnosis);
  // A filter that a tap shows is not corrected: the records are to name it.
  const bool is_filter = describe(make_effect(key)).declared_by == InstrumentValue::force_bandwidth;
  const bool by_hand =
      !is_filter && std::find(experiment.measured.begin(), experiment.measured.end(), key) != experiment.measured.end();
  if (!by_hand && std::none_of(out.after.begin(), out.after.end(), in(key))) return false;
  return std::none_of(out.partners.begin(), out.partners.end(), [&](const std::string& partner) {
    return std::any_of(out.after.begin(), out.after.end(), in(partner));
  });
}

/// Does what the next experiment of the diagnosis says for the group that holds the hidden effect, and diagnoses again.
void try_experiment(const Case& c, Outcome& out) {
  const std::string& key = c.hidden.front().key;
  const auto group = std::find_if(out.names.begin(), out.names.end(),
                                  [&](const Name& name) { return holds(name, key) && !name.equivalent.empty(); });
  if (group == out.names.end()) return;
  Experiment experiment;
  for (const std::string& other : group->equivalent) {
    experiment += discriminating_runs(group->added, other);
    if (other != key) out.partners.push_back(other);
  }
  if (group->added != key) out.partners.push_back(group->added);
  if (!experiment.empty()) out.split = splits(c, experiment, out);
}

/// The experiment for a pair, whether or not the first record leaves it a group.
void try_pair(const Case& c, Outcome& out) {
  out.partners = {c.partner};
  out.split = splits(c, discriminating_runs(c.hidden.front().key, c.partner), out);
}

}  // namespace

Outcome run_case(const Case& c, const RunOptions& options) {
  Outcome out;
  out.tested = c;
  try {
    const Simulated simulated = simulate_case(c);
    if (options.known) compare_known(simulated, out);
    if (!options.diagnose) return out;
    const double begin = processor_time();
    const DiagnosedTraces diagnosed = diagnose_case(simulated);
    out.seconds = processor_time() - begin;
    const Diagnosis& diagnosis = diagnosed.diagnosis;
    out.names = names_of(diagnosis);
    out.verdict = diagnosis.verdict;
    out.law = diagnosis.law;
    if (!diagnosis.remaining.empty() && diagnosis.remaining.front().share > 0) {
      out.remaining = to_string(diagnosis.remaining.front().variable);
      out.remaining_share = diagnosis.remaining.front().share;
    }
    if (!c.hidden.empty()) {
      const EffectFinding* found = finding(diagnosis, c.hidden.front().key);
      if (found != nullptr) out.status = to_string(found->status);
    }
    out.experiment = diagnosis.next_experiment;
    if (!diagnosis.ladder.empty()) {
      out.first = diagnosis.ladder.front().held_out_rmse;
      out.last = diagnosis.ladder.back().held_out_rmse;
    }
    out.floor = true_error(simulated, diagnosed);
    judge(out);
    compare_parameters(diagnosed, out);
    if (options.experiments && c.kind == Kind::single && out.naming == Naming::group) try_experiment(c, out);
    if (options.experiments && c.kind == Kind::look_alike) {
      try_pair(c, out);
      out.right = is_right(out);
    }
  } catch (const std::exception& e) {
    out.failure = e.what();
  }
  return out;
}

std::vector<Outcome> run_cases(const std::vector<Case>& cases, int threads, const RunOptions& options,
                               const std::function<void(const Outcome&, std::size_t)>& done) {
  std::vector<Outcome> outcomes(cases.size());
  std::mutex mutex;
  std::size_t count = 0;
  run_tasks(cases.size(), threads, [&](std::size_t i) {
    outcomes[i] = run_case(cases[i], options);
    const std::lock_guard lock(mutex);
    if (done) done(outcomes[i], ++count);
  });
  return outcomes;
}

}  // namespace recovery
