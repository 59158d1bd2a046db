#include "investigations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <exception>
#include <memory>
#include <optional>

#include "hidden_recipes.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/pipeline.hpp"

namespace recovery {

using namespace tribofit;

namespace {

constexpr double kLength = 0.5, kNoise = 2;

/// What a lab of the rig of [D] can do.
Means usual_lab(const Case& c) {
  Means means;
  for (const double rpm : {1.0, 2.0, 4.0, 8.0}) means.speeds.push_back(rpm * kRpm);
  means.radii = {0.009, 0.018};
  means.loads = {0.5 * c.load, 2 * c.load};
  means.springs = {4 * c.rig.stiffness};
  means.longest_pause = 6;
  means.reversing = true;
  means.tap = means.lift = true;
  means.longest = 120;
  return means;
}

std::string text_of(const std::vector<Name>& names) {
  std::string text;
  for (const Name& name : names) {
    text += (text.empty() ? "" : ", ") + name.added;
    for (const std::string& other : name.equivalent) text += "|" + other;
  }
  return text.empty() ? "nothing" : text;
}

std::string key_of(const Case& c) {
  return c.hidden.front().key;
}

bool holds_truth(const Case& c, const Name& name) {
  return name.added == key_of(c) ||
         std::find(name.equivalent.begin(), name.equivalent.end(), key_of(c)) != name.equivalent.end();
}

bool is_alone(const Case& c, const std::vector<Name>& names) {
  return names.size() == 1 && names[0].equivalent.empty() && names[0].added == key_of(c);
}

bool is_wrong(const Case& c, const std::vector<Name>& names) {
  return !names.empty() && std::none_of(names.begin(), names.end(), [&](const Name& n) { return holds_truth(c, n); });
}

double corner_of_tap(double rate) {
  return rate / 4;
}

/// What a measurement by hand shows of the truth: nothing, a value that is declared and corrected, or a filter, which
/// it names.
enum class ByHand { nothing, correction, filter };

/// What is read by hand of an instrument.
Instruments read_by_hand(const Case& c, InstrumentValue value) {
  std::vector<std::string> keys;
  for (const Effect& other : effect_catalogue()) {
    const EffectInfo info = describe(other);
    if (info.declared_by == value) keys.push_back(info.key);
  }
  return measured_by_hand(c, keys);
}

/// With the zero of the force sensor for the instruments file.
ByHand lift(const Case& c, Instruments& instruments) {
  const Ingredient& what = c.hidden.front();
  const Declared zero = read_by_hand(c, InstrumentValue::force_zero).force_sensor.zero.value();
  instruments.force_sensor.zero = zero;
  const bool is_zero = describe(make_effect(what.key)).declared_by == InstrumentValue::force_zero;
  return is_zero && std::abs(what.values[0]) > 3 * zero.uncertainty ? ByHand::correction : ByHand::nothing;
}

/// With delay and least bandwidth for the instruments file.
ByHand tap(const Case& c, double rate, Instruments& instruments) {
  const Ingredient& what = c.hidden.front();
  const EffectInfo effect = describe(make_effect(what.key));
  const Instruments read = read_by_hand(c, InstrumentValue::vibrometer_delay);
  if (read.vibrometer.delay) {
    instruments.vibrometer.delay = read.vibrometer.delay;
    instruments.vibrometer.delay->uncertainty = std::hypot(0.02e-3, 0.3 / rate);
  }
  const bool is_filter = effect.declared_by == InstrumentValue::force_bandwidth;
  if (is_filter && what.values[0] < corner_of_tap(rate)) return ByHand::filter;
  instruments.force_sensor.bandwidth_at_least = Declared{corner_of_tap(rate), 0};
  const bool is_delay = effect.declared_by == InstrumentValue::vibrometer_delay &&
                        std::abs(what.values[0]) * 1e-3 > 3 * instruments.vibrometer.delay->uncertainty;
  return is_delay ? ByHand::correction : ByHand::nothing;
}

/// An investigation as it goes on.
struct Bench {
  const Case& c;
  recovery::Experiment made;  ///< so far
  Instruments instruments;
  ByHand shown = ByHand::nothing;

  DiagnosedTraces diagnose() const {
    Simulated simulated = simulate_case(c, made);
    simulated.instruments = instruments;
    return diagnose_case(simulated);
  }

  void make(const tribofit::Experiment& experiment, const RunConditions& own) {
    if (experiment.tap > 0) shown = std::max(shown, tap(c, experiment.tap, instruments));
    if (experiment.lift) shown = std::max(shown, lift(c, instruments));
    for (const RunConditions& run : experiment.runs) {
      made.runs.push_back({.setting = Setting::fast,
                           .speed = run.speed / c.speed,
                           .radius = run.radius,
                           .duration = run.duration / c.length,
                           .rate = run.rate,
                           .stiffness = std::abs(run.stiffness - own.stiffness) < 1e-6 * own.stiffness
                                            ? 1
                                            : run.stiffness / c.rig.stiffness,
                           .load = run.load / c.load,
                           .more_mass = run.mass_below,
                           .reversing = run.reversing,
                           .pauses = run.pauses});
    }
  }
};

std::string what_of(const tribofit::Experiment& experiment, const RunConditions& own) {
  if (experiment.tap > 0) return "tap";
  if (experiment.lift) return "lift";
  std::string text;
  for (const RunConditions& run : experiment.runs) {
    text += fmt::format("{}{:.3g} rpm", text.empty() ? "" : " + ", run.speed / kRpm);
    if (run.radius != own.radius) text += fmt::format(" {:.3g} mm", 1e3 * run.radius);
    if (std::abs(run.load - own.load) > 1e-9 * own.load) text += fmt::format(" {:.3g} N", run.load);
    if (std::abs(run.stiffness - own.stiffness) > 1e-9 * own.stiffness) text += " other spring";
    if (!run.pauses.empty()) text += " pauses";
    if (run.reversing > 0) text += " reversing";
    text += fmt::format(" {:.0f} s", run.duration);
  }
  return text;
}

FurtherRun further_run(Bench& bench, const PlannedExperiment& one, const RunConditions& own,
                       DiagnosedTraces& diagnosed) {
  FurtherRun out{what_of(one.experiment, own), one.probability, one.expected, one.minutes(), false, false, {}};
  bench.make(one.experiment, own);
  diagnosed = bench.diagnose();
  const std::vector<Name> names = names_of(diagnosed.diagnosis);
  // A filter is seen in the edge. A delay that is declared is corrected: nothing is left of it.
  const bool rivals_left =
      std::any_of(names.begin(), names.end(), [&](const Name& n) { return n.added != key_of(bench.c); });
  out.alone =
      bench.shown == ByHand::filter || is_alone(bench.c, names) || (bench.shown == ByHand::correction && !rivals_left);
  out.wrong = bench.shown != ByHand::filter && rivals_left && is_wrong(bench.c, names);
  out.names = text_of(names);
  return out;
}

double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

RunPlan plan_for(const Bench& bench, const DiagnosedTraces& diagnosed, const InvestigationOptions& options,
                 std::uint64_t seed) {
  tribofit::PlanOptions plan;
  plan.means = usual_lab(bench.c);
  if (bench.instruments.vibrometer.delay) plan.means.tap = false;
  if (bench.instruments.force_sensor.zero) plan.means.lift = false;
  plan.threads = 1;
  plan.seed = seed;
  plan.effort = options.effort;
  plan.instruments = bench.instruments;
  return plan_runs(diagnosed, plan);
}

bool leaves_open(const Case& c, const RunPlan& plan) {
  return plan.answered() && plan.models.size() > 1 &&
         std::any_of(plan.models.begin(), plan.models.end(),
                     [&](const ModelInQuestion& m) { return m.name.substr(0, m.name.find(':')) == key_of(c); });
}

void investigate_by_chance(const Case& c, const RunPlan& first, const InvestigationOptions& options,
                           Investigation& out) {
  Bench bench{c, {}, {}};
  Random random(c.seed ^ 0xabcdefu);
  DiagnosedTraces diagnosed;
  while (out.random.size() < options.most_random) {
    const PlannedExperiment& one = first.experiments[random.below(first.experiments.size())];
    out.random.push_back(further_run(bench, one, first.own, diagnosed));
    if (out.random.back().alone) return;
  }
}

/// Most runs of a plan are thought to settle nothing or all of it: what is stated between is tried here.
void try_the_uncertain(const Case& c, const RunPlan& first, const InvestigationOptions& options, Investigation& out) {
  std::vector<const PlannedExperiment*> uncertain;
  for (const PlannedExperiment& one : first.experiments) {
    if (one.reason.empty() && one.probability >= 0.1 && one.probability < 0.9) uncertain.push_back(&one);
  }
  Random random(c.seed ^ 0x517cc1u);
  while (!uncertain.empty() && out.tried.size() < options.most_tried_alone) {
    const auto chosen = uncertain.begin() + static_cast<std::ptrdiff_t>(random.below(uncertain.size()));
    Bench bench{c, {}, {}};
    DiagnosedTraces diagnosed;
    out.tried.push_back(further_run(bench, **chosen, first.own, diagnosed));
    uncertain.erase(chosen);
  }
}

}  // namespace

std::size_t Investigation::runs_until_alone(const std::vector<FurtherRun>& runs) {
  return !runs.empty() && runs.back().alone ? runs.size() : 0;
}

std::vector<Case> investigated_cases(std::size_t count, std::uint64_t seed) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const auto& [a, b] : look_alike_pairs()) {
    const bool plain = !is_kinematic(make_effect(a)) && !is_kinematic(make_effect(b)) &&
                       recipe(a).programme == Programme::stick_slip && recipe(b).programme == Programme::stick_slip;
    if (!plain) continue;
    pairs.emplace_back(a, b);
    pairs.emplace_back(b, a);
  }
  std::vector<Case> cases;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [key, partner] = pairs[i % pairs.size()];
    const Recipe& r = recipe(key);
    const std::string name = fmt::format("investigation:{}~{}:{}", key, partner, i / pairs.size());
    const std::uint64_t own = hash(name, seed);
    Random random(own);
    Case c = draw_case(name, i, Kind::look_alike, r.setting == Setting::four_speeds ? Setting::fast : r.setting, own,
                       random);
    c.hidden = {ingredient(r, random)};
    c.partner = partner;
    c.length = kLength * random.uniform(0.4, 1);
    c.noise = kNoise * random.uniform(0.5, 2);
    cases.push_back(std::move(c));
  }
  return cases;
}

Investigation investigate(const Case& c, const InvestigationOptions& options) {
  Investigation out;
  out.tested = c;
  try {
    Bench bench{c, {}, {}};
    DiagnosedTraces diagnosed = bench.diagnose();
    const std::vector<Name> names = names_of(diagnosed.diagnosis);
    out.first = text_of(names);
    const bool possible =
        std::any_of(diagnosed.diagnosis.effects.begin(), diagnosed.diagnosis.effects.end(),
                    [&](const EffectFinding& f) { return f.status == EffectStatus::possible && f.key == key_of(c); });
    const bool grouped = std::any_of(names.begin(), names.end(),
                                     [&](const Name& n) { return holds_truth(c, n) && !n.equivalent.empty(); });
    if (!possible && !grouped) return out;
    std::optional<RunPlan> first;
    while (out.planned.size() < options.most_runs) {
      const double begin = processor_seconds();
      const RunPlan plan = plan_for(bench, diagnosed, options, c.seed + out.planned.size());
      if (!first) {
        out.seconds = processor_seconds() - begin;
        out.open = leaves_open(c, plan);
        if (!out.open) return out;
        for (const ModelInQuestion& m : plan.models)
          out.answers.emplace_back(m.probability, m.name.substr(0, m.name.find(':')) == key_of(c));
        first = plan;
      }
      if (!plan.answered() || plan.experiments.empty() || plan.hopeless) {
        out.hopeless = true;
        break;
      }
      out.planned.push_back(further_run(bench, plan.experiments.front(), plan.own, diagnosed));
      if (out.planned.back().alone) break;
    }
    if (options.most_random > 0 && !first->hopeless) investigate_by_chance(c, *first, options, out);
    try_the_uncertain(c, *first, options, out);
  } catch (const std::exception& e) {
    out.failure = e.what();
  }
  return out;
}

}  // namespace recovery
