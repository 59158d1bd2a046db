/// The experiments that tell two effects apart, as they are simulated.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "hidden_effects.hpp"
#include "tribofit/friction/effects/all.hpp"

namespace recovery {

using namespace tribofit;

namespace {

struct Test {
  std::string_view a, b;
  Experiment experiment;
};

const std::vector<Test>& tests() {
  const std::vector<Run> other_speeds = {{.speed = 0.25}, {.speed = 0.5}, {.speed = 2}};
  const std::vector<Run> slower = {{.speed = 0.5}};
  const std::vector<Run> fast_on_fresh = {{.setting = Setting::slow, .speed = 4, .duration = 30}};
  const std::vector<Run> slow_and_long = {{.setting = Setting::slow, .speed = 0.25, .duration = 400, .rate = 2000}};
  const std::vector<Run> stiffer = {{.duration = 6, .stiffness = 4}};
  const std::vector<Run> two_radii = {{.speed = 2, .radius = 0.009}, {.speed = 1, .radius = 0.018}};
  const std::vector<Run> other_strokes = {{.setting = Setting::both_directions, .speed = 0.5}};
  const std::vector<Run> more_turns = {{.setting = Setting::slow, .duration = 60}};
  static const std::vector<Test> all = {
      {"asymmetry", "sensor-offset", {{}, {"sensor-offset"}}},
      {"frictional-lag", "channel-delay", {{}, {"channel-delay"}}},
      {"frictional-lag", "force-bandwidth", {stiffer, {"force-bandwidth"}}},
      {"channel-delay", "force-bandwidth", {{}, {"channel-delay"}}},
      {"frictional-lag", "sensor-inertia", {stiffer, {}}},
      {"channel-delay", "sensor-inertia", {{}, {"channel-delay"}}},
      {"force-bandwidth", "sensor-inertia", {stiffer, {}}},
      {"rate-state", "sensor-inertia", {stiffer, {}}},
      {"frictional-lag", "rate-state", {other_speeds, {}}},
      {"rate-state", "channel-delay", {{}, {"channel-delay"}}},
      {"rate-state", "force-bandwidth", {stiffer, {"force-bandwidth"}}},
      {"rate-state", "bristle", {slower, {}}},
      {"bristle", "velocity-highpass", {slower, {}}},
      {"bristle", "radius-offset", {slower, {}}},
      {"velocity-highpass", "radius-offset", {slower, {}}},
      {"bristle", "contact-spin", {two_radii, {}}},
      {"radius-offset", "velocity-gain", {{}, {"velocity-gain"}}},
      {"speed-ripple", "runout", {more_turns, {}}},
      {"heating", "run-in", {fast_on_fresh, {}}},
      {"heating", "drift", {slow_and_long, {}}},
      {"run-in", "drift", {slow_and_long, {}}},
      {"runout", "drift", {more_turns, {}}},
      {"viscous", "stribeck-exponent", {{{.speed = 4}}, {}}},
      {"ageing", "rate-state", {{{.setting = Setting::pauses}}, {}}},
      {"hysteresis", "frictional-lag", {other_strokes, {}}},
      {"hysteresis", "rate-state", {other_strokes, {}}},
      {"hysteresis", "bristle", {other_strokes, {}}},
      {"hysteresis", "asymmetry", {other_strokes, {}}},
      {"backlash", "hysteresis", {other_strokes, {}}},
      {"backlash", "asymmetry", {other_strokes, {}}},
      {"load-dependence", "crosstalk", {{{.setting = Setting::load_both_directions}}, {}}},
  };
  return all;
}

/// A reading with the standard uncertainty that goes with it.
Declared reading(double truth, double uncertainty, std::mt19937_64& engine) {
  double sum = -6;  // of twelve uniform numbers: normal within what is read here, the same with every library
  for (int k = 0; k < 12; ++k) sum += static_cast<double>(engine() >> 11) * 0x1p-53;
  return {truth + uncertainty * sum, uncertainty};
}

}  // namespace

Experiment discriminating_runs(std::string_view a, std::string_view b) {
  for (const Test& test : tests()) {
    if ((test.a == a && test.b == b) || (test.a == b && test.b == a)) return test.experiment;
  }
  return {};
}

std::vector<std::pair<std::string, std::string>> look_alike_pairs() {
  std::vector<std::pair<std::string, std::string>> out;
  for (const Test& test : tests()) out.emplace_back(test.a, test.b);
  return out;
}

Experiment& operator+=(Experiment& all, const Experiment& more) {
  for (const Run& run : more.runs) {
    if (std::find(all.runs.begin(), all.runs.end(), run) == all.runs.end()) all.runs.push_back(run);
  }
  for (const std::string& key : more.measured) {
    if (std::find(all.measured.begin(), all.measured.end(), key) == all.measured.end()) all.measured.push_back(key);
  }
  return all;
}

Instruments measured_by_hand(const Case& c, const std::vector<std::string>& keys) {
  Instruments out;
  std::mt19937_64 engine(c.seed ^ 0x9e3779b97f4a7c15u);
  for (const std::string& key : keys) {
    const auto at = std::find_if(c.hidden.begin(), c.hidden.end(), [&](const auto& what) { return what.key == key; });
    const auto size = [&](double neutral) { return at != c.hidden.end() ? at->values[0] : neutral; };
    const EffectInfo effect = describe(make_effect(key));
    switch (effect.declared_by) {
      case InstrumentValue::force_zero:
        out.force_sensor.zero = reading(size(0), 0.0005, engine);
        break;
      case InstrumentValue::force_mass_below:
        out.force_sensor.mass_below = reading(size(0), 0.005, engine);
        break;
      case InstrumentValue::force_bandwidth:
        // Where the edge of a tap is slower than the samples, that is known and nothing is declared.
        if (at == c.hidden.end()) out.force_sensor.bandwidth = Declared{20000, 2000};
        break;
      case InstrumentValue::vibrometer_delay:
        // Friction that comes late is velocity that comes early.
        out.vibrometer.delay = reading(-1e-3 * size(0), 0.02e-3, engine);
        break;
      default:
        if (effect.plateau_correction == PlateauCorrection::gain) out.vibrometer.gain = reading(size(1), 0.002, engine);
    }
  }
  return out;
}

}  // namespace recovery
