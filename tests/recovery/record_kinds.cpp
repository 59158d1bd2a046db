/// Kinds of record beside those of [D]: sliding, slow and fast rigs, kinds of noise.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "hidden_effects.hpp"
#include "hidden_recipes.hpp"
#include "tribofit/friction/evaluate.hpp"

namespace recovery {

using namespace tribofit;

namespace {

constexpr double kPeriod = 4;         ///< of ramps, sines and reversals [s]
constexpr double kMeanSpeed = 0.045;  ///< of the block over the disc [m/s]
constexpr double kSwing = 8.0 / 9;    ///< of the mean speed

enum class Noise { any, white, coloured, flicker };

struct RecordKind {
  const char* name;
  Programme programme = Programme::stick_slip;
  double slowness = 1;
  Noise noise = Noise::any;
  bool level_scatters = false;
};

constexpr RecordKind kRecordKinds[] = {
    {.name = "stick-slip-white", .noise = Noise::white},
    {.name = "stick-slip-ar1", .noise = Noise::coloured},
    {.name = "stick-slip-flicker", .noise = Noise::flicker},
    {.name = "steps", .programme = Programme::steps},
    {.name = "ramps", .programme = Programme::ramps},
    {.name = "sines", .programme = Programme::sines},
    {.name = "reversals", .programme = Programme::reversals},
    {.name = "slow-1000", .slowness = 1000},
    {.name = "slow-30", .slowness = 30},
    {.name = "fast-0.05", .slowness = 0.05},
    {.name = "fast-0.01", .slowness = 0.01},
    {.name = "stick-slip-level", .level_scatters = true},
    {.name = "strokes", .programme = Programme::strokes},
    {.name = "constant-speed", .programme = Programme::constant},
    {.name = "points", .programme = Programme::points},
};

/// An eighth of a period is to sliding what a slip is to stick-slip.
RelativeScales sliding_scales() {
  const double slip_time = kPeriod / 8 * 30;
  return {.slip_time = slip_time,
          .slip_length = slip_time,
          .duration = 60.0 / 40,
          .distance = 60 * kMeanSpeed / 0.25,
          .stroke = 2 * kMeanSpeed * kPeriod / std::numbers::pi / 0.1};
}

/// A rig that follows every speed without stick-slip: critically damped, 25 nm under its load.
Rig stiff_rig() {
  return rig_with_damping_ratio(2, 1e9, 1);
}

void scale(Ingredient& what, const RelativeScales& scales) {
  const EffectInfo info = describe(make_effect(what.key));
  for (std::size_t k = 0; k < what.values.size(); ++k) {
    what.values[k] *= growth_of(info.parameters[k].bound_scaling, scales);
  }
}

/// The block slides under a stiff rig through all of the programme.
void let_slide(Case& c) {
  c.rig = stiff_rig();
  c.speed = kMeanSpeed / c.radius;
}

void set_noise(Case& c, Noise noise, std::size_t number) {
  constexpr Noise kTurn[] = {Noise::white, Noise::coloured, Noise::flicker};
  if (noise == Noise::any) noise = kTurn[number % 3];
  c.colour = noise == Noise::coloured ? 0.9 : 0;
  c.flicker = noise == Noise::flicker;
}

/// Case `number` of a kind; without an effect nothing is hidden in it.
Case make_case(const RecordKind& kind, const Recipe* recipe, std::size_t size, std::size_t number, std::uint64_t seed) {
  const std::string group = fmt::format("{}/{}", kind.name, recipe == nullptr ? "nothing" : recipe->effect.key);
  const std::uint64_t own = hash(fmt::format("{}:{}", group, number), seed);
  Random random(own);
  constexpr Setting kEmpty[] = {Setting::fast, Setting::slow, Setting::fast, Setting::slow, Setting::load_swings};
  const bool slides = kind.programme != Programme::stick_slip;
  Setting setting = recipe != nullptr ? recipe->setting : kEmpty[number % std::size(kEmpty)];
  if (slides && setting != Setting::load_swings && setting != Setting::temperature_swings) setting = Setting::fast;
  Case c = draw_case(group, number, recipe == nullptr ? Kind::nothing : Kind::single, setting, own, random);
  c.record_kind = kind.name;
  c.programme = kind.programme;
  set_noise(c, kind.noise, number);
  if (slides) let_slide(c);
  if (kind.level_scatters) {
    constexpr double kWander[] = {0, 0.7, 0.95};
    c.setting = Setting::fast;
    c.level_scatter = random.uniform(0, 0.03);
    c.wander = kWander[number / 3 % 3];
  }
  if (recipe != nullptr) {
    const std::vector<double>& sizes = recipe->hidden.sizes;
    c.hidden = {ingredient(*recipe, sizes[size % sizes.size()], random)};
    if (slides) scale(c.hidden[0], sliding_scales());
  }
  return slowed(std::move(c), kind.slowness);
}

/// What is asked of sliding.
struct Asked {
  const char* name;
  std::optional<Law> law;                  ///< none: one of those drawn for every case
  std::optional<std::string_view> effect;  ///< none: the law itself is asked for
};

const std::vector<Asked>& asked_of_sliding() {
  static const std::vector<Asked> all = {{"viscous", CoulombLaw{}, Viscous::key},
                                         {"drift", {}, Drift::key},
                                         {"asymmetry", {}, Asymmetry::key},
                                         {"logarithmic", LogarithmicLaw{}, {}},
                                         {"exponential + viscous", ExponentialLaw{}, Viscous::key},
                                         {"gaussian + viscous", GaussianLaw{}, Viscous::key}};
  return all;
}

Case make_asked(const RecordKind& kind, const Asked& asked, std::size_t number, std::uint64_t seed) {
  const std::string group = fmt::format("{}/{}", kind.name, asked.name);
  const std::uint64_t own = hash(fmt::format("{}:{}", group, number), seed);
  Random random(own);
  Case c = draw_case(group, number, asked.effect ? Kind::single : Kind::base_law, Setting::fast, own, random);
  c.record_kind = kind.name;
  c.programme = kind.programme;
  set_noise(c, kind.noise, number);
  let_slide(c);
  if (asked.law) c.law = *asked.law;
  if (c.law == Law(CoulombLaw{})) c.friction.resize(2);
  if (c.law == Law(LogarithmicLaw{})) {
    c.friction = {random.uniform(0.35, 0.45), random.sign() * random.uniform(0.01, 0.02)};
  }
  if (asked.effect) {
    c.hidden = {ingredient(recipe(*asked.effect), random)};
    scale(c.hidden[0], sliding_scales());
  }
  return c;
}

const RecordKind& kind_called(const std::string& name) {
  const auto at = std::find_if(std::begin(kRecordKinds), std::end(kRecordKinds),
                               [&](const RecordKind& kind) { return kind.name == name; });
  if (at == std::end(kRecordKinds)) throw std::invalid_argument(fmt::format("there is no kind of record '{}'", name));
  return *at;
}

}  // namespace

SpeedProfile sliding_speed(Programme programme, double mean, Random& random) {
  const double period = kPeriod * random.uniform(0.8, 1.2);
  if (programme == Programme::constant) return constant_speed(mean * 2 * std::pow(10, -random.uniform(0, 1)));
  if (programme == Programme::reversals) return reversing_speed(2 * mean, 1 / period);
  if (programme == Programme::sines) {
    const double w = 2 * std::numbers::pi / period;
    SpeedProfile out;
    out.speed = [=](double t) { return mean * (1 + kSwing * std::sin(w * t)); };
    out.acceleration = [=](double t) { return mean * kSwing * w * std::cos(w * t); };
    out.angle = [=](double t) { return mean * (t + kSwing * (1 - std::cos(w * t)) / w); };
    return out;
  }
  std::vector<double> times, speeds;
  if (programme == Programme::strokes) {
    std::vector<Pause> dwells;
    for (double t = 0; t < 65; t += period) {
      times.push_back(t);
      speeds.push_back((times.size() % 2 == 0 ? -2 : 2) * mean * std::pow(9, -random.uniform(0, 1)));
      dwells.push_back({t + (0.6 + 0.2 * random.uniform(0, 1)) * period, 0.15 * period});
    }
    return stepped_speed(std::move(times), std::move(speeds), dwells);
  }
  if (programme == Programme::ramps) {
    for (double t = 0; t < 65; t += period / 2) {
      times.push_back(t);
      speeds.push_back(mean * (1 + (times.size() % 2 == 0 ? kSwing : -kSwing)));
    }
    return piecewise_linear_speed(std::move(times), std::move(speeds));
  }
  for (int k = 0; k < 12; ++k) {
    times.push_back(5.0 * k);
    speeds.push_back(mean / 30 * std::pow(60.0, (k + random.uniform(0, 1)) / 12));
  }
  for (std::size_t k = 12; k > 1; --k) std::swap(speeds[k - 1], speeds[random.below(k)]);
  return stepped_speed(std::move(times), std::move(speeds));
}

void hide_in_sliding(Case& c, Programme programme) {
  c.programme = programme;
  let_slide(c);
  for (Ingredient& what : c.hidden) scale(what, sliding_scales());
}

Case slowed(Case c, double slowness) {
  if (slowness == 1) return c;
  const RelativeScales scales = {.slip_time = slowness,
                                 .stick_time = slowness,
                                 .top_speed = 1 / slowness,
                                 .duration = slowness,
                                 .mass = slowness * slowness};
  for (Ingredient& what : c.hidden) scale(what, scales);
  c.friction[2] *= slowness;
  c.rig.mass *= slowness * slowness;
  c.rig.damping *= slowness;
  c.speed /= slowness;
  c.slowness *= slowness;
  return c;
}

Trace steady_points(const FrictionModel& model, const std::vector<double>& p, double noise, Random& random) {
  constexpr std::size_t kSpeeds = 60;
  constexpr double kSlowest = 0.5e-3, kFastest = 0.2;
  Trace trace;
  trace.kind = tribofit::RecordKind::points;
  trace.velocity_kind = VelocityKind::relative;
  for (const double sign : {1.0, -1.0}) {
    for (std::size_t k = 0; k < kSpeeds; ++k) {
      const double v = sign * kSlowest * std::pow(kFastest / kSlowest, static_cast<double>(k) / (kSpeeds - 1.0));
      const double time[] = {-1, 0}, speed[] = {v, v};
      double mu[2];
      Slip slip;
      slip.time = time;
      slip.velocity = speed;
      slip.direction = sign;
      evaluate<double>(model, p.data(), slip, slip.velocity, mu);
      trace.time.push_back(static_cast<double>(trace.time.size()));
      trace.velocity.push_back(v);
      trace.friction.push_back(mu[1] + noise * random.normal());
    }
  }
  trace.steps = {{0, trace.size(), "", {}}};
  return trace;
}

/// Sum of first-order processes of equal deviation whose times double from one to the next.
std::vector<double> flicker_noise(std::size_t size, Random& random) {
  std::vector<double> out(size, 0.0);
  int octaves = 0;
  for (double steps = 1; steps < 2 * static_cast<double>(size); steps *= 2) ++octaves;
  double steps = 0.5;
  for (int k = 0; k < octaves; ++k, steps *= 2) {
    const double keep = std::exp(-1 / steps), add = std::sqrt(1 - keep * keep) / std::sqrt(octaves);
    double x = random.normal() / std::sqrt(octaves);
    for (double& value : out) {
      x = keep * x + add * random.normal();
      value += x;
    }
  }
  return out;
}

std::vector<std::string> record_kinds() {
  std::vector<std::string> names;
  for (const RecordKind& kind : kRecordKinds) names.emplace_back(kind.name);
  return names;
}

std::vector<Case> plan_record_kinds(const std::vector<std::string>& kinds, std::size_t empty, std::size_t loaded,
                                    std::uint64_t seed) {
  for (const std::string& name : kinds) kind_called(name);
  std::vector<Case> cases;
  for (const RecordKind& kind : kRecordKinds) {
    if (!kinds.empty() && std::find(kinds.begin(), kinds.end(), kind.name) == kinds.end()) continue;
    for (std::size_t i = 0; i < empty; ++i) cases.push_back(make_case(kind, nullptr, 0, i, seed));
    std::vector<const Recipe*> shown;
    for (const Recipe& r : recipes()) {
      const auto programme = sliding_programme(r.effect);
      if (kind.programme == Programme::stick_slip || programme == kind.programme) shown.push_back(&r);
    }
    for (std::size_t i = 0; i < loaded && !shown.empty() && !kind.level_scatters; ++i) {
      cases.push_back(make_case(kind, shown[i % shown.size()], i + i / shown.size(), i, seed));
    }
  }
  return cases;
}

std::vector<Case> plan_asked_of_sliding(const std::vector<std::string>& kinds, std::size_t records,
                                        std::uint64_t seed) {
  std::vector<Case> cases;
  for (const RecordKind& kind : kRecordKinds) {
    const bool slides = kind.programme != Programme::stick_slip;
    if (kinds.empty() ? !slides : std::find(kinds.begin(), kinds.end(), kind.name) == kinds.end()) continue;
    if (!slides) throw std::invalid_argument(fmt::format("a block sticks in records of the kind '{}'", kind.name));
    std::vector<const Asked*> shown;
    for (const Asked& asked : asked_of_sliding()) {
      const bool both_ways = asked.effect && recipe(*asked.effect).effect.excitation.both_directions;
      if (!both_ways || kind.programme == Programme::reversals) shown.push_back(&asked);
    }
    for (std::size_t i = 0; i < records; ++i) {
      cases.push_back(make_asked(kind, *shown[i % shown.size()], i / shown.size(), seed));
    }
  }
  for (const std::string& name : kinds) kind_called(name);
  return cases;
}

}  // namespace recovery
