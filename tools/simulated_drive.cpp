
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "simulated.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "typed_values.hpp"

namespace tribofit {
namespace {

/// Mean over the record: what a reader of the record would call N0 or T0.
double mean_over(const std::function<double(double)>& channel, double duration) {
  constexpr int kParts = 10000;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) sum += channel((i + 0.5) / kParts * duration);
  return sum / kParts;
}

/// Speeds of the disc from "0s:2rpm,10s:4rpm" (empty: `speed` [rad/s] throughout) and pauses "10s,5s".
SpeedProfile stepped_speed_from(const std::string& steps, const std::vector<std::string>& pause_texts, double speed) {
  std::vector<double> times, speeds;
  for (const std::string& step : steps.empty() ? std::vector<std::string>() : split(steps, ',')) {
    const auto [time, value] = two_parts(step, ":", "--speed-steps", "0s:2rpm,10s:4rpm");
    times.push_back(stated_value(time, Quantity::time, "--speed-steps"));
    speeds.push_back(stated_value(value, Quantity::angular_velocity, "--speed-steps"));
  }
  if (times.empty()) times = {0}, speeds = {speed};
  std::vector<Pause> pauses;
  for (const std::string& text : pause_texts) {
    const auto [begin, duration] = two_parts(text, ",", "--pause", "10s,5s");
    pauses.push_back(
        {stated_value(begin, Quantity::time, "--pause"), stated_value(duration, Quantity::time, "--pause")});
  }
  return stepped_speed(std::move(times), std::move(speeds), pauses);
}

/// "10N,7s": a sine of that amplitude and period on the load; the mean load becomes that of the record.
void swing_load(const std::string& text, double duration, Drive& drive) {
  const auto [size, time] = two_parts(text, ",", "--load-swing", "10N,7s");
  const double amplitude = stated_value(size, Quantity::force, "--load-swing");
  const double period = stated_value(time, Quantity::time, "--load-swing");
  if (!(std::abs(amplitude) < drive.mean_load) || !(period > 0)) {
    throw InputError("--load-swing is not smaller than the load, or has no period", "write it as e.g. 10N,7s");
  }
  drive.load = [=, level = drive.mean_load](double t) {
    return level + amplitude * std::sin(2 * std::numbers::pi * t / period);
  };
  drive.mean_load = mean_over(drive.load, duration);
}

/// "20degC..60degC": a ramp over the record; with ",15s" behind it a swing between the two of that period; the mean
/// temperature becomes that of the record.
void vary_temperature(const std::string& text, double duration, Drive& drive) {
  const auto comma = text.find(',');
  const char* example = "20degC..60degC or 20degC..60degC,15s";
  const auto [from, to] = range_ends(text.substr(0, comma), "--temperature", example);
  const double first = stated_value(from, Quantity::temperature, "--temperature");
  const double last = stated_value(to, Quantity::temperature, "--temperature");
  if (comma == std::string::npos) {
    drive.temperature = [=](double t) { return first + (last - first) * std::clamp(t / duration, 0.0, 1.0); };
  } else {
    const double period = stated_value(text.substr(comma + 1), Quantity::time, "--temperature");
    if (!(period > 0))
      throw InputError("the period of --temperature is not positive", "write it as " + std::string(example));
    drive.temperature = [=](double t) {
      return 0.5 * (first + last) - 0.5 * (last - first) * std::cos(2 * std::numbers::pi * t / period);
    };
  }
  drive.mean_temperature = mean_over(drive.temperature, duration);
}

}  // namespace

Drive drive_from(const SimulateRequest& r, const Machine& machine) {
  Drive drive = machine.drive();
  const bool stepped = !r.speed_steps.empty() || !r.pauses.empty();
  if (r.run_up.has_value() + r.reversing.has_value() + stepped > 1)
    throw InputError("--run-up, --reversing and --speed-steps with --pause exclude each other", "give one of them");
  if (r.run_up) drive.speed = run_up_speed(machine.speed, *r.run_up);
  if (r.reversing) drive.speed = reversing_speed(machine.speed, *r.reversing);
  if (stepped) drive.speed = stepped_speed_from(r.speed_steps, r.pauses, machine.speed);
  if (!r.load_swing.empty()) swing_load(r.load_swing, r.options.duration, drive);
  if (!r.temperature.empty()) vary_temperature(r.temperature, r.options.duration, drive);
  return drive;
}

}  // namespace tribofit
