#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "simulated.hpp"
#include "tribofit/friction/model.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/version.hpp"
#include "typed_values.hpp"
#include "verbs.hpp"

namespace tribofit {
namespace {

using Json = nlohmann::ordered_json;

/// What is simulated.
struct Plan {
  Machine machine;
  Drive drive;
  SimulationOptions options;
  double speed = 0;           ///< [rad/s], the amplitude where the drive reverses
  bool writes_speed = false;  ///< the record has a channel of the disc's speed
  double preset_radius = 0;   ///< of the published test the defaults come from [m]
};

Plan make_plan(const SimulateRequest& request) {
  const RequestedMachine requested = machine_from(request.machine);
  Plan plan{requested.machine, drive_from(request, requested.machine), request.options, requested.machine.speed};
  plan.preset_radius = requested.preset_radius;
  const bool stepped = !request.speed_steps.empty() || !request.pauses.empty();
  if (stepped) plan.speed = plan.drive.speed.speed(0);
  plan.writes_speed = stepped || request.reversing;
  constexpr double kMostSamples = 1e8;  // 10 GB of memory, and a file of 3 GB
  constexpr double kMostPeriods = 1e7;  // minutes of work for a bare law, and 2 GB of memory
  check_samples(plan.options, kMostSamples);
  const Rig& rig = plan.machine.rig;
  const double periods = plan.options.duration * rig.natural_frequency() / (2 * std::numbers::pi);
  if (periods > kMostPeriods) {
    throw InputError(
        fmt::format("--duration is {} natural periods of {} kg on {} N/mm, more than the {} that are "
                    "simulated",
                    general(periods, 3), general(rig.mass, 3), general(1e-3 * rig.stiffness, 3), general(kMostPeriods)),
        "give a shorter duration");
  }
  const bool starts_at_speed = !request.run_up && !request.reversing && plan.drive.speed.speed(0) != 0;
  if (starts_at_speed && rig.mass > 0 && rig.stiffness > 0 && plan.machine.parameters[0] > 0)
    plan.options.settle = settling_time(rig, plan.drive, plan.machine.parameters);
  return plan;
}

/// Appends value with a fixed number of decimals; the way over integers is several times faster than printing a double.
void append_fixed(std::string& text, double value, int decimals) {
  if (!std::isfinite(value)) {
    throw InputError("the simulated record holds a value that is no finite number",
                     "give friction, rig and sensors smaller values");
  }
  constexpr double kLargest = 1e9;  // whose digits fit into an integer
  if (!(std::abs(value) < kLargest)) {
    text += fixed(value, decimals);
    return;
  }
  const double power = std::pow(10.0, decimals);
  const auto scaled = std::llround(value * power), unit = std::llround(power);
  const auto put = [&](long long number, std::size_t width) {
    std::array<char, 24> digits;
    const char* end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    const auto length = static_cast<std::size_t>(end - digits.data());
    text.append(width - std::min(width, length), '0').append(digits.data(), length);
  };
  if (scaled < 0) text += '-';
  put(std::abs(scaled) / unit, 1);
  if (decimals == 0) return;
  text += '.';
  put(std::abs(scaled) % unit, static_cast<std::size_t>(decimals));
}

/// Decimals that give every multiple of the sampling interval exactly, at most nine.
int time_decimals(double rate) {
  double ticks = 1 / rate;
  int decimals = 0;
  for (; decimals < 9 && std::abs(ticks - std::round(ticks)) > 1e-9 * ticks; ++decimals) ticks *= 10;
  return decimals;
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
  const Sensors& sensors = request.sensors;
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
            {"run_up_s", request.run_up.value_or(0)},
            {"reversing_hz", request.reversing.value_or(0)},
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
          {"seed", request.options.seed},
          {"floor_rmse", floor},
          {"break_aways", motion.break_away_count()},
          {"cycles", cycles_json(plan, motion)}};
}

/// trace.csv -> trace.json.
std::string json_path(const std::string& csv) {
  const std::string path = std::filesystem::path(csv).replace_extension(".json").string();
  if (path == csv) throw InputError("--out " + csv + " is where the truth is written", "give a name ending in .csv");
  return path;
}

void run_simulate(const SimulateRequest& request) {
  if (request.out == "-") {
    throw InputError("--out - is not a file", "two files are written, the trace and the truth beside it: give a name");
  }
  const std::string truth_path = json_path(request.out);
  if (!request.kind.empty()) return simulate_steps(request, truth_path);
  const Plan plan = make_plan(request);
  SimulatedMotion motion;
  double floor = 0;
  write_record(request.out, truth_path, [&](WholeFile& file) {
    SimulatedRecording simulated = simulate_recording(plan.machine.model, plan.machine.parameters, plan.machine.rig,
                                                      plan.drive, plan.options, request.sensors);
    write_trace(file, simulated.recording.trace, plan);
    motion = std::move(simulated.motion);
    floor = simulated.floor_rmse;
    return truth(request, plan, motion, floor).dump(1) + "\n";
  });
  if (request.quiet) return;
  std::string text = fmt::format("{}: {} samples, {} break-aways, {}\n", request.out, motion.size(),
                                 motion.break_away_count(), plan.machine.model.name());
  text += fmt::format("{}: the truth; over slip the true law leaves an RMSE of {}\n", truth_path, fixed(floor, 6));
  const Sensors& sensors = request.sensors;
  if (sensors.friction_noise == 0 && sensors.velocity_noise == 0 && plan.options.scatter.deviation == 0)
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
  SimulationOptions& options = r.options;
  Sensors& s = r.sensors;
  verb.add_option("--out", r.out, "CSV file to write; the truth goes beside it as .json").required();
  verb.add_number("--duration", positive(Quantity::time, "20s"), options.duration, "Duration of the record");
  verb.add_number("--rate", positive(Quantity::frequency, "20kHz"), options.rate, "Samples per second");
  verb.add_read(
      "--seed", [&](const std::string& text) { options.seed = s.seed = stated_seed(text); },
      "Seed of noise and scatter", "1");
  verb.add_flag("--quiet", r.quiet, "Print nothing");
  add_machine_options(verb, r.machine);
  add_steps_options(verb, r);
  const Command rig = verb.in(section::kDrive);
  rig.add_number("--run-up", positive(Quantity::time), r.run_up,
                 "Start from standstill and reach the speed in this time; else the start is settled");
  rig.add_number("--reversing", {Quantity::frequency}, r.reversing,
                 "The disc goes forth and back as a sine of this frequency; --speed is its peak");
  rig.add_option("--speed-steps", r.speed_steps,
                 "Speeds from times on, of the disc 0s:2rpm,10s:4rpm,20s:-4rpm, of a load point 0s:2um/s,60s:10um/s");
  rig.add_option("--pause", r.pauses, "The disc stands still from a time on for some time, e.g. 10s,5s (repeatable)");
  rig.add_option("--load-swing", r.load_swing,
                 "A sine on the load, with a load channel: amplitude and period, e.g. 10N,7s");
  rig.add_option("--temperature", r.temperature,
                 "Temperature channel: a ramp 20degC..60degC, or a swing between the two 20degC..60degC,15s");
  constexpr Quantity kPlain = Quantity::dimensionless;
  const Command law = verb.in(section::kScatter);
  law.add_number("--scatter", {kPlain, "0"}, options.scatter.deviation,
                 "Standard deviation of mu_s from cycle to cycle");
  law.add_number("--wander", {kPlain, "0"}, options.scatter.wander,
                 "Correlation of the scatter between neighbouring cycles");
  const Command in = verb.in(section::kSensors);
  in.add_number("--noise-mu", {kPlain, "0"}, s.friction_noise, "Standard deviation of the noise on mu");
  in.add_number("--noise-v", {Quantity::velocity, "0mm/s"}, s.velocity_noise, "Standard deviation of the noise on v_b");
  in.add_number("--noise-colour", {kPlain, "0"}, s.noise_colour, "AR(1) coefficient of both noises; 0 is white");
  in.add_number("--delay", {Quantity::time, "0s"}, s.friction_delay, "Time by which mu is recorded later than v_b");
  in.add_number("--mass-below", {Quantity::mass, "0kg"}, s.mass_below, "Mass below the force sensor");
  in.add_number("--force-bandwidth", {Quantity::frequency, "0Hz"}, s.force_bandwidth,
                "Second-order low-pass on mu; 0: none");
  in.add_number("--force-damping", {kPlain, "0.7"}, s.force_damping, "Damping ratio of that low-pass");
  in.add_number("--velocity-gain", {kPlain, "1"}, s.velocity_gain, "Vibrometer reading over true velocity");
  in.add_number("--high-pass", {Quantity::frequency, "0Hz"}, s.velocity_high_pass,
                "First-order high-pass of the vibrometer; 0: none");
}

}  // namespace

void check_samples(const SimulationOptions& options, double most) {
  const double samples = options.duration * options.rate;
  if (samples < 2)
    throw InputError("--duration and --rate are less than two samples", "give a longer duration or a higher rate");
  if (samples > most) {
    throw InputError(fmt::format("--duration and --rate are {} samples, more than the {} that are simulated",
                                 general(samples, 3), general(most)),
                     "give a shorter duration or a lower rate, such as --rate 100Hz");
  }
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

}  // namespace tribofit

void add_simulate(const Command& app) {
  const Command verb = app.add_verb("simulate", "Writes a simulated trace with the truth beside it",
                                    "Example:\n  identify simulate --radius 15mm --effect viscous:sigma=0.001s/mm "
                                    "--noise-mu 0.003 --scatter 0.004 --out "
                                    "trace.csv");
  auto request = std::make_shared<tribofit::SimulateRequest>();
  tribofit::add_options(verb, *request);
  verb.on_run([request, verb] {
    refuse_unread(verb.typed(), tribofit::find_record_kind(request->kind).value_or(tribofit::RecordKind::stick_slip));
    tribofit::run_simulate(*request);
  });
}
