#include "hidden_recipes.hpp"

#include <algorithm>
#include <stdexcept>

namespace recovery {

using namespace tribofit;

namespace {

/// Records in which the variable varies over which an effect is drawn.
std::vector<Setting> settings_for(SketchView view) {
  switch (view) {
    case SketchView::directions:
      return {Setting::both_directions};
    case SketchView::stick_time:
      return {Setting::four_speeds, Setting::pauses};
    case SketchView::time:
    case SketchView::distance:
    case SketchView::angle:
    case SketchView::ripple:
      return {Setting::slow};
    case SketchView::load:
    case SketchView::load_channel:
      return {Setting::load_swings};
    case SketchView::temperature:
      return {Setting::temperature_swings};
    default:
      return {Setting::fast};
  }
}

std::vector<Recipe> from_catalogue() {
  std::vector<Recipe> out;
  for (const Effect& effect : effect_catalogue()) {
    const EffectInfo info = describe(effect);
    // Stick-slip hardly shows what comes after a reversal: its slips are few there.
    const auto programme =
        info.sketch.view == SketchView::since_reversal ? Programme::reversals : Programme::stick_slip;
    for (const Setting setting : settings_for(info.sketch.view)) {
      out.push_back({info, hidden_cases(info.key), setting, programme});
    }
  }
  return out;
}

}  // namespace

const std::vector<Recipe>& recipes() {
  static const std::vector<Recipe> all = from_catalogue();
  return all;
}

const Recipe& recipe(std::string_view key) {
  const auto at =
      std::find_if(recipes().begin(), recipes().end(), [&](const Recipe& r) { return key == r.effect.key; });
  if (at == recipes().end()) throw std::invalid_argument("no effect is hidden as " + std::string(key));
  return *at;
}

Ingredient ingredient(const Recipe& recipe, double size, Random& random) {
  const EffectInfo& effect = recipe.effect;
  Ingredient out{effect.key, size, {recipe.hidden.either_sign ? random.sign() * size : size}, {0}};
  for (const ValueDraw& draw : recipe.hidden.others) {
    out.values.push_back(draw.choices.empty() ? random.uniform(draw.lower, draw.upper)
                                              : draw.choices[random.below(draw.choices.size())]);
  }
  for (std::size_t k = 1; k < effect.parameters.size(); ++k) {
    if (effect.parameters[k].decisive) out.main_parameters.push_back(k);
  }
  return out;
}

Ingredient ingredient(const Recipe& recipe, Random& random) {
  const std::vector<double>& sizes = recipe.hidden.sizes;
  return ingredient(recipe, sizes[random.below(sizes.size())], random);
}

std::uint64_t hash(std::string_view text, std::uint64_t seed) {
  std::uint64_t h = 0xcbf29ce484222325u ^ (seed * 0x9e3779b97f4a7c15u);
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return h;
}

std::optional<Programme> sliding_programme(const EffectInfo& effect) {
  // Effects that are found in the motion, before any fit, are found by how the block sticks.
  if (effect.kinematic_effect || effect.needs.plateau || !effect.excitation.break_away.empty()) return std::nullopt;
  switch (effect.sketch.view) {
    case SketchView::loop:
      return Programme::sines;
    case SketchView::curve:
      return Programme::steps;
    case SketchView::directions:
    case SketchView::since_reversal:
      return Programme::reversals;
    case SketchView::time:
    case SketchView::distance:
    case SketchView::angle:
    case SketchView::load:
    case SketchView::temperature:
    case SketchView::line:
      return Programme::ramps;
    default:  // in stick, at break-away, or over within a sample of a turn
      return std::nullopt;
  }
}

double growth_of(BoundScaling scaling, const RelativeScales& scales) {
  switch (scaling) {
    case BoundScaling::with_slip_time:
      return scales.slip_time;
    case BoundScaling::against_slip_time:
      return 1 / scales.slip_time;
    case BoundScaling::with_stick_time:
      return scales.stick_time;
    case BoundScaling::with_slip_length:
      return scales.slip_length;
    case BoundScaling::against_slip_length:
      return 1 / scales.slip_length;
    case BoundScaling::with_speed:
      return scales.top_speed;
    case BoundScaling::against_top_speed:
    case BoundScaling::against_speed:
      return 1 / scales.top_speed;
    case BoundScaling::with_duration:
      return scales.duration;
    case BoundScaling::against_duration:
      return 1 / scales.duration;
    case BoundScaling::with_distance:
      return scales.distance;
    case BoundScaling::with_stroke:
      return scales.stroke;
    case BoundScaling::with_mass:
      return scales.mass;
    case BoundScaling::never:
      break;
  }
  return 1;
}

const std::vector<Pair> kPairs = {
    {"frictional-lag", "runout", 1, 0.04, Setting::slow},
    {"viscous", "drift", 0.0011, 0.0012, Setting::slow},
    {"stribeck-exponent", "channel-delay", 1.4, 1, Setting::fast},
    {"sensor-inertia", "heating", 0.2, 0.1, Setting::slow},
    {"bristle", "interference", 60, 0.005, Setting::fast},
    {"rate-state", "runout", 90, 0.04, Setting::slow},
    {"viscous", "frictional-lag", 0.0015, 2, Setting::fast},
    {"force-bandwidth", "interference", 100, 0.012, Setting::fast},
    {"asymmetry", "sensor-offset", 1.15, 0.02, Setting::both_directions},
    {"load-dependence", "frictional-lag", 0.2, 1, Setting::load_swings},
    {"temperature-dependence", "viscous", 0.006, 0.0011, Setting::temperature_swings},
    {"radius-offset", "channel-delay", 1.05, 1, Setting::fast},
    {"velocity-highpass", "runout", 0.3, 0.04, Setting::slow},
    {"speed-ripple", "drift", 0.07, 0.0012, Setting::slow},
    {"step", "disc-pattern", 0.03, 0.04, Setting::slow},
    {"ringing", "runout", 0.014, 0.06, Setting::slow},
    {"run-in", "sensor-inertia", 0.08, 0.2, Setting::slow},
    {"drift", "runout", 0.0012, 0.04, Setting::slow},
};

const std::vector<Triple> kTriples = {
    {{"viscous", "frictional-lag", "runout"}, {0.0015, 2, 0.04}, Setting::slow},
    {{"sensor-inertia", "drift", "runout"}, {0.2, 0.0012, 0.06}, Setting::slow},
    {{"channel-delay", "viscous", "heating"}, {1, 0.0015, 0.1}, Setting::slow},
    {{"rate-state", "step", "disc-pattern"}, {90, 0.03, 0.04}, Setting::slow},
    {{"load-dependence", "channel-delay", "viscous"}, {0.2, 1, 0.0011}, Setting::load_swings},
    {{"temperature-dependence", "frictional-lag", "runout"}, {0.006, 1, 0.04}, Setting::temperature_swings},
};

}  // namespace recovery
