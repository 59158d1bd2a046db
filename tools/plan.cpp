#include "tribofit/study/plan.hpp"

#include <algorithm>
#include <cmath>

#include "machine_options.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/study/sweep.hpp"
#include "typed_values.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

/// What can be done at the rig, as typed.
struct MeansOptions {
  Means means;         ///< without the speeds
  std::string speeds;  ///< which may be at the radius of the record
};

constexpr std::size_t kLevelsOfRange = 4;  // 1rpm..8rpm: 1, 2, 4 and 8 rpm

/// A number as a person sets it: of two digits, within 5 %.
double two_digits(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  return std::round(x / unit) * unit;
}

/// "1rpm..8rpm" as a few values in equal ratios, those between the ends of two digits in the unit of the range where
/// that keeps them apart, or "9mm,12mm" as they are.
template <class ValueOf>
std::vector<double> values_of(const std::string& text, const std::string& option, ValueOf&& value) {
  if (text.find("..") == std::string::npos) {
    std::vector<double> values;
    for (const std::string& part : split(text, ',')) values.push_back(value(part));
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
  }
  const auto [lower, upper] = range_ends(text, option, "1rpm..8rpm, or as a list 1rpm,2rpm,8rpm");
  const double low = value(lower), high = value(upper);
  if (!(high > low)) throw InputError(option + ": '" + text + "' does not rise", "write the lower value first");
  std::vector<double> levels = evenly_spaced(low, high, kLevelsOfRange, true);
  const double unit = low / std::stod(lower);
  for (std::size_t k = 1; high > 1.5 * low && k + 1 < levels.size(); ++k)
    levels[k] = unit * two_digits(levels[k] / unit);
  return levels;
}

/// Of the disc, or at the radius.
double disc_speed(const std::string& text, const std::string& radius) {
  const std::string option = "--speeds";
  if (!is_linear_speed(text)) return positive_value(text, Quantity::angular_velocity, option);
  if (radius.empty())
    throw InputError(option + ": '" + text + "' is a speed at the radius, which is not known",
                     "give --radius 15mm, or speeds in rpm");
  return positive_value(text, Quantity::velocity, option) / stated_value(radius, Quantity::length, "--radius");
}

void add_means_options(const Command& app, MeansOptions& m) {
  const Command in = app.in(section::kMeans);
  const auto add = [&](const char* name, Quantity quantity, std::vector<double>& values, const char* help) {
    const auto read = [name, quantity, &values](const std::string& text) {
      values = values_of(text, name, [&](const std::string& part) { return positive_value(part, quantity, name); });
    };
    in.add_read(name, read, help);
  };
  Means& means = m.means;
  in.add_option("--speeds", m.speeds, "Disc speeds, a range 1rpm..8rpm or a list 1rpm,8rpm");
  add("--radii", Quantity::length, means.radii, "Friction radii, 9mm,12mm,18mm");
  add("--loads", Quantity::force, means.loads, "Normal forces, 20N..100N");
  add("--springs", Quantity::stiffness, means.springs, "Other springs, by their stiffness, 5N/mm,20N/mm");
  add("--rates", Quantity::frequency, means.rates, "Rates of sampling, 50kHz");
  const auto read_minutes = [&](const std::string& text) {
    means.longest = positive_value(is_bare_number(text) ? text + "min" : text, Quantity::time, "--minutes");
  };
  in.add_read("--minutes", read_minutes, "Longest time of all runs of an experiment together (default 10)");
  in.add_read(
      "--pauses",
      [&](const std::string& text) {
        for (const std::string& part : split(text, ','))
          means.longest_pause = std::max(means.longest_pause, positive_value(part, Quantity::time, "--pauses"));
      },
      "The disc can be stopped between slides, for up to 100s");
  in.add_read(
      "--mass-below",
      [&](const std::string& text) { means.mass_below = positive_value(text, Quantity::mass, "--mass-below"); },
      "Mass that can be added below the force sensor, 100g");
  in.add_flag("--reversing", means.reversing, "The disc can turn forth and back");
  in.add_flag("--tap", means.tap, "The block can be tapped, and both channels recorded");
  in.add_flag("--lift", means.lift, "The block can be lifted off the disc, and the force sensor read");
  in.add_flag("--accelerometer", means.accelerometer, "There is an accelerometer for the block");
}

/// In SI and checked. radius: that of the record as typed, for speeds such as 6mm/s; may be empty.
Means means_from(const MeansOptions& m, const std::string& radius) {
  Means means = m.means;
  if (!m.speeds.empty()) {
    means.speeds = values_of(m.speeds, "--speeds", [&](const std::string& part) { return disc_speed(part, radius); });
  }
  return means;
}

ExitStatus run_plan(const Settings& s, const MeansOptions& typed, const std::vector<std::string>& arguments) {
  const IdentifyOptions options = options_from(s);
  PlanOptions more;
  more.means = means_from(typed, s.radius);
  LeftOut left_out;
  Split split = usable_runs(s, options, "plan", left_out);
  if (split.diagnosed.empty()) return left_out.any_read ? ExitStatus::failed : ExitStatus::bad_input;
  // What repeats a run is evidence here: nothing is held back.
  split.diagnosed.insert(split.diagnosed.end(), split.kept.begin(), split.kept.end());
  split.kept.clear();
  split.notes.clear();
  more.threads = options.threads;
  more.seed = options.fit.seed;
  more.instruments = options.instruments;
  more.fit = options.fit;
  more.laws = options.laws;
  more.until = end_of(s.time_limit);
  DiagnosedTraces diagnosed;
  RunPlan plan;
  {
    ProgressLine line;
    DiagnoseOptions diagnosis;
    diagnosis.diagnosis.threads = options.threads;
    diagnosis.diagnosis.until = more.until;
    diagnosis.diagnosis.progress = [&line](std::string_view what, double part) { line.show(what, 0.3 * part); };
    more.progress = [&line](std::string_view what, double part) { line.show(what, 0.3 + 0.7 * part); };
    diagnosed = diagnose(traces_of(split.diagnosed), options, diagnosis);
    if (diagnosed.analysed) plan = plan_runs(diagnosed, more);
  }
  add_remarks(split, diagnosed);
  const TerminalOptions shown = shown_as(split, s, arguments);
  if (!diagnosed.analysed) plan.reason = reason_of(diagnosed);
  deliver(s, {[&] { return plan_report(diagnosed, plan, shown); },
              [&] { return plan_json(diagnosed, plan, {arguments}); }});
  if (plan.answered()) return left_out.reasons.empty() ? ExitStatus::done : ExitStatus::failed;
  print_error("nothing could be planned: " + plan.reason);
  return ExitStatus::failed;
}

}  // namespace

void add_plan(const Command& app) {
  const Command verb = app.add_verb(
      "plan", "The run that would settle what a diagnosis leaves open",
      "Diagnoses the traces and plans the run that settles what they leave open: effects that are not\n"
      "distinguishable, or one that is possible. Only what can be done is planned with; where nothing is said,\n"
      "a quarter to four times the disc speed, and a longer record (see `identify help plan`).\n"
      "With the new run beside the traces it goes on from there.\n\n"
      "Examples:\n"
      "  identify plan --radius 15mm --speeds 1rpm..8rpm --minutes 10 trace.csv\n"
      "  identify plan --radius 15mm --speeds 1rpm..8rpm --radii 9mm,18mm --loads 20N..100N --tap trace.csv\n"
      "  identify plan --speeds 1rpm..8rpm earlier/ new.csv");
  const auto settings = std::make_shared<Settings>();
  const auto means = std::make_shared<MeansOptions>();
  add_input_options(verb, *settings);
  add_means_options(verb, *means);
  verb.in(section::kMeans)
      .add_option("--time-limit", settings->time_limit,
                  "Simulate no more runs after this time (10s, 2min) and report what is known");
  add_model_options(verb, *settings);
  add_parameter_options(verb, *settings);
  add_output_options(verb, *settings);
  verb.on_run([settings, means, verb] { return run_plan(*settings, *means, verb.own_options()); });
}
