/// Which cases there are, and how they are simulated.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <random>
#include <tuple>

#include "../kinematics/stick_slip_truth.hpp"
#include "hidden_effects.hpp"
#include "hidden_recipes.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace recovery {

using namespace tribofit;

namespace {

constexpr double kRpm = 2 * std::numbers::pi / 60;
constexpr double kFrictionNoise = 0.003;
constexpr std::pair<double, double> kSlidingRecord = {60, 200};  // [s, Hz]

std::string number(double x) {
  return fmt::format("{:.9g}", x);
}

/// A formula whose parameters are the numbers in its text.
Effect alien(const Case& c, const Ingredient& what) {
  const std::vector<double>& p = what.values;
  if (what.key == "hump") {
    return Formula(
        fmt::format("hump = a*exp(-((v-v0)/w)^2); a={}, v0={}, w={}", number(p[0]), number(p[1]), number(p[2])));
  }
  const char* fall = c.law == Law(ExponentialLaw{}) ? "exp(-{}*v)" : "1/(1+{}*v)";
  const std::string level = fmt::format("({}+{}*{})", number(c.friction[1]), number(c.friction[0] - c.friction[1]),
                                        fmt::format(fmt::runtime(fall), number(c.friction[2] * 1e-3)));
  return Formula(fmt::format("swing = a*{}*cos({}*t+b); a={}, b={}", level, number(2 * std::numbers::pi / p[1]),
                             number(p[0]), number(p[2])));
}

/// Hump over velocity [1, mm/s, mm/s], or swing over time [1, s, rad] whose period is no part of a revolution.
Ingredient alien_ingredient(std::string_view key, Random& r) {
  if (key == "hump") return {"hump", 0, {r.uniform(0.015, 0.025), r.uniform(15, 35), r.uniform(4, 8)}, {}};
  constexpr std::pair<double, double> kPeriods[] = {{4.1, 4.7}, {5.4, 7.0}, {8.2, 9.0}};
  const auto [lower, upper] = kPeriods[r.below(3)];
  return {"swing", 0, {r.uniform(0.04, 0.08), r.uniform(lower, upper), r.phase()}, {}};
}

struct Model {
  FrictionModel model;
  std::vector<double> p;
};

/// The model with its parameters in its own order.
Model true_model(const Case& c) {
  std::vector<Effect> effects;
  std::vector<std::pair<std::string, std::vector<double>>> values;
  for (const Ingredient& what : c.hidden) {
    const bool known = what.key != "hump" && what.key != "swing";
    const Effect effect = known ? make_effect(what.key) : alien(c, what);
    const EffectInfo info = describe(effect);
    std::vector<double> si;
    for (std::size_t k = 0; k < info.parameters.size(); ++k) {
      si.push_back((known ? what.values[k] : info.parameters[k].start) * info.parameters[k].si);
    }
    values.emplace_back(info.key, std::move(si));
    effects.push_back(effect);
  }
  Model out{FrictionModel(c.law, std::move(effects)), c.friction};
  for (const std::string& key : out.model.effect_keys()) {
    const auto at = std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.first == key; });
    out.p.insert(out.p.end(), at->second.begin(), at->second.end());
  }
  return out;
}

/// Mean of sin(2 pi t/period + phase) over a record.
double mean_of_sine(double duration, double period, double phase) {
  const double turns = 2 * std::numbers::pi * duration / period;
  return (std::cos(phase) - std::cos(phase + turns)) / turns;
}

Drive drive_of(const Case& c, const Run& run, double duration, Random& random) {
  Drive drive;
  drive.radius = run.radius > 0 ? run.radius : c.radius;
  drive.mean_load = run.load * c.load;
  const double speed = run.speed * c.speed;
  drive.speed = constant_speed(speed);
  if (c.programme != Programme::stick_slip) drive.speed = sliding_speed(c.programme, speed, random);
  const bool back = run.setting == Setting::both_directions || run.setting == Setting::load_both_directions;
  if (back) drive.speed = reversing_speed(speed, random.uniform(0.1, 0.2));
  if (run.reversing > 0) drive.speed = reversing_speed(speed, run.reversing);
  if (!run.pauses.empty()) drive.speed = stepped_speed({0}, {speed}, run.pauses);
  if (run.setting == Setting::pauses) {
    std::vector<Pause> pauses;
    for (double t = random.uniform(1, 2); t < 55;) {
      const double length = 0.3 * std::pow(20.0, random.uniform(0, 1));
      pauses.push_back({t, length});
      t += length + random.uniform(1, 2);
    }
    drive.speed = stepped_speed({0}, {speed}, pauses);
  }
  if (run.setting == Setting::load_swings || run.setting == Setting::load_both_directions) {
    const double share = back ? 0.8 : random.uniform(0.4, 0.6), period = random.uniform(17, 26), phase = random.phase();
    drive.load = [=, middle = drive.mean_load](double t) {
      return middle * (1 + share * std::sin(2 * std::numbers::pi * t / period + phase));
    };
    // N0 and T0 are the means of the record: parameters refer to them.
    drive.mean_load *= (1 + share * mean_of_sine(duration, period, phase));
  }
  if (run.setting == Setting::temperature_swings) {
    const double swing = random.uniform(15, 20), period = random.uniform(17, 26), phase = random.phase();
    drive.mean_temperature = 40 + swing * mean_of_sine(duration, period, phase);
    drive.temperature = [=](double t) { return 40 + swing * std::sin(2 * std::numbers::pi * t / period + phase); };
  }
  return drive;
}

std::pair<double, double> duration_and_rate(Setting setting) {
  switch (setting) {
    case Setting::fast:
      return {12, 10000};
    case Setting::both_directions:
      return {24, 10000};
    case Setting::four_speeds:
      return {20, 5000};
    case Setting::pauses:
      return {60, 5000};
    case Setting::slow:
    case Setting::load_swings:
    case Setting::load_both_directions:
    case Setting::temperature_swings:
      break;
  }
  return {40, 5000};
}

/// Record number `number` of a case, from its own random numbers. reference_load: N0 of the case, which is the mean of
/// its first record: parameters refer to it in all. 0: this is the first.
SimulatedRecording hide_in(const Case& c, const Run& run, const Model& truth, std::size_t number,
                           double reference_load) {
  Random random((c.seed ^ 0x5bd1e995u) + number);
  const bool slides = c.programme != Programme::stick_slip;
  SimulationOptions options;
  std::tie(options.duration, options.rate) = duration_and_rate(run.setting);
  if (slides) std::tie(options.duration, options.rate) = kSlidingRecord;
  if (run.duration > 0) options.duration = run.duration;
  if (run.rate > 0) options.rate = run.rate;
  options.duration *= c.length;
  Drive drive = drive_of(c, run, options.duration, random);
  const double own_load = drive.mean_load;
  const bool is_constant = !drive.load;
  if (reference_load > 0 && own_load != reference_load) {
    if (is_constant) drive.load = [=](double) { return own_load; };
    drive.mean_load = reference_load;
  }
  Rig rig = c.rig;
  rig.stiffness *= run.stiffness;
  rig.damping *= std::sqrt(run.stiffness);
  rig.mass += run.more_mass;
  const bool back =
      run.setting == Setting::both_directions || run.setting == Setting::load_both_directions || run.reversing > 0;
  if (!back) options.settle = slides ? 0.2 : settling_time(rig, drive, truth.p);
  if (!slides) options.scatter = {c.scatter, c.wander};
  options.seed = c.seed + number;
  Sensors sensors;
  sensors.friction_noise = c.flicker ? 0 : c.noise * kFrictionNoise;
  sensors.velocity_noise = c.noise * 0.02e-3;
  sensors.noise_colour = c.colour;
  sensors.seed = (c.seed + number) ^ 0x2545f4914f6cdd1du;
  SimulatedRecording made = simulate_recording(truth.model, truth.p, rig, drive, options, sensors);
  made.recording.trace.conditions.load.value = own_load;
  if (is_constant) made.recording.trace.load.clear();
  return made;
}

}  // namespace

Case draw_case(std::string group, std::size_t number, Kind kind, Setting setting, std::uint64_t seed, Random& random) {
  Case c;
  c.name = fmt::format("{}:{}", group, number);
  c.kind = kind;
  c.setting = setting;
  c.seed = seed;
  const std::size_t cell = (5 * number + hash(group, 0) % 32) % 32;
  c.group = std::move(group);
  constexpr double kRadii[] = {0.009, 0.012, 0.015, 0.018};
  c.radius = kRadii[cell % 4];
  c.law = (cell / 4) % 2 == 0 ? Law(ExponentialLaw{}) : Law(FractionalLaw{});
  c.colour = (cell / 8) % 2 == 0 ? 0 : 0.9;
  c.wander = (cell / 16) % 2 == 0 ? 0 : 0.7;
  c.scatter = random.uniform(0.004, 0.02);
  c.rig = rig_with_damping_ratio(random.uniform(0.75, 0.95), 1e3 * random.uniform(11, 16), random.uniform(0.01, 0.04));
  c.friction[0] = random.uniform(0.49, 0.53);
  c.friction[1] = random.uniform(0.31, 0.39);
  c.friction[2] = 1e3 * (c.law == Law(ExponentialLaw{}) ? random.uniform(0.03, 0.06) : random.uniform(0.05, 0.11));
  c.speed = 4 * kRpm;
  c.load = 50;
  return c;
}

std::vector<Case> halved(std::vector<Case> cases) {
  for (Case& c : cases) {
    const bool slides = c.programme != Programme::stick_slip;
    if (c.setting == Setting::fast || c.setting == Setting::four_speeds || slides) c.length = 0.5;
  }
  return cases;
}

std::string_view to_string(Setting setting) {
  constexpr std::string_view kNames[] = {"fast",
                                         "slow",
                                         "both directions",
                                         "load swings",
                                         "temperature swings",
                                         "four speeds",
                                         "pauses",
                                         "load swings, both directions"};
  return kNames[static_cast<std::size_t>(setting)];
}

std::string_view to_string(Kind kind) {
  constexpr std::string_view kNames[] = {"single", "pair",       "triple",     "nothing",
                                         "alien",  "unknowable", "look-alike", "base law"};
  return kNames[static_cast<std::size_t>(kind)];
}

namespace {

/// Two and three effects in one record.
template <class Add>
void plan_together(const PlanOptions& options, const Add& add) {
  const auto hide = [](Case& c, Random& random, const char* key, double size) {
    c.hidden.push_back(ingredient(recipe(key), size, random));
  };
  for (const Pair& pair : kPairs) {
    add(fmt::format("{}+{}", pair.a, pair.b), options.pairs, Kind::pair, pair.setting, [&](Case& c, Random& random) {
      hide(c, random, pair.a, pair.size_a);
      hide(c, random, pair.b, pair.size_b);
    });
  }
  for (const Triple& triple : kTriples) {
    add(fmt::format("{}", fmt::join(triple.keys, "+")), options.triples, Kind::triple, triple.setting,
        [&](Case& c, Random& random) {
          for (std::size_t k = 0; k < std::size(triple.keys); ++k) hide(c, random, triple.keys[k], triple.sizes[k]);
        });
  }
}

}  // namespace

std::vector<Case> plan_cases(const PlanOptions& options) {
  std::vector<Case> cases;
  const auto add = [&](const std::string& group, std::size_t count, Kind kind, Setting setting,
                       const auto& add_effect) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t seed = hash(fmt::format("{}:{}", group, i), options.seed);
      Random random(seed);
      Case c = draw_case(group, i, kind, setting, seed, random);
      add_effect(c, random);
      cases.push_back(std::move(c));
    }
  };
  for (const Recipe& r : recipes()) {
    const char* suffix = r.setting == Setting::pauses ? "-pauses" : "";
    for (const double size : r.hidden.sizes) {
      if (options.largest_only && size != r.hidden.sizes.back()) continue;
      add(fmt::format("{}{}={:g}", r.effect.key, suffix, size), options.runs, Kind::single, r.setting,
          [&](Case& c, Random& random) {
            c.hidden = {ingredient(r, size, random)};
            if (r.programme != Programme::stick_slip) hide_in_sliding(c, r.programme);
          });
    }
  }
  plan_together(options, add);
  // Nothing is hidden in records of every kind, mostly the plain ones.
  constexpr Setting kSettings[] = {Setting::fast,        Setting::slow,
                                   Setting::fast,        Setting::slow,
                                   Setting::fast,        Setting::slow,
                                   Setting::load_swings, Setting::temperature_swings,
                                   Setting::pauses,      Setting::both_directions,
                                   Setting::pauses,      Setting::four_speeds};
  add("nothing", options.nothing, Kind::nothing, Setting::fast,
      [&](Case& c, Random& random) { c.setting = kSettings[random.below(std::size(kSettings))]; });
  for (const auto& [key, setting, variable] :
       {std::tuple("hump", Setting::fast, "velocity"), {"swing", Setting::slow, "time"}}) {
    add(key, options.aliens, Kind::alien, setting, [&, k = key, v = variable](Case& c, Random& random) {
      c.hidden = {alien_ingredient(k, random)};
      c.variable = v;
    });
  }
  add("ageing-at-one-speed", options.unknowable, Kind::unknowable, Setting::fast,
      [&](Case& c, Random& random) { c.hidden = {ingredient(recipe(Ageing::key), 0.012, random)}; });
  for (const auto& pair : look_alike_pairs()) {
    for (const auto& [key, partner] : {pair, {pair.second, pair.first}}) {
      const Recipe& r = recipe(key);
      add(fmt::format("{}~{}", key, partner), options.look_alikes, Kind::look_alike, r.setting,
          [&, &p = partner](Case& c, Random& random) {
            c.hidden = {ingredient(r, random)};
            if (r.programme != Programme::stick_slip) hide_in_sliding(c, r.programme);
            c.partner = p;
          });
    }
  }
  return cases;
}

namespace {

void add_flicker(Trace& trace, Random& random) {
  const std::vector<double> noise = flicker_noise(trace.size(), random);
  for (std::size_t i = 0; i < noise.size(); ++i) trace.friction[i] += kFrictionNoise * noise[i];
}

/// What the sensors do not know of: noise as 1/f; a block that is held still and not looked at; a slower rig.
void finish(const Case& c, const SimulatedMotion& motion, Trace& trace, std::uint64_t seed) {
  Random random(seed);
  if (c.flicker) add_flicker(trace, random);
  if (c.programme != Programme::stick_slip) {
    // A sample within the millisecond in which the spring turns round is not of the law.
    for (std::size_t i = 1; i < trace.size(); ++i) {
      const bool turns = motion.sticks[i] != 0 && !trace.disc_speed.empty() && trace.disc_speed[i] != 0;
      if (turns) trace.friction[i] = std::copysign(trace.friction[i - 1], trace.disc_speed[i]);
    }
    trace.velocity.clear();
    trace.velocity_kind = VelocityKind::fixed_block;
  }
  for (double& t : trace.time) t *= c.slowness;
  for (std::vector<double>* speeds : {&trace.velocity, &trace.disc_speed}) {
    for (double& v : *speeds) v /= c.slowness;
  }
  trace.conditions.speed.value /= c.slowness;
  for (Step& step : trace.steps) step.conditions.speed.value /= c.slowness;
}

}  // namespace

/// A record whose level of friction scatters from cycle to cycle.
Trace scattered_levels(const Case& c) {
  truth::Rig rig;
  rig.mass = c.rig.mass, rig.stiffness = c.rig.stiffness;
  rig.zeta = c.rig.damping / (2 * std::sqrt(c.rig.mass * c.rig.stiffness));
  rig.load = c.load, rig.radius = c.radius, rig.rpm = c.speed / kRpm;
  rig.static_friction = c.friction[0], rig.kinetic_friction = c.friction[1], rig.decay = c.friction[2];
  rig.fractional = c.law == Law(FractionalLaw{});
  std::tie(rig.duration, rig.rate) = duration_and_rate(c.setting);
  rig.duration *= c.length;
  rig.noise_correlation = c.colour;
  if (c.flicker) rig.friction_noise = 0;
  rig.level_scatter = c.level_scatter, rig.wander = c.wander;
  rig.seed = static_cast<unsigned>(c.seed);
  return truth::simulate(rig).trace;
}

/// A slow rig is simulated as that of [D], of which its record is an exact image.
Simulated simulate_case(const Case& c, const Experiment& more) {
  const Model truth = true_model(c);
  if (c.programme == Programme::points || c.level_scatter > 0) {
    const bool is_points = c.programme == Programme::points;
    Random random(c.seed ^ 0x94d049bb133111ebu);
    Trace trace =
        is_points ? steady_points(truth.model, truth.p, c.noise * kFrictionNoise, random) : scattered_levels(c);
    if (c.flicker && !is_points) add_flicker(trace, random);
    trace.path = c.name;
    return {truth.model, truth.p, {std::make_shared<const Trace>(std::move(trace))}, 0, {}};
  }
  const Case at_home = slowed(c, 1 / c.slowness);
  const Model simulated = true_model(at_home);
  std::vector<Run> runs = {{.setting = c.setting}};
  if (c.setting == Setting::four_speeds) {
    runs.clear();
    // As many cycles at each speed: a slow run takes longer.
    for (const double speed : {0.25, 0.5, 1.0, 2.0}) {
      runs.push_back({.setting = c.setting, .speed = speed, .duration = 20 / speed});
    }
  }
  runs.insert(runs.end(), more.runs.begin(), more.runs.end());
  double squares = 0, reference_load = 0;
  Simulated out{truth.model, truth.p, {}, 0, measured_by_hand(c, more.measured)};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    SimulatedRecording hidden = hide_in(at_home, runs[i], simulated, i, reference_load);
    if (i == 0) reference_load = hidden.motion.mean_load;
    finish(c, hidden.motion, hidden.recording.trace, (c.seed + i) ^ 0x94d049bb133111ebu);
    squares += hidden.floor_rmse * hidden.floor_rmse / static_cast<double>(runs.size());
    hidden.recording.trace.path = fmt::format("{}{}", c.name, runs.size() > 1 ? fmt::format("/{}", i) : "");
    out.traces.push_back(std::make_shared<const Trace>(std::move(hidden.recording.trace)));
  }
  out.floor_rmse = std::sqrt(squares);
  return out;
}

}  // namespace recovery
