#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "console.hpp"
#include "fixed_decimals.hpp"
#include "machine_options.hpp"
#include "simulated_drive.hpp"
#include "simulated_steps.hpp"
#include "tribofit/friction/model.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/sensors.hpp"
#include "tribofit/oscillator/simulate.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/output/whole_file.hpp"
#include "tribofit/version.hpp"
#include "typed_values.hpp"
#include "verbs.hpp"

namespace tribofit {
namespace {

using Json = nlohmann::ordered_json;

/// The command line as given; empty means: from the published test of the nearest radius.
struct SimulateRequest : RecordRequest {
  MachineRequest machine;
  std::string noise_v = "0mm/s", scatter = "0", wander = "0";
  std::string delay = "0s", mass_below = "0kg", high_pass = "0Hz", force_bandwidth = "0Hz", force_damping = "0.7";
  std::string velocity_gain = "1";
  std::string run_up, reversing, load_swing, temperature;
  std::vector<std::string> pauses;
  StepsRequest steps;
};

/// What is simulated.
struct Plan {
  Machine machine;
  Drive drive;
  Sensors sensors;
  SimulationOptions options;
  double speed = 0;           ///< [rad/s], the amplitude where the drive reverses
  double run_up = 0;          ///< [s]
  double reversing = 0;       ///< [Hz]
  bool writes_speed = false;  ///< the record has a channel of the disc's speed
  double preset_radius = 0;   ///< of the published test the defaults come from [m]
};

double number(const std::string& text, const char* option) {
  return stated_value(text, Quantity::dimensionless, option);
}

void plan_drive(const SimulateRequest& request, Plan& plan) {
  Drive& drive = plan.drive;
  drive = plan.machine.drive();
  plan.speed = plan.machine.speed;
  plan.run_up = given_or(request.run_up, Quantity::time, "--run-up", "s", 0);
  plan.reversing = given_or(request.reversing, Quantity::frequency, "--reversing", "Hz", 0);
  const bool stepped = !request.speed_steps.empty() || !request.pauses.empty();
  if (!request.run_up.empty() + !request.reversing.empty() + stepped > 1) {
    throw InputError("--run-up, --reversing and --speed-steps with --pause exclude each other", "give one of them");
  }
  if (!request.run_up.empty() && !(plan.run_up > 0)) {
    throw InputError("--run-up is not positive", "give it as e.g. 1s, or leave it out");
  }
  if (plan.run_up > 0) drive.speed = run_up_speed(plan.speed, plan.run_up);
  if (!request.reversing.empty()) drive.speed = reversing_speed(plan.speed, plan.reversing);
  if (stepped) {
    drive.speed = stepped_speed_from(request.speed_steps, request.pauses, plan.speed);
    plan.speed = drive.speed.speed(0);
  }
  plan.writes_speed = stepped || !request.reversing.empty();
  const double duration = stated_value(request.duration, Quantity::time, "--duration", "s");
  if (!(duration > 0))
    throw InputError("--duration: '" + request.duration + "' is not positive", "give it as e.g. 20s");
  swing_load(request.load_swing, duration, drive);
  vary_temperature(request.temperature, duration, drive);
}

Sensors plan_sensors(const SimulateRequest& request) {
  return {.mass_below = stated_value(request.mass_below, Quantity::mass, "--mass-below", "kg"),
          .force_bandwidth = stated_value(request.force_bandwidth, Quantity::frequency, "--force-bandwidth", "Hz"),
          .force_damping = number(request.force_damping, "--force-damping"),
          .friction_delay = stated_value(request.delay, Quantity::time, "--delay", "s"),
          .velocity_gain = number(request.velocity_gain, "--velocity-gain"),
          .velocity_high_pass = stated_value(request.high_pass, Quantity::frequency, "--high-pass", "Hz"),
          .friction_noise = number(request.noise_mu, "--noise-mu"),
          .velocity_noise = stated_value(request.noise_v, Quantity::velocity, "--noise-v", "mm/s"),
          .noise_colour = number(request.noise_colour, "--noise-colour"),
          .seed = stated_seed(request.seed_text)};
}

void refuse_work(const SimulateRequest& request, const SimulationOptions& options, const Rig& rig) {
  constexpr double kMost = 1e8;         // 10 GB of memory, and a file of 3 GB
  constexpr double kMostPeriods = 1e7;  // minutes of work for a bare law, and 2 GB of memory
  const double samples = options.duration * options.rate;
  const double periods = options.duration * rig.natural_frequency() / (2 * std::numbers::pi);
  const std::string what = fmt::format("--duration {} at --rate {}", request.duration, request.rate);
  if (samples < 2) {
    throw InputError(what + " is less than two samples", "give a longer duration or a higher rate");
  }
  if (samples > kMost) {
    throw InputError(
        fmt::format("{} is {} samples, more than the {} that are simulated", what, general(samples, 3), general(kMost)),
        "give a shorter duration or a lower rate");
  }
  if (periods > kMostPeriods) {
    throw InputError(
        fmt::format("--duration {} is {} natural periods of {} kg on {} N/mm, more than the {} that are simulated",
                    request.duration, general(periods, 3), general(rig.mass, 3), general(1e-3 * rig.stiffness, 3),
                    general(kMostPeriods)),
        "give a shorter duration");
  }
}

Plan make_plan(const SimulateRequest& request) {
  Plan plan;
  const RequestedMachine requested = machine_from(request.machine);
  plan.machine = requested.machine;
  plan.preset_radius = requested.preset_radius;
  plan_drive(request, plan);
  plan.sensors = plan_sensors(request);
  plan.options = {.duration = stated_value(request.duration, Quantity::time, "--duration", "s"),
                  .rate = stated_value(request.rate, Quantity::frequency, "--rate", "Hz"),
                  .scatter = {number(request.scatter, "--scatter"), number(request.wander, "--wander")},
                  .seed = stated_seed(request.seed_text)};
  if (!(plan.options.rate > 0))
    throw InputError("--rate: '" + request.rate + "' is not positive", "give it as e.g. 20kHz");
  refuse_work(request, plan.options, plan.machine.rig);
  const bool starts_at_speed = plan.run_up == 0 && plan.reversing == 0 && plan.drive.speed.speed(0) != 0;
  if (starts_at_speed && plan.machine.rig.mass > 0 && plan.machine.rig.stiffness > 0 &&
      plan.machine.parameters[0] > 0) {
    plan.options.settle = settling_time(plan.machine.rig, plan.drive, plan.machine.parameters);
  }
  return plan;
}

/// A column of a CSV file: one value a row, in the unit of its header, with a fixed number of decimals.
struct Column {
  const char* header;
  const std::vector<double>* values;
  double per_si;
  int decimals;
};

void write_trace(WholeFile& file, const Trace& trace, const Plan& plan) {
  std::vector<Column> columns = {{"time_s", &trace.time, 1, time_decimals(plan.options.rate)},
                                 {"mu", &trace.friction, 1, 5},
                                 {"v_b_mm_s", &trace.velocity, 1e3, 4}};
  if (!trace.load.empty()) columns.push_back({"load_N", &trace.load, 1, 4});
  if (!trace.temperature.empty()) columns.push_back({"temperature_C", &trace.temperature, 1, 3});
  if (plan.writes_speed && !trace.disc_speed.empty()) columns.push_back({"speed_rpm", &trace.disc_speed, 1 / kRpm, 5});
  std::string text;
  for (const Column& column : columns) text.append(text.empty() ? "" : ",").append(column.header);
  text += '\n';
  for (std::size_t i = 0; i < trace.size(); ++i) {
    for (const Column& column : columns) {
      append_fixed(text, (*column.values)[i] * column.per_si, column.decimals);
      text += &column == &columns.back() ? '\n' : ',';
    }
    constexpr std::size_t kChunk = 1 << 16;
    if (text.size() > kChunk) {
      file.write(text);
      text.clear();
    }
  }
  file.write(text);
}

Json parameters_json(const Plan& plan) {
  Json list = Json::array();
  const auto slots = plan.machine.model.parameters();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Parameter& parameter = slots[i].parameter;
    list.push_back({{"name", parameter.name},
                    {"value", plan.machine.parameters[i] / parameter.si},
                    {"unit", parameter.unit},
                    {"effect", slots[i].effect.empty() ? Json() : Json(slots[i].effect)}});
  }
  return list;
}

Json cycles_json(const Plan& plan, const SimulatedMotion& motion) {
  Json list = Json::array();
  for (const SimulatedSlip& slip : motion.slips) {
    list.push_back(
        {{"break_away_s", slip.break_away_time},
         {"restick_s", std::isnan(slip.restick_time) ? Json() : Json(slip.restick_time)},
         {"stick_s", slip.stick_time},
         {"direction", slip.direction},
         {static_level_name, friction_at_rest(plan.machine.model.law(), plan.machine.parameters) + slip.mu_s_offset},
         {"break_away_friction", slip.break_away_friction}});
  }
  return list;
}

/// The whole truth about a simulated trace.
Json truth(const SimulateRequest& request, const Plan& plan, const SimulatedMotion& motion, double floor) {
  const Sensors& sensors = plan.sensors;
  return {{"tool", {{"name", "identify simulate"}, {"version", version}}},
          {"trace",
           {{"path", request.out},
            {"samples", motion.size()},
            {"duration_s", plan.options.duration},
            {"rate_hz", plan.options.rate},
            {"resolution", {{"mu", 1e-5}, {"v_b_mm_s", 1e-4}}}}},
          {"conditions",
           {{"radius_mm", 1e3 * plan.drive.radius},
            {"speed_rpm", plan.speed / kRpm},
            {"load_N", plan.drive.mean_load},
            {"run_up_s", plan.run_up},
            {"reversing_hz", plan.reversing},
            {"speed_steps", request.speed_steps},
            {"pauses", request.pauses},
            {"load_swing", request.load_swing},
            {"temperature", request.temperature},
            {"mean_temperature_degC", plan.drive.mean_temperature},
            {"settled_before_s", plan.options.settle}}},
          {"law", to_string(plan.machine.model.law())},
          {"effects", plan.machine.model.effect_keys()},
          {"effect_names", plan.machine.model.effect_names()},
          {"formulas", request.machine.formulas},
          {"parameters", parameters_json(plan)},
          {"rig",
           {{"mass_kg", plan.machine.rig.mass},
            {"stiffness_N_per_mm", 1e-3 * plan.machine.rig.stiffness},
            {"damping_ratio", plan.machine.rig.damping_ratio()},
            {"damping_N_s_per_mm", 1e-3 * plan.machine.rig.damping},
            {"defaults_from_radius_mm", 1e3 * plan.preset_radius}}},
          {"scatter", {{"deviation", plan.options.scatter.deviation}, {"wander", plan.options.scatter.wander}}},
          {"sensors",
           {{"noise_mu", sensors.friction_noise},
            {"noise_v_mm_s", 1e3 * sensors.velocity_noise},
            {"noise_colour", sensors.noise_colour},
            {"delay_ms", 1e3 * sensors.friction_delay},
            {"mass_below_kg", sensors.mass_below},
            {"force_bandwidth_hz", sensors.force_bandwidth},
            {"force_damping_ratio", sensors.force_damping},
            {"velocity_gain", sensors.velocity_gain},
            {"velocity_high_pass_hz", sensors.velocity_high_pass}}},
          {"seed", stated_seed(request.seed_text)},
          {"floor_rmse", floor},
          {"break_aways", motion.break_away_count()},
          {"cycles", cycles_json(plan, motion)}};
}

/// trace.csv -> trace.json.
std::string json_path(const std::string& csv) {
  const auto slash = csv.find_last_of('/');
  const auto dot = csv.find_last_of('.');
  const bool has_ending = dot != std::string::npos && dot != 0 && (slash == std::string::npos || dot > slash + 1);
  const std::string stem = has_ending ? csv.substr(0, dot) : csv;
  const std::string path = stem + ".json";
  if (path == csv) throw InputError("--out " + csv + " is where the truth is written", "give a name ending in .csv");
  return path;
}

void run_simulate(const SimulateRequest& request) {
  if (request.out == "-") {
    throw InputError("--out - is not a file", "two files are written, the trace and the truth beside it: give a name");
  }
  const std::string truth_path = json_path(request.out);
  if (!request.steps.kind.empty()) return simulate_steps(request, request.steps, truth_path);
  const Plan plan = make_plan(request);
  SimulatedMotion motion;
  double floor = 0;
  write_record(request.out, truth_path, [&](WholeFile& file) {
    SimulatedRecording simulated = simulate_recording(plan.machine.model, plan.machine.parameters, plan.machine.rig,
                                                      plan.drive, plan.options, plan.sensors);
    write_trace(file, simulated.recording.trace, plan);
    motion = std::move(simulated.motion);
    floor = simulated.floor_rmse;
    return truth(request, plan, motion, floor).dump(1) + "\n";
  });
  if (request.quiet) return;
  std::string text = fmt::format("{}: {} samples, {} break-aways, {}\n", request.out, motion.size(),
                                 motion.break_away_count(), plan.machine.model.name());
  text += fmt::format("{}: the truth; over slip the true law leaves an RMSE of {}\n", truth_path, fixed(floor, 6));
  if (plan.sensors.friction_noise == 0 && plan.sensors.velocity_noise == 0 && plan.options.scatter.deviation == 0)
    text += "without noise and scatter; --noise-mu, --noise-v and --scatter add them\n";
  if (std::abs(plan.preset_radius - plan.drive.radius) > 1e-9) {
    text +=
        fmt::format("values not given are those of the published test at {} mm\n", general(1e3 * plan.preset_radius));
  }
  std::string known = fmt::format("--radius {}mm", general(1e3 * plan.drive.radius));
  if (plan.drive.speed.constant) known += fmt::format(" --speed {}rpm", general(plan.speed / kRpm));
  if (plan.machine.model.needs().force) known += fmt::format(" --load {}N", general(plan.drive.mean_load));
  print(text + fmt::format("next: identify {} {}\n", known, request.out));
}

void add_options(const Command& verb, SimulateRequest& r) {
  verb.add_option("--out", r.out, "CSV file to write; the truth goes beside it as .json").required();
  verb.add_option("--duration", r.duration, "Duration of the record").show_default();
  verb.add_option("--rate", r.rate, "Samples per second").show_default();
  verb.add_option("--seed", r.seed_text, "Seed of noise and scatter").show_default();
  verb.add_flag("--quiet", r.quiet, "Print nothing");
  add_machine_options(verb, r.machine);
  add_steps_options(verb, r.steps);
  const Command rig = verb.in("Motion of the disc, load and temperature");
  rig.add_option("--run-up", r.run_up,
                 "Start from standstill and reach the speed in this time; else the start is settled");
  rig.add_option("--reversing", r.reversing,
                 "The disc goes forth and back as a sine of this frequency; --speed is its peak");
  rig.add_option("--speed-steps", r.speed_steps,
                 "Speeds from times on, of the disc 0s:2rpm,10s:4rpm,20s:-4rpm, of a load point 0s:2um/s,60s:10um/s");
  rig.add_option("--pause", r.pauses, "The disc stands still from a time on for some time, e.g. 10s,5s (repeatable)");
  rig.add_option("--load-swing", r.load_swing,
                 "A sine on the load, with a load channel: amplitude and period, e.g. 10N,7s");
  rig.add_option("--temperature", r.temperature,
                 "Temperature channel: a ramp 20degC..60degC, or a swing between the two 20degC..60degC,15s");
  const auto with_default = [](const Command& in, const char* flag, std::string& value, const char* help) {
    in.add_option(flag, value, help).show_default();
  };
  const Command law = verb.in("Scatter of break-away");
  with_default(law, "--scatter", r.scatter, "Standard deviation of mu_s from cycle to cycle");
  with_default(law, "--wander", r.wander, "Correlation of the scatter between neighbouring cycles");
  const Command sensors = verb.in("Sensors");
  with_default(sensors, "--noise-mu", r.noise_mu, "Standard deviation of the noise on mu");
  with_default(sensors, "--noise-v", r.noise_v, "Standard deviation of the noise on v_b");
  with_default(sensors, "--noise-colour", r.noise_colour, "AR(1) coefficient of both noises; 0 is white");
  with_default(sensors, "--delay", r.delay, "Time by which mu is recorded later than v_b");
  with_default(sensors, "--mass-below", r.mass_below, "Mass below the force sensor");
  with_default(sensors, "--force-bandwidth", r.force_bandwidth, "Second-order low-pass on mu; 0: none");
  with_default(sensors, "--force-damping", r.force_damping, "Damping ratio of that low-pass");
  with_default(sensors, "--velocity-gain", r.velocity_gain, "Vibrometer reading over true velocity");
  with_default(sensors, "--high-pass", r.high_pass, "First-order high-pass of the vibrometer; 0: none");
}

}  // namespace
}  // namespace tribofit

void add_simulate(const Command& app) {
  const Command verb = app.add_verb("simulate", "Writes a simulated trace with the truth beside it");
  verb.footer(
      "Example:\n  identify simulate --radius 15mm --effect viscous:sigma=0.001 --noise-mu 0.003 --scatter 0.004 --out "
      "trace.csv");
  auto request = std::make_shared<tribofit::SimulateRequest>();
  tribofit::add_options(verb, *request);
  verb.on_run([request] {
    stated_seed(request->seed_text);
    run_simulate(*request);
    return ExitStatus::done;
  });
}
