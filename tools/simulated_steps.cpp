#include "simulated_steps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "console.hpp"
#include "settings.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/record_kind.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/oscillator/velocity_steps.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/output/whole_file.hpp"
#include "tribofit/version.hpp"
#include "typed_values.hpp"

using Json = nlohmann::ordered_json;

namespace tribofit {
namespace {

constexpr double kMicro = 1e-6;
constexpr double kMostSamples = 1e7;  // a file of 300 MB

struct StepsPlan {
  RateStateMachine machine;
  std::vector<LoadPointPhase> phases;
  std::vector<double> times;
  double drift = 0, noise = 0, colour = 0;  ///< [1/s], [1], AR(1) coefficient from sample to sample
};

RateStateMachine machine_of(const StepsRequest& request, double first_speed) {
  std::map<std::string, double> values = rate_state_values(request.values, "--rate-state");
  const auto value = [&](const char* name, double otherwise) { return values.emplace(name, otherwise).first->second; };
  RateStateMachine machine;
  machine.evolution = request.evolution;
  machine.states = values.contains("D_c2") || values.contains("b_2") ? 2 : 1;
  machine.parameters.a = value("a", 0.01);
  machine.parameters.b = {value("b", 0.012), value("b_2", 0)};
  machine.parameters.distance = {value("D_c", 10 * kMicro), value("D_c2", 100 * kMicro)};
  machine.parameters.stiffness = value("k", 0.002 / kMicro);
  machine.base_friction = value("mu_0", 0.6);
  machine.reference_speed =
      request.reference_speed.empty() ? first_speed : reference_speed_from(request.reference_speed);
  return machine;
}

StepsPlan plan_steps(const RecordRequest& record, const StepsRequest& request) {
  if (record.speed_steps.empty())
    throw InputError("the load point has no speeds", "give --speed-steps 0s:2um/s,60s:10um/s");
  StepsPlan plan;
  plan.phases = phases_from(record.speed_steps, "--speed-steps");
  plan.machine = machine_of(request, plan.phases.front().speed);
  const double duration = stated_value(record.duration, Quantity::time, "--duration", "s");
  const double rate = stated_value(record.rate, Quantity::frequency, "--rate", "Hz");
  if (!(rate > 0) || !(duration > plan.phases.back().begin))
    throw InputError("--duration ends before the last of --speed-steps begins", "give a longer one");
  if (duration * rate > kMostSamples)
    throw InputError(fmt::format("--duration and --rate are {} samples, more than the {} that are simulated",
                                 general(duration * rate, 3), general(kMostSamples)),
                     "give a shorter duration or a lower rate, such as --rate 100Hz");
  for (std::size_t i = 0; static_cast<double>(i) / rate < duration; ++i)
    plan.times.push_back(static_cast<double>(i) / rate);
  plan.drift = parse_quantity(request.drift, Quantity::inverse_time, "--drift");
  plan.noise = stated_value(record.noise_mu, Quantity::dimensionless, "--noise-mu");
  plan.colour = stated_value(record.noise_colour, Quantity::dimensionless, "--noise-colour");
  if (!(std::abs(plan.colour) < 1)) throw InputError("--noise-colour is not below 1", "give a coefficient such as 0.9");
  return plan;
}

std::string rows_of(const StepsPlan& plan, const std::vector<double>& friction, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::string text = "time_s,lp_disp_um,mu\n";
  double noise = 0, displacement = 0;
  std::size_t phase = 0;
  for (std::size_t i = 0; i < plan.times.size(); ++i) {
    const double t = plan.times[i], fresh = normal(generator);
    noise = i == 0 ? fresh : plan.colour * noise + std::sqrt(1 - plan.colour * plan.colour) * fresh;
    while (phase + 1 < plan.phases.size() && plan.phases[phase + 1].begin <= t) {
      displacement += plan.phases[phase].speed * (plan.phases[phase + 1].begin - plan.phases[phase].begin);
      ++phase;
    }
    const double moved = displacement + plan.phases[phase].speed * (t - plan.phases[phase].begin);
    text += fmt::format("{},{},{}\n", fixed(t, 6), fixed(moved / kMicro, 4),
                        fixed(friction[i] + plan.drift * t + plan.noise * noise, 7));
  }
  return text;
}

std::string truth_of(const RecordRequest& record, const StepsRequest& request, const StepsPlan& plan) {
  const RateStateParameters<double>& p = plan.machine.parameters;
  const auto item = [](const char* name, double value, const char* unit) {
    return Json{{"name", name}, {"value", value}, {"unit", unit}};
  };
  Json parameters = {item("a", p.a, "1"), item("b", p.b[0], "1"), item("D_c", p.distance[0] / kMicro, "um")};
  if (plan.machine.states > 1) {
    parameters.push_back(item("b_2", p.b[1], "1"));
    parameters.push_back(item("D_c2", p.distance[1] / kMicro, "um"));
  }
  parameters.push_back(item("k", p.stiffness * kMicro, "1/um"));
  parameters.push_back(item("mu_0", plan.machine.base_friction, "1"));
  const Json truth = {{"tool", {{"name", "identify simulate"}, {"version", version}}},
                      {"trace", {{"path", record.out}, {"samples", plan.times.size()}}},
                      {"kind", request.kind},
                      {"law", to_string(plan.machine.evolution)},
                      {"parameters", parameters},
                      {"v0_um_s", plan.machine.reference_speed / kMicro},
                      {"speed_steps", record.speed_steps},
                      {"drift_per_s", plan.drift},
                      {"noise_mu", plan.noise},
                      {"noise_colour", plan.colour},
                      {"seed", stated_seed(record.seed_text)}};
  return truth.dump(1) + "\n";
}

}  // namespace

void add_steps_options(const Command& verb, StepsRequest& r) {
  const Command in = verb.in("Velocity steps and holds");
  in.add_option("--kind", r.kind,
                "velocity-steps or slide-hold-slide: a load point at the --speed-steps, 0s:2um/s,60s:10um/s")
      .one_of({"velocity-steps", "slide-hold-slide"});
  in.add_option("--rate-state", r.values, "Its friction and spring: a=0.01,b=0.012,D_c=10um,k=0.002/um,mu_0=0.6");
  in.add_read(
        "--evolution", [&r](const std::string& name) { r.evolution = *find_state_evolution(name); },
        "Law of its state, ageing (default) or slip")
      .one_of(state_evolution_names());
  in.add_option("--reference-speed", r.reference_speed, "v0, at which mu_0 holds, 1um/s (default: the first speed)");
  in.add_option("--drift", r.drift, "Slope of its friction over time, 1e-5/s").show_default();
}

void write_record(const std::string& path, const std::string& truth_path,
                  const std::function<std::string(WholeFile& record)>& work) {
  WholeFile record(path), truth(truth_path);  // before the work, so that a bad name costs nothing
  truth.write(work(record));
  record.finish();
  truth.finish();
  record.commit();
  truth.commit();
}

void simulate_steps(const RecordRequest& record, const StepsRequest& request, const std::string& truth_path) {
  const StepsPlan plan = plan_steps(record, request);
  write_record(record.out, truth_path, [&](WholeFile& file) {
    const RateStateMotion motion = simulate_velocity_steps(plan.machine, plan.phases, plan.times);
    if (!motion.failure.empty())
      throw InputError("the record cannot be simulated: " + motion.failure,
                       "give a stiffer machine, k above (b - a)/D_c, or larger a");
    file.write(rows_of(plan, motion.friction, stated_seed(record.seed_text)));
    return truth_of(record, request, plan);
  });
  if (record.quiet) return;
  print(fmt::format("{}: {} samples, {} law\n{}: the truth\nnext: identify --kind {} {}\n", record.out,
                    plan.times.size(), to_string(plan.machine.evolution), truth_path, request.kind, record.out));
}

}  // namespace tribofit
