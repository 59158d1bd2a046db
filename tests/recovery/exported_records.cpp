#include "exported_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "hidden_recipes.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/oscillator/simulate.hpp"

namespace recovery {

using namespace tribofit;

namespace {

ExportedRecord record_of(const Case& c) {
  Simulated simulated = simulate_case(c);
  ExportedRecord out;
  out.case_name = c.name;
  out.kind = c.programme == Programme::stick_slip ? "stick-slip" : "sliding";
  if (c.colour > 0) out.noise = fmt::format("AR(1) {:g}", c.colour);
  if (c.flicker) out.noise = "1/f";
  out.expected = c.kind == Kind::alien ? "unexplained" : c.hidden.empty() ? "silent" : "named";
  out.hidden = c.hidden;
  out.law = c.law;
  out.friction = c.friction;
  out.traces = std::move(simulated.traces);
  constexpr double kFlicker = 0.003;  // beside the noise that simulate_case() knows of
  out.floor_rmse = std::hypot(simulated.floor_rmse, c.flicker && simulated.floor_rmse > 0 ? kFlicker : 0.0);
  return out;
}

/// What is hidden in the kinds of record that a disc does not make.
struct Small {
  const char* name;
  std::string_view effect;     ///< key; empty: none
  std::vector<double> values;  ///< of its parameters, in their units
  bool alien = false;          ///< a hump over speed
};

FrictionModel model_of(const Small& small, const Law& law, std::vector<double>& p) {
  std::vector<Effect> effects;
  if (small.alien) effects.emplace_back(Formula("hump = a*exp(-((v-v0)/w)^2); a=0.03, v0=40, w=9"));
  if (!small.effect.empty()) effects.push_back(make_effect(std::string(small.effect)));
  FrictionModel model(law, std::move(effects));
  for (const auto& slot : model.parameters()) {
    if (slot.effect.empty()) continue;
    const std::size_t k = p.size() - model.base_count();
    p.push_back((small.alien ? slot.parameter.start : small.values.at(k)) * slot.parameter.si);
  }
  return model;
}

ExportedRecord empty_record(const Small& small, const char* kind, const Law& law, const std::vector<double>& p) {
  ExportedRecord out;
  out.case_name = fmt::format("{}/{}", kind, small.name);
  out.kind = kind;
  out.law = law;
  out.friction = {p.begin(), p.begin() + 3};
  out.expected = small.alien ? "unexplained" : small.effect.empty() ? "silent" : "named";
  if (!small.effect.empty()) out.hidden = {{std::string(small.effect), small.values.front(), small.values, {0}}};
  return out;
}

ExportedRecord points(const Small& small, std::uint64_t seed) {
  constexpr double kNoise = 0.003;
  Random random(hash(small.name, seed));
  const Law law = random.below(2) == 0 ? Law(ExponentialLaw{}) : Law(FractionalLaw{});
  std::vector<double> p = {random.uniform(0.45, 0.53), random.uniform(0.3, 0.36), random.uniform(40, 80)};
  const FrictionModel model = model_of(small, law, p);
  ExportedRecord out = empty_record(small, "points", law, p);
  out.floor_rmse = kNoise;
  out.traces = {std::make_shared<const Trace>(steady_points(model, p, kNoise, random))};
  return out;
}

/// A mass that a spring draws; its pull alone is recorded, by a converter with steps.
ExportedRecord spring_slider(const Small& small, std::uint64_t seed) {
  constexpr double kLoad = 0.301, kDrive = 1.1e-3, kStep = 0.301 / 4096;
  const Rig rig = {0.0307, 0, 168};
  Random random(hash(small.name, seed));
  std::vector<double> p = {random.uniform(0.40, 0.44), random.uniform(0.30, 0.34), random.uniform(120, 180)};
  const FrictionModel model = model_of(small, ExponentialLaw{}, p);
  ExportedRecord out = empty_record(small, "spring-slider", ExponentialLaw{}, p);
  Drive drive;
  drive.radius = 1;
  drive.mean_load = kLoad;
  drive.speed = constant_speed(kDrive);
  SimulationOptions options;
  options.duration = 20;
  options.rate = 2000;
  options.settle = settling_time(rig, drive, p);
  options.scatter = {0.003, 0};
  options.seed = hash(small.name, seed);
  const SimulatedMotion motion = simulate(rig, drive, model, p, options);
  Trace trace;
  trace.kind = RecordKind::spring_slider;
  trace.velocity_kind = VelocityKind::relative;
  trace.time = motion.time;
  for (const double x : motion.displacement) trace.friction.push_back(std::round(rig.stiffness * x / kStep) * kStep);
  trace.spring.velocity = {kDrive, "truth"};
  trace.spring.stiffness = {rig.stiffness, "truth"};
  trace.spring.mass = {rig.mass, "truth"};
  trace.conditions.load = {kLoad, "truth"};
  trace.steps = {{0, trace.size(), "", trace.conditions}};
  out.traces = {std::make_shared<const Trace>(std::move(trace))};
  return out;
}

const std::vector<Small>& small_points() {
  static const std::vector<Small> all = {
      {"nothing 1", {}, {}},          {"nothing 2", {}, {}},
      {"viscous", "viscous", {5e-4}}, {"asymmetry", "asymmetry", {1.15}},
      {"hump", {}, {}, true},         {"stribeck-exponent", "stribeck-exponent", {1.5}}};
  return all;
}

const std::vector<Small>& small_sliders() {
  static const std::vector<Small> all = {{"nothing 1", {}, {}},
                                         {"nothing 2", {}, {}},
                                         {"viscous", "viscous", {4e-3}},
                                         {"frictional-lag", "frictional-lag", {4}}};
  return all;
}

}  // namespace

std::vector<RecordMaker> plan_export(const ExportOptions& options) {
  PlanOptions plan;
  plan.runs = options.singles;
  plan.pairs = options.pairs;
  plan.nothing = options.nothing;
  plan.aliens = options.aliens;
  plan.unknowable = plan.look_alikes = 0;
  plan.largest_only = true;
  plan.seed = options.seed;
  std::vector<Case> cases = plan_cases(plan);
  std::vector<std::string> names = record_kinds();
  std::erase(names, "points");  // small_points() are exported
  const std::vector<Case> kinds =
      plan_record_kinds(names, options.of_each_kind, 2 * options.of_each_kind, options.seed + 1);
  cases.insert(cases.end(), kinds.begin(), kinds.end());
  if (!options.whole) cases = halved(std::move(cases));
  std::vector<std::pair<std::uint64_t, RecordMaker>> all;
  const auto add = [&](std::string_view name, RecordMaker make) {
    all.emplace_back(hash(name, options.seed + 2), std::move(make));
  };
  for (const Case& c : cases) add(c.name, [c] { return record_of(c); });
  for (const Small& small : small_points()) {
    add(fmt::format("points/{}", small.name), [&small, seed = options.seed] { return points(small, seed); });
  }
  for (const Small& small : small_sliders()) {
    add(fmt::format("slider/{}", small.name), [&small, seed = options.seed] { return spring_slider(small, seed); });
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<RecordMaker> out;
  for (auto& [place, make] : all) out.push_back(std::move(make));
  return out;
}

}  // namespace recovery
