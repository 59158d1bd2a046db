#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "console.hpp"
#include "settings.hpp"
#include "simulated.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/record_kind.hpp"
#include "tribofit/oscillator/velocity_steps.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/version.hpp"

using Json = nlohmann::ordered_json;

namespace tribofit {
namespace {

constexpr double kMicro = 1e-6;

RateStateMachine machine_of(const SimulateRequest& r, double first_speed) {
  const auto value = [&](const char* name, double otherwise) {
    const auto typed = r.rate_state.find(name);
    return typed == r.rate_state.end() ? otherwise : typed->second;
  };
  RateStateMachine machine;
  machine.evolution = r.evolution;
  machine.states = r.rate_state.contains("D_c2") || r.rate_state.contains("b_2") ? 2 : 1;
  machine.parameters.a = value("a", 0.01);
  machine.parameters.b = {value("b", 0.012), value("b_2", 0)};
  machine.parameters.distance = {value("D_c", 10 * kMicro), value("D_c2", 100 * kMicro)};
  machine.parameters.stiffness = value("k", 0.002 / kMicro);
  machine.base_friction = value("mu_0", 0.6);
  machine.reference_speed = r.reference_speed.value_or(first_speed);
  return machine;
}

std::vector<double> times_of(const SimulationOptions& options) {
  constexpr double kMostSamples = 1e7;  // a file of 300 MB
  check_samples(options, kMostSamples);
  std::vector<double> times;
  for (std::size_t i = 0; static_cast<double>(i) / options.rate < options.duration; ++i)
    times.push_back(static_cast<double>(i) / options.rate);
  return times;
}

std::string rows_of(const SimulateRequest& r, const std::vector<LoadPointPhase>& phases,
                    const std::vector<double>& times, const std::vector<double>& friction) {
  std::mt19937_64 generator(r.options.seed);
  std::normal_distribution<double> normal;
  std::string text = "time_s,lp_disp_um,mu\n";
  const double colour = r.sensors.noise_colour;
  double noise = 0, displacement = 0;
  std::size_t phase = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = times[i], fresh = normal(generator);
    noise = i == 0 ? fresh : colour * noise + std::sqrt(1 - colour * colour) * fresh;
    while (phase + 1 < phases.size() && phases[phase + 1].begin <= t) {
      displacement += phases[phase].speed * (phases[phase + 1].begin - phases[phase].begin);
      ++phase;
    }
    const double moved = displacement + phases[phase].speed * (t - phases[phase].begin);
    text += fmt::format("{},{},{}\n", fixed(t, 6), fixed(moved / kMicro, 4),
                        fixed(friction[i] + r.drift * t + r.sensors.friction_noise * noise, 7));
  }
  return text;
}

std::string truth_of(const SimulateRequest& r, const RateStateMachine& machine, std::size_t samples) {
  const RateStateParameters<double>& p = machine.parameters;
  const auto item = [](const char* name, double value, const char* unit) {
    return Json{{"name", name}, {"value", value}, {"unit", unit}};
  };
  Json parameters = {item("a", p.a, "1"), item("b", p.b[0], "1"), item("D_c", p.distance[0] / kMicro, "um")};
  if (machine.states > 1) {
    parameters.push_back(item("b_2", p.b[1], "1"));
    parameters.push_back(item("D_c2", p.distance[1] / kMicro, "um"));
  }
  parameters.push_back(item("k", p.stiffness * kMicro, "1/um"));
  parameters.push_back(item("mu_0", machine.base_friction, "1"));
  const Json truth = {{"tool", {{"name", "identify simulate"}, {"version", version}}},
                      {"trace", {{"path", r.out}, {"samples", samples}}},
                      {"kind", r.kind},
                      {"law", to_string(machine.evolution)},
                      {"parameters", parameters},
                      {"v0_um_s", machine.reference_speed / kMicro},
                      {"speed_steps", r.speed_steps},
                      {"drift_per_s", r.drift},
                      {"noise_mu", r.sensors.friction_noise},
                      {"noise_colour", r.sensors.noise_colour},
                      {"seed", r.options.seed}};
  return truth.dump(1) + "\n";
}

}  // namespace

void add_steps_options(const Command& verb, SimulateRequest& r) {
  const Command in = verb.in(section::kSteps);
  in.add_option("--kind", r.kind,
                "velocity-steps or slide-hold-slide: a load point at the --speed-steps, 0s:2um/s,60s:10um/s")
      .one_of({"velocity-steps", "slide-hold-slide"});
  in.add_read(
      "--rate-state", [&r](const std::string& text) { r.rate_state = rate_state_values(text, "--rate-state"); },
      "Its friction and spring: a=0.01,b=0.012,D_c=10um,k=0.002/um,mu_0=0.6");
  in.add_read(
        "--evolution", [&r](const std::string& name) { r.evolution = *find_state_evolution(name); },
        "Law of its state, ageing (default) or slip")
      .one_of(state_evolution_names());
  in.add_number("--reference-speed", positive(Quantity::velocity), r.reference_speed,
                "v0, at which mu_0 holds, 1um/s (default: the first speed)");
  in.add_number("--drift", {Quantity::inverse_time, "0/s"}, r.drift, "Slope of its friction over time, 1e-5/s");
}

void simulate_steps(const SimulateRequest& r, const std::string& truth_path) {
  if (r.speed_steps.empty()) throw InputError("the load point has no speeds", "give --speed-steps 0s:2um/s,60s:10um/s");
  const std::vector<LoadPointPhase> phases = phases_from(r.speed_steps, "--speed-steps");
  const RateStateMachine machine = machine_of(r, phases.front().speed);
  if (!(r.options.duration > phases.back().begin))
    throw InputError("--duration ends before the last of --speed-steps begins", "give a longer one");
  const std::vector<double> times = times_of(r.options);
  if (!(std::abs(r.sensors.noise_colour) < 1))
    throw InputError("--noise-colour is not below 1", "give a coefficient such as 0.9");
  write_record(r.out, truth_path, [&](WholeFile& file) {
    const RateStateMotion motion = simulate_velocity_steps(machine, phases, times);
    if (!motion.failure.empty())
      throw InputError("the record cannot be simulated: " + motion.failure,
                       "give a stiffer machine, k above (b - a)/D_c, or larger a");
    file.write(rows_of(r, phases, times, motion.friction));
    return truth_of(r, machine, times.size());
  });
  if (r.quiet) return;
  print(fmt::format("{}: {} samples, {} law\n{}: the truth\nnext: identify --kind {} {}\n", r.out, times.size(),
                    to_string(machine.evolution), truth_path, r.kind, r.out));
}

}  // namespace tribofit
