#include "options.hpp"

#include "parameter_options.hpp"
#include "stated_value.hpp"
#include "tribofit/fit/rate_state.hpp"
#include "tribofit/ingest/record_kind.hpp"

void add_input_options(const Command& app, Settings& s) {
  app.add_option("TRACE", s.traces, "Traces (text, MATLAB, UFF, TDMS), or folders of them");
  app.add_option("--radius", s.radius, "Friction radius, 15mm; one per step as 6mm,9mm,12mm")
      .group(section::kConditions);
  app.add_option("--speed", s.speed,
                 "Disc speed, 4rpm, or at --radius, 1.1mm/s (else from the file or the stick plateau); of a load point "
                 "by time, 0s:2um/s,60s:10um/s")
      .group(section::kConditions);
  app.add_option("--load", s.load, "Normal force, 50N").group(section::kConditions);
  app.add_option("--instruments", s.instruments, "Known values of the instruments (JSON), with uncertainties")
      .group(section::kConditions);
  const auto input = [&](const char* name, auto& value, const char* help) {
    return app.add_option(name, value, help).group(section::kReading);
  };
  input("--columns", s.columns, "Which column is what: time=t,mu=COF,v_b=Velocity:mm/s (see `identify columns`)")
      .one_value_each();
  input("--units", s.units, "Units or sensitivities, of a channel or a column by its name: v_b=mm/s").one_value_each();
  input("--rate", s.rate, "Samples per second where there is no time column, 20kHz");
  input("--with", s.second_file, "Second file of the same run, from the other instrument");
  input("--with-columns", s.second_columns, "--columns of the second file: v_b=Velocity:mm/s").one_value_each();
  input("--with-units", s.second_units, "--units of the second file").one_value_each();
  input("--continue", s.continued_in, "Further file of the same run (repeatable, in order)").one_value_each();

  input("--kind", s.kind,
        "What was recorded: stick-slip, sliding, points, spring-slider, motion-only, force-only, velocity-steps or "
        "slide-hold-slide (identify help kinds)")
      .one_of(tribofit::record_kind_names());
  app.add_flag("--never-sticks", s.never_sticks, "The same as --kind sliding").group(section::kReading);
  input("--stick-below", s.stick_below, "Relative speed below which the block sticks, 0.5mm/s (else from the noise)");
  app.add_flag("--trim,!--no-trim", s.trim, "Exclude the run-up of the disc (default); --no-trim keeps it")
      .group(section::kReading);
}

void add_spring_options(const Command& app, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return app.add_option(name, value, help).group("Mass on a spring");
  };
  add("--stiffness", s.stiffness,
      "Of the spring, where its pull, or the motion of the mass on it, is all that was recorded, 168N/m");
  add("--mass", s.mass,
      "That the spring pulls, 30.7g: its inertia is taken off the pull (else sensor-inertia finds it)");
  add("--damping", s.damping, "Beside the spring, 0.67Ns/m, where the motion alone was recorded (x_b, x_d)");
  add("--rubs-on", s.rubs_on, "What the mass rubs on there: ground or base (else as the motion shows it)")
      .one_of({"ground", "base"});
}

void add_driven_options(const Command& app, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return app.add_option(name, value, help).group("Velocity steps and holds");
  };
  add("--evolution", s.evolutions, "Law of the state, ageing or slip (repeatable; default both)")
      .one_of(tribofit::state_evolution_names())
      .one_value_each();
  add("--states", s.states, "State variables, 1 or 2 (default: 2 where they describe the steps better)").range(1, 2);
  add("--detrend", s.detrend,
      "Line that is taken off each step, over displacement or time, auto (default: the better one) or none")
      .one_of(tribofit::detrend_names());
  add("--reference-speed", s.reference_speed, "v0, 1um/s (default: the speed before the first step)");
  add("--from", s.from, "Nothing before this time is used, 120s");
  add("--to", s.to, "Nothing after this time is used, 900s");
}

void add_model_options(const Command& app, Settings& s) {
  const auto fit = [&](const char* name, auto& value, const std::string& help) {
    return app.add_option(name, value, help).group("Law and fit");
  };
  fit("--law", s.laws, list_of_laws() + " (repeatable; default the first two)")
      .one_of(tribofit::law_keys())
      .one_value_each();
  fit("--effect", s.effects, "Effect to add to every law, KEY or KEY:FORM (repeatable; see `identify effects`)")
      .one_value_each();
  fit("--formula", s.formulas,
      "Effect of your own: 'name = a*exp(-v/w); a=0.02, w=6mm/s', or @FILE with one a line (repeatable)")
      .one_value_each();
  fit("--loss", s.loss, "squares (default), huber or soft-l1").one_of({"squares", "huber", "soft-l1"});
  fit("--starts", s.starts, "Starting points of the search (default 5)").range(1, 1000);
  fit("--folds", s.folds, "Blocks of cycles held out in turn (default 5)").range(2, 1000);
  fit("--seed", s.seed_text, "Seed of the random starts (default 1)");
}

void add_selection_options(const Command& app, Settings& s) {
  app.add_option("--cycles", s.cycles, "Fit these cycles only, FIRST..LAST (numbers as in cycles.csv, from 0)")
      .group("Law and fit");
  app.add_option("--exclude", s.excluded, "Exclude cycles that reach into this time: 2.5s..3.1s (repeatable)")
      .one_value_each()
      .group("Law and fit");
}

void add_parameter_options(const Command& app, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    app.add_option(name, value, help).one_value_each().group("Law and fit");
  };
  add("--start", s.start_values, "Where the search begins: mu_s=0.5,frictional-lag.tau=2ms (repeatable)");
  add("--bounds", s.bounds, "Bounds of a parameter: alpha=0.01..0.2s/mm; equal ones hold it (repeatable)");
}

void add_result_options(const Command& app, Settings& s) {
  app.add_option("--json", s.json, "Write the result as JSON ('-': to standard output, without the table)")
      .group(section::kOutput);
  app.add_option("--threads", s.threads, "Threads (default: all; the result is the same)")
      .range(0, 1024)
      .group(section::kOutput);
  app.add_flag("--quiet", s.quiet, "Do not print the table").group(section::kOutput);
}

void add_output_options(const Command& app, Settings& s) {
  add_result_options(app, s);
  app.add_option("--csv", s.csv, "Write samples, cycles, curves and errors into this folder").group(section::kOutput);
}

void add_report_option(const Command& app, Settings& s) {
  app.add_option("--report", s.report, "Write a page of charts that opens in any browser (FILE.html)")
      .group(section::kOutput);
  app.add_option("--figures", s.figures, "Write a picture of each chart into this folder, 85 mm wide, for a paper")
      .group(section::kOutput);
  app.add_option("--format", s.picture_format, "Of --figures: svg (default), pdf or png")
      .one_of({"svg", "pdf", "png"})
      .group(section::kOutput);
}

void add_pooling_options(const Command& app, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    app.add_option(name, value, help).one_value_each().group(section::kTogether);
  };
  add("--share", s.share, "Parameter common to all runs: --share alpha (repeatable)");
  add("--vary", s.vary, "Parameter with one value for each value of a condition: --vary mu_s:radius (repeatable)");
}

void add_compare_option(const Command& app, Settings& s) {
  app.add_option("--compare", s.compare,
                 "Compare pooled values with published or earlier ones: a table such as data/published/table4.csv")
      .group(section::kBatch);
}

std::vector<std::string> pooling_arguments(const Settings& s) {
  std::vector<std::string> arguments;
  for (const std::string& text : s.share) arguments.insert(arguments.end(), {"--share", text});
  for (const std::string& text : s.vary) arguments.insert(arguments.end(), {"--vary", text});
  if (!s.compare.empty()) arguments.insert(arguments.end(), {"--compare", s.compare});
  return arguments;
}

void check_seed(Settings& s) {
  if (s.seed_text.empty()) return;
  s.seed = stated_seed(s.seed_text);
}
