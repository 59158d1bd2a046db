#include <algorithm>

#include "settings.hpp"
#include "tribofit/fit/rate_state.hpp"
#include "tribofit/ingest/channels.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/record_kind.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "typed_values.hpp"

using namespace tribofit;

namespace {

/// "time=t,mu=COF": a comma separates only where a channel and "=" follow, so that columns may hold commas themselves.
void add_pairs(const std::string& text, const std::string& option, std::map<std::string, std::string>& pairs) {
  static const std::vector<std::string> channels = channel_names();
  const bool is_unit = option.ends_with("units");  // of a channel, or of a column by its name in the file
  std::vector<std::string> items;
  for (const std::string& part : split(text, ',')) {
    if (part.find('=') != std::string::npos || items.empty()) {
      items.push_back(part);
    } else {
      items.back() += "," + part;
    }
  }
  for (const std::string& item : items) {
    const std::size_t equals = item.find('=');
    const std::string channel = item.substr(0, equals);
    if (equals == std::string::npos || equals + 1 == item.size()) {
      throw InputError(option + ": '" + item + "' is not " + (is_unit ? "NAME=UNIT" : "CHANNEL=COLUMN"),
                       is_unit ? "write it as v_b=mm/s, or by the column's name as Velocity=mm/s"
                               : "write it as v_b=Velocity or v_b=Velocity:mm/s");
    }
    if (!is_unit && std::find(channels.begin(), channels.end(), channel) == channels.end()) {
      throw InputError(option + ": there is no channel '" + channel + "'",
                       "did you mean '" + nearest_name(channel, channels) + "'? The channels are " + listed(channels));
    }
    if (!pairs.emplace(channel, item.substr(equals + 1)).second) {
      throw InputError(option + ": '" + channel + "' is given twice", "give it once");
    }
  }
}

/// What is typed as --cycles, and as one --exclude.
Selection::Cycles cycles_from(const std::string& text) {
  const auto [first, last] = as_usage([&] { return range_ends(text, "--cycles", "3..40"); });
  const auto number = [&](std::string_view spelled) {
    constexpr std::size_t kMostDigits = 9;
    const std::string end(trimmed(spelled));
    if (end.empty() || end.size() > kMostDigits || end.find_first_not_of("0123456789") != std::string::npos)
      throw UsageError("--cycles: '" + text + "' is not FIRST..LAST, two numbers of cycles as in cycles.csv (from 0)");
    return static_cast<std::size_t>(std::stoul(end));
  };
  const Selection::Cycles cycles = {number(first), number(last)};
  if (cycles.first > cycles.last) number("");
  return cycles;
}

Selection::Stretch stretch_from(const std::string& text) {
  const auto stretch = as_usage([&] {
    const auto [from, to] = range_ends(text, "--exclude", "2.5s..3.1s");
    return Selection::Stretch{stated_value(from, Quantity::time, "--exclude"),
                              stated_value(to, Quantity::time, "--exclude")};
  });
  if (stretch.from < stretch.to) return stretch;
  throw UsageError("--exclude: '" + text + "' does not run from an earlier to a later time");
}

void add_condition(const Command& in, const char* name, Quantity quantity, Condition& condition, const char* help) {
  in.add_number(
      name, positive(quantity),
      [&condition](double value) {
        condition = {value, kTyped};
      },
      help);
}

/// One of several values that are typed one at a time in place of the `list` that holds unless any is; each once.
template <class T, class Make>
Command::Read in_place_of(std::vector<T>& list, Make make) {
  return [&list, make, is_first = true](const std::string& name) mutable {
    if (is_first) list.clear();
    is_first = false;
    const T value = make(name);
    if (std::ranges::find(list, value) == list.end()) list.push_back(value);
  };
}

}  // namespace

void add_input_options(const Command& app, Settings& s) {
  ReadOptions& read = s.identify.read;
  const auto pairs = [](const Command& in, const char* name, auto& out, const char* help) {
    in.add_each(
        name, [name, &out](const std::string& text) { add_pairs(text, name, out); }, help);
  };
  app.keep_typed(s.typed);
  app.add_names("TRACE", s.traces, "Traces (text, MATLAB, UFF, TDMS), or folders of them");
  const Command conditions = app.in(section::kConditions);
  conditions.add_option("--radius", s.radius, "Friction radius, 15mm; one per step as 6mm,9mm,12mm");
  conditions.add_option(
      "--speed", s.speed,
      "Disc speed, 4rpm, or at --radius, 1.1mm/s (else from the file or the stick plateau); of a load point "
      "by time, 0s:2um/s,60s:10um/s");
  add_condition(conditions, "--load", Quantity::force, read.conditions.load, "Normal force, 50N");
  conditions.add_option("--instruments", s.instruments, "Known values of the instruments (JSON), with uncertainties");

  const Command reading = app.in(section::kReading);
  pairs(reading, "--columns", read.columns,
        "Which column is what: time=t,mu=COF,v_b=Velocity:mm/s (see `identify columns`)");
  pairs(reading, "--units", read.units, "Units or sensitivities, of a channel or a column by its name: v_b=mm/s");
  reading.add_number("--rate", positive(Quantity::frequency), read.rate,
                     "Samples per second where there is no time column, 20kHz");
  reading.add_option("--with", read.second_file, "Second file of the same run, from the other instrument");
  pairs(reading, "--with-columns", read.second_columns, "--columns of the second file: v_b=Velocity:mm/s");
  pairs(reading, "--with-units", read.second_units, "--units of the second file");
  reading.add_option("--continue", read.continued_in, "Further file of the same run (repeatable, in order)");
  reading
      .add_read(
          "--kind", [&](const std::string& name) { read.kind = find_record_kind(name); },
          "What was recorded: stick-slip, sliding, points, spring-slider, motion-only, force-only, velocity-steps or "
          "slide-hold-slide (identify help kinds)")
      .one_of(record_kind_names());
  reading.add_flag("--never-sticks", s.never_sticks, "The same as --kind sliding");
  reading.add_number("--stick-below", positive(Quantity::velocity), s.identify.motion.stick.below,
                     "Relative speed below which the block sticks, 0.5mm/s (else from the noise)");
  reading.add_flag("--trim,!--no-trim", s.identify.motion.trim,
                   "Exclude the run-up of the disc (default); --no-trim keeps it");
}

void add_spring_options(const Command& app, Settings& s) {
  SpringDrive& spring = s.identify.read.spring;
  const Command in = app.in(section::kSpring);
  add_condition(in, "--stiffness", Quantity::stiffness, spring.stiffness,
                "Of the spring, where its pull, or the motion of the mass on it, is all that was recorded, 168N/m");
  add_condition(in, "--mass", Quantity::mass, spring.mass,
                "That the spring pulls, 30.7g: its inertia is taken off the pull (else sensor-inertia finds it)");
  add_condition(in, "--damping", Quantity::damping, spring.damping,
                "Beside the spring, 0.67Ns/m, where the motion alone was recorded (x_b, x_d)");
  in.add_choice<std::optional<Counterface>>(
      "--rubs-on", spring.counterface, {{"ground", Counterface::ground}, {"base", Counterface::base}},
      "What the mass rubs on there: ground or base (else as the motion shows it)");
}

void add_driven_options(const Command& app, Settings& s) {
  RateStateOptions& driven = s.identify.rate_state;
  const Command in = app.in(section::kSteps);
  in.add_each("--evolution",
              in_place_of(driven.evolutions, [](const std::string& name) { return *find_state_evolution(name); }),
              "Law of the state, ageing or slip (repeatable; default both)")
      .one_of(state_evolution_names());
  in.add_option("--states", s.states, "State variables, 1 or 2 (default: 2 where they describe the steps better)")
      .range(1, 2);
  in.add_read(
        "--detrend", [&](const std::string& name) { driven.detrend = *find_detrend(name); },
        "Line that is taken off each step, over displacement or time, auto (default: the better one) or none")
      .one_of(detrend_names());
  in.add_number("--reference-speed", positive(Quantity::velocity), driven.reference_speed,
                "v0, 1um/s (default: the speed before the first step)");
  in.add_number("--from", {Quantity::time}, driven.from, "Nothing before this time is used, 120s");
  in.add_number("--to", {Quantity::time}, driven.to, "Nothing after this time is used, 900s");
}

void add_model_options(const Command& app, Settings& s) {
  FitOptions& fit = s.identify.fit;
  const Command in = app.in(section::kFit);
  in.add_each("--law", in_place_of(s.identify.laws, [](const std::string& name) { return make_law(name); }),
              list_of_laws() + " (repeatable; default the first two)")
      .one_of(law_keys());
  in.add_option("--effect", s.effects,
                "Effect to add to every law, KEY or KEY:FORM (repeatable; see `identify effects`)");
  in.add_option("--formula", s.formulas,
                "Effect of your own: 'name = a*exp(-v/w); a=0.02, w=6mm/s', or @FILE with one a line (repeatable)");
  in.add_choice<Loss>("--loss", fit.loss,
                      {{"squares", Loss::squares}, {"huber", Loss::huber}, {"soft-l1", Loss::soft_l1}},
                      "squares (default), huber or soft-l1");
  in.add_option("--starts", fit.starts, "Starting points of the search (default 5)").range(1, 1000);
  in.add_option("--folds", fit.folds, "Blocks of cycles held out in turn (default 5)").range(2, 1000);
  in.add_read(
      "--seed", [&](const std::string& text) { fit.seed = stated_seed(text); },
      "Seed of the random starts (default 1)");
}

void add_parameter_options(const Command& app, Settings& s) {
  const Command in = app.in(section::kFit);
  in.add_option("--start", s.start_values, "Where the search begins: mu_s=0.5,frictional-lag.tau=2ms (repeatable)");
  in.add_option("--bounds", s.bounds, "Bounds of a parameter: alpha=0.01..0.2s/mm; equal ones hold it (repeatable)");
  in.add_read(
      "--cycles", [&](const std::string& text) { s.identify.selection.cycles = cycles_from(text); },
      "Fit these cycles only, FIRST..LAST (numbers as in cycles.csv, from 0)");
  in.add_each(
      "--exclude", [&](const std::string& text) { s.identify.selection.excluded.push_back(stretch_from(text)); },
      "Exclude cycles that reach into this time: 2.5s..3.1s (repeatable)");
}

void add_threads_option(const Command& app, Settings& s) {
  app.add_option("--threads", s.identify.threads, "Threads (default: all; the result is the same)").range(0, 1024);
}

void add_output_options(const Command& app, Settings& s, bool with_tables) {
  const Command in = app.in(section::kOutput);
  in.add_option("--json", s.json, "Write the result as JSON ('-': to standard output, without the table)");
  add_threads_option(in, s);
  in.add_flag("--quiet", s.quiet, "Do not print the table");
  if (with_tables) in.add_option("--csv", s.csv, "Write samples, cycles, curves and errors into this folder");
  add_report_option(app, s);
}

void add_report_option(const Command& app, Settings& s) {
  const Command in = app.in(section::kOutput);
  in.add_option("--report", s.report, "Write a page of charts that opens in any browser (FILE.html)");
  in.add_option("--figures", s.figures, "Write a picture of each chart into this folder, 85 mm wide, for a paper");
  in.add_choice<std::optional<PictureFormat>>(
      "--format", s.picture_format,
      {{"svg", PictureFormat::svg}, {"pdf", PictureFormat::pdf}, {"png", PictureFormat::png}},
      "Of --figures: svg (default), pdf or png");
}

void add_pooling_options(const Command& app, Settings& s) {
  const Command in = app.in(section::kTogether);
  in.add_option("--share", s.share, "Parameter common to all runs: --share alpha (repeatable)");
  in.add_option("--vary", s.vary,
                "Parameter with one value for each value of a condition: --vary mu_s:radius (repeatable)");
}

void add_compare_option(const Command& app, Settings& s) {
  app.in(section::kBatch)
      .add_option("--compare", s.compare,
                  "Compare pooled values with published or earlier ones: a table such as data/published/table4.csv");
}

std::vector<std::string> pooling_arguments(const Settings& s) {
  std::vector<std::string> arguments;
  for (const std::string& text : s.share) arguments.insert(arguments.end(), {"--share", text});
  for (const std::string& text : s.vary) arguments.insert(arguments.end(), {"--vary", text});
  if (!s.compare.empty()) arguments.insert(arguments.end(), {"--compare", s.compare});
  return arguments;
}
