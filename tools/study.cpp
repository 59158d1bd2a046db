#include <fmt/format.h>

#include <algorithm>

#include "machine_options.hpp"
#include "map_file.hpp"
#include "studied_machine.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/report/study.hpp"
#include "typed_values.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

/// What is typed behind `identify study KIND`.
struct StudyRequest {
  Settings settings;  // of the trace, and the outputs
  MachineRequest machine;
  SettleOptions settle;
  std::string range, at;    // speeds
  std::size_t points = 40;  // of a sweep
  std::size_t cycles = 6;   // of a portrait
  std::size_t harmonics = 20;
  std::vector<std::string> vary;
  double factor = 2;
  std::string x, y, measure = "peak-to-peak";
  bool again = false;
};

void set_sharpness(double sharpness, SettleOptions& settle) {
  constexpr double kMost = 1e9;  // s/m: beyond it creep in stick is lost in rounding
  if (sharpness > kMost)
    throw InputError("--sharpness is more than 1e6 s/mm", "leave it out: stick and slip are then located as events");
  settle.sharpness = sharpness;
}

/// A speed of the disc as omega r [m/s], from "6mm/s" or "4rpm".
double velocity_from(const std::string& text, const Machine& machine, const std::string& option) {
  const double velocity = machine.radius * disc_speed_from(text, machine.radius, option);
  if (!(velocity > 0))
    throw InputError(option + ": '" + text + "' is not greater than zero", "give e.g. 6mm/s or 4rpm");
  return velocity;
}

/// "1mm/s..20mm/s" as `count` speeds omega r [m/s].
std::vector<double> velocities_from(const std::string& text, std::size_t count, const Machine& machine) {
  const auto [lower, upper] = range_ends(text, "--range", "1mm/s..20mm/s or 1rpm..8rpm");
  const double low = velocity_from(lower, machine, "--range"), high = velocity_from(upper, machine, "--range");
  if (!(high > low)) throw InputError("--range: '" + text + "' does not rise", "write the lower speed first");
  return evenly_spaced(low, high, count);
}

/// "stiffness=8N/mm..20N/mm:100"; what is left out is half to twice the machine's own value, and 40 values.
MapAxis axis_from(const std::string& text, const Machine& machine, const std::string& option) {
  constexpr std::size_t kMost = 2000;
  const auto equals = text.find('=');
  MapAxis axis;
  axis.variable = variable_named(machine, text.substr(0, equals));
  const double own = value_of(machine, axis.variable.name);
  double low = 0.5 * own, high = 2 * own;
  std::size_t count = 40;
  const auto bad = [&](const std::string& what) {
    return InputError(option + " '" + text + "': " + what, "write it as stiffness=8N/mm..20N/mm:100");
  };
  if (equals != std::string::npos) {
    std::string range = text.substr(equals + 1);
    if (const auto colon = range.find(':'); colon != std::string::npos) {
      const std::string number = range.substr(colon + 1);
      range.resize(colon);
      if (number.empty() || number.size() > 5 || number.find_first_not_of("0123456789") != std::string::npos) {
        throw bad("'" + number + "' is not a number of values");
      }
      count = std::stoul(number);
    }
    const auto [lower, upper] = range_ends(range, option, "stiffness=8N/mm..20N/mm:100");
    low = stated_value(lower, axis.variable.quantity, option);
    high = stated_value(upper, axis.variable.quantity, option);
  } else if (axis.variable.name == "ratio") {
    high = std::min(high, 1.0);
  }
  if (count < 2 || count > kMost) throw bad(fmt::format("{} values; 2 to {} are possible", count, kMost));
  if (!(high > low)) throw bad("the range does not rise");
  axis.values = evenly_spaced(low, high, count);
  return axis;
}

/// What every kind begins with.
struct Begun {
  StudiedMachine machine;
  JsonOptions json;
  ReportOptions report;
};

Begun begin(const StudyRequest& r, const Command& kind) {
  refuse_overwriting(r.settings, input_files(r.settings));
  Begun out;
  out.json.arguments = kind.own_options();
  out.machine = studied_machine(r.settings, r.machine, kind);
  out.machine.sharpness = r.settle.sharpness;
  out.report = terminal_options(r.settings, out.json.arguments);
  out.report.inputs = r.settings.traces;
  out.report.shared_arguments = shared_arguments(kind);
  return out;
}

template <class Study>
void deliver(const StudyRequest& r, const Begun& b, const Study& study) {
  deliver(r.settings,
          {[&] { return report_of(b.machine, study, b.report); }, [&] { return study_json(b.machine, study, b.json); },
           [&](const std::string& folder) { write_study(folder, study); }});
}

void run_speed(const StudyRequest& r, const Begun& b) {
  const Machine& machine = b.machine.machine;
  SpeedStudyOptions options;
  options.settle = r.settle;
  options.covariance = b.machine.covariance;
  options.threads = r.settings.identify.threads;
  options.points = r.points;
  if (!r.range.empty()) options.velocity = velocities_from(r.range, r.points, machine);
  ProgressLine line;
  options.progress = [&line](double part) { line.show("motion over speed", part); };
  const SpeedStudy study = study_speed(machine, options);
  line.end();
  deliver(r, b, study);
}

void run_phase(const StudyRequest& r, const Begun& b) {
  const Machine& machine = b.machine.machine;
  std::vector<double> velocities;
  if (!r.range.empty()) velocities = velocities_from(r.range, r.points, machine);
  for (const std::string& text : r.at.empty() ? std::vector<std::string>() : split(r.at, ','))
    velocities.push_back(velocity_from(text, machine, "--at"));
  if (velocities.empty()) velocities = {machine.disc_velocity()};
  PortraitOptions options;
  options.cycles = r.cycles;
  options.settle = r.settle;
  deliver(r, b, study_phase(machine, velocities, options));
}

void run_response(const StudyRequest& r, const Begun& b) {
  deliver(r, b, study_response(b.machine.machine, r.harmonics, r.settle));
}

void run_sensitivity(const StudyRequest& r, const Begun& b) {
  SensitivityOptions options;
  options.variables = r.vary;
  options.factor = r.factor;
  options.count = r.points;
  options.settle = r.settle;
  options.threads = r.settings.identify.threads;
  ProgressLine line;
  options.progress = [&line](double part) { line.show("sweeps", part); };
  const std::vector<Sensitivity> study = study_sensitivity(b.machine.machine, options);
  line.end();
  deliver(r, b, study);
}

void run_map(const StudyRequest& r, const Begun& b) {
  const Machine& machine = b.machine.machine;
  const MeasureInfo& measure = measure_named(r.measure);
  const MapRequest request{machine, axis_from(r.x, machine, "--x"), axis_from(r.y, machine, "--y"), r.settle};
  check_map(request);
  MapFile file(r.settings.csv, request, r.again);
  ProgressLine progress;
  std::size_t known = file.known_count();
  const double all = static_cast<double>(request.y.values.size());
  compute_map(request, file.done(), r.settings.identify.threads,
              [&](std::size_t row, const std::vector<MapCell>& cells) {
                file.add(row, cells);
                progress.show("map", static_cast<double>(++known) / all);
                return true;
              });
  file.finish();
  progress.end();
  deliver(r.settings, {[&] { return report_of(b.machine, request, file.rows(), measure, b.report); },
                       [&] { return map_json(b.machine, request, file.rows(), b.json); }});
}

using RunStudy = void (*)(const StudyRequest&, const Begun&);

Command add_kind(const Command& study, const char* name, const char* help, const std::shared_ptr<StudyRequest>& r,
                 RunStudy run) {
  const Command kind = study.add_verb(name, help);
  kind.narrow_help();
  add_input_options(kind, r->settings);
  add_machine_numbers(kind, r->machine);
  kind.add_number(
      "--sharpness", positive(Quantity::inverse_velocity),
      [r](double sharpness) { set_sharpness(sharpness, r->settle); },
      "Smooth the law by an arctangent, e.g. 500s/mm (default: stick and slip as events)");
  kind.add_choice<StartFrom>("--from", r->settle.start,
                             {{"stick", StartFrom::stick}, {"rest", StartFrom::rest}, {"sliding", StartFrom::sliding}},
                             "Begin in stick (default), at rest, or in sliding");
  add_output_options(kind, r->settings, true);
  kind.option("--csv").describe("Write the tables of the study into this folder");
  kind.option("TRACE").describe("One trace (CSV) from which the machine is identified");
  kind.on_run([r, kind, run] { run(*r, begin(*r, kind)); });
  return kind;
}

}  // namespace

void add_study(const Command& app) {
  const Command study = app.add_verb(
      "study", "What a machine does: critical speed, portraits, sensitivities, maps",
      "A machine is a rig with its friction: identified from a trace, or given, or both (given values replace those\n"
      "identified). Without either it is the published test at the radius given. Beside a trace --radius, --speed and\n"
      "--load describe the record; --range and --at study other speeds.\n\n"
      "Examples:\n"
      "  identify study speed --radius 15mm --load 50N trace.csv\n"
      "  identify study speed --radius 15mm --load 50N --damping-ratio 0.05 trace.csv  # what would more damping do?\n"
      "  identify study phase --radius 15mm --at 2mm/s,6mm/s,20mm/s --csv portraits/\n"
      "  identify study map --radius 15mm --x stiffness=8N/mm..20N/mm:100 --y mass=0.5kg..1.5kg:100 --csv map/");
  study.requires_kind("name what to study: speed, phase, response, sensitivity or map");
  const auto kind = [&](const char* name, const char* help, const std::shared_ptr<StudyRequest>& r, RunStudy run) {
    return add_kind(study, name, help, r, run).in(section::kStudy);
  };

  auto r = std::make_shared<StudyRequest>();
  Command in = kind("speed", "Measures over speed, and the critical speed both ways", r, run_speed);
  in.add_option("--range", r->range, "Speeds, 1mm/s..20mm/s or 1rpm..8rpm");
  in.add_option("--points", r->points, "Number of speeds (default 40)").range(2, 10000);

  r = std::make_shared<StudyRequest>();
  in = kind("phase", "Phase portraits", r, run_phase);
  in.add_option("--at", r->at, "Speeds, 2mm/s,6mm/s,20mm/s (default: the machine's own)");
  in.add_option("--range", r->range, "Speeds, 1mm/s..20mm/s");
  in.add_option("--points", r->points, "Number of speeds in --range").range(2, 1000);
  in.add_option("--cycles", r->cycles, "Cycles drawn from the start (default 6)").range(1, 10000);

  r = std::make_shared<StudyRequest>();
  in = kind("response", "A(omega), and spectra of force and displacement", r, run_response);
  in.add_option("--harmonics", r->harmonics, "Lines of the spectra (default 20)").range(1, 1000);

  r = std::make_shared<StudyRequest>();
  r->points = 21;
  in = kind("sensitivity", "Which number matters: sweeps and ranked elasticities", r, run_sensitivity);
  in.add_option("--vary", r->vary, "Number to vary (repeatable; default: all that matter)");
  in.add_option("--factor", r->factor, "From 1/factor to factor times its value (default 2)").range(1.0001, 1e6);
  in.add_option("--points", r->points, "Values of a sweep (default 21)").range(2, 10000);

  r = std::make_shared<StudyRequest>();
  in = kind("map", "Measures over any two numbers; --csv FOLDER makes it resumable", r, run_map);
  in.add_option("--x", r->x, "Across: NAME, or NAME=LOW..HIGH:COUNT as stiffness=8N/mm..20N/mm:100").required();
  in.add_option("--y", r->y, "Down: the same").required();
  in.add_option("--measure", r->measure, "The one printed (all are written): peak-to-peak (default), stick-time, ...");
  in.in(section::kOutput).add_flag("--again", r->again, "Compute rows that are known already, too");
}
