#include "options.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>

#include "inputs.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/output_tables.hpp"
#include "tribofit/report/page.hpp"
#include "tribofit/report/pictures.hpp"

using namespace tribofit;

void add_input_options(CLI::App& app, Settings& s) {
  app.add_option("TRACE", s.traces, "Traces (CSV), or folders of them");
  app.add_option("--radius", s.radius, "Friction radius, 15mm; one per step as 6mm,9mm,12mm")->group("Conditions");
  app.add_option("--speed", s.speed, "Disc speed, 4rpm (else from the file or the stick plateau)")->group("Conditions");
  app.add_option("--load", s.load, "Normal force, 50N")->group("Conditions");
  app.add_option("--instruments", s.instruments, "What is known of the instruments (JSON), with uncertainties")
      ->group("Conditions");
  const auto input = [&](const char* name, auto& value, const char* help) {
    return app.add_option(name, value, help)->group("Reading");
  };
  input("--columns", s.columns, "Which column is what: time=t,mu=COF,v_b=Velocity:mm/s")->allow_extra_args(false);
  input("--units", s.units, "Units or sensitivities: v_b=mm/s")->allow_extra_args(false);
  input("--rate", s.rate, "Samples per second where there is no time column, 20kHz");
  input("--with", s.second_file, "Second file of the same run, from the other instrument");
  input("--continue", s.continued_in, "Further file of the same run (repeatable, in order)")->allow_extra_args(false);
  app.add_flag("--trim,!--no-trim", s.trim, "Leave out the run-up of the disc (default); --no-trim keeps it")
      ->group("Reading");
}

void add_model_options(CLI::App& app, Settings& s) {
  const auto fit = [&](const char* name, auto& value, const char* help) {
    return app.add_option(name, value, help)->group("Law and fit");
  };
  fit("--law", s.laws, "exponential, fractional or coulomb (repeatable; default the first two)")
      ->check(CLI::IsMember({"exponential", "fractional", "coulomb"}))
      ->allow_extra_args(false);
  fit("--effect", s.effects, "Effect to add to every law, KEY or KEY:FORM (repeatable; see `identify effects`)")
      ->allow_extra_args(false);
  fit("--formula", s.formulas,
      "Effect of your own: 'name = a*exp(-v/w); a=0.02, w=6mm/s', or @FILE with one a line (repeatable)")
      ->allow_extra_args(false);
  fit("--loss", s.loss, "squares (default), huber or soft-l1")->check(CLI::IsMember({"squares", "huber", "soft-l1"}));
  fit("--starts", s.starts, "Starting points of the search (default 5)")->check(CLI::Range(1, 1000));
  fit("--folds", s.folds, "Blocks of cycles held out in turn (default 5)")->check(CLI::Range(2, 1000));
  fit("--seed", s.seed_text, "Seed of the random starts (default 1)");
}

void add_selection_options(CLI::App& app, Settings& s) {
  app.add_option("--cycles", s.cycles, "Fit these cycles only, FIRST..LAST (numbers as in cycles.csv, from 0)")
      ->group("Law and fit");
  app.add_option("--exclude", s.excluded, "Leave out cycles that reach into this time: 2.5s..3.1s (repeatable)")
      ->allow_extra_args(false)
      ->group("Law and fit");
}

void add_parameter_options(CLI::App& app, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    app.add_option(name, value, help)->allow_extra_args(false)->group("Law and fit");
  };
  add("--start", s.start_values, "Where the search begins: mu_s=0.5,frictional-lag.tau=2ms (repeatable)");
  add("--bounds", s.bounds, "Between which values: alpha=0.01..0.2s/mm; equal ones hold it (repeatable)");
}

void add_result_options(CLI::App& app, Settings& s) {
  app.add_option("--json", s.json, "Write the result as JSON ('-': to standard output, without the table)")
      ->group("Output");
  app.add_option("--threads", s.threads, "Threads (default: all; the result is the same)")
      ->check(CLI::Range(0, 1024))
      ->group("Output");
  app.add_flag("--quiet", s.quiet, "Do not print the table")->group("Output");
}

void add_output_options(CLI::App& app, Settings& s) {
  add_result_options(app, s);
  app.add_option("--csv", s.csv, "Write samples, cycles, curves and errors into this folder")->group("Output");
}

void add_report_option(CLI::App& app, Settings& s) {
  app.add_option("--report", s.report, "Write a page of charts that opens in any browser (FILE.html)")->group("Output");
  app.add_option("--figures", s.figures, "Write a picture of each chart into this folder, 85 mm wide, for a paper")
      ->group("Output");
  app.add_option("--format", s.picture_format, "Of --figures: svg (default), pdf or png")
      ->check(CLI::IsMember({"svg", "pdf", "png"}))
      ->group("Output");
}

Effect effect_named(const std::string& name) {
  try {
    return make_effect(name);
  } catch (const InputError& error) {
    throw CLI::ValidationError(error.what());
  }
}

void refuse_clashes(const std::vector<Effect>& effects) {
  try {
    FrictionModel(BaseLaw::exponential, effects);
  } catch (const InputError& error) {
    throw CLI::ValidationError(error.what());
  }
}

void add_pooling_options(CLI::App& app, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    app.add_option(name, value, help)->allow_extra_args(false)->group("Runs together");
  };
  add("--share", s.share, "Parameter that all runs have in common: --share alpha (repeatable)");
  add("--vary", s.vary, "Parameter with one value for each value of a condition: --vary mu_s:radius (repeatable)");
}

void add_compare_option(CLI::App& app, Settings& s) {
  app.add_option("--compare", s.compare,
                 "Put pooled values beside published or earlier ones: a table such as data/published/table4.csv")
      ->group("Batch");
}

std::vector<std::string> pooling_arguments(const Settings& s) {
  std::vector<std::string> arguments;
  for (const std::string& text : s.share) arguments.insert(arguments.end(), {"--share", text});
  for (const std::string& text : s.vary) arguments.insert(arguments.end(), {"--vary", text});
  if (!s.compare.empty()) arguments.insert(arguments.end(), {"--compare", s.compare});
  return arguments;
}

std::vector<std::string> own_options(const CLI::App& app) {
  std::vector<std::string> arguments;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || option->get_positional()) continue;
    if (name == "--json" || name == "--csv" || name == "--report" || name == "--quiet") continue;
    if (name == "--figures" || name == "--format") continue;
    if (name == "--out" || name == "--shard" || name == "--again" || name == "--pattern") continue;
    const bool of_runs = app.get_option_no_throw("--share") != nullptr;
    if (of_runs && (name == "--share" || name == "--vary")) continue;  // of what is said of all runs together
    if (name == "--compare") continue;
    if (option->get_items_expected_max() == 0) {
      const bool negated = option->results().front() == "false";
      arguments.push_back(negated ? "--no-" + name.substr(2) : name);
      continue;
    }
    for (const std::string& value : option->results()) {
      arguments.push_back(name);
      arguments.push_back(value);
    }
  }
  return arguments;
}

void refuse_empty_values(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const auto& values = option->results();
    if (option->get_items_expected_max() == 0 || std::find(values.begin(), values.end(), "") == values.end()) continue;
    const std::string name = option->get_positional() ? "a trace" : option->get_name();
    throw CLI::ValidationError(name + " is given an empty value; give one or leave it out");
  }
}

void check_seed(Settings& s) {
  if (s.seed_text.empty()) return;
  const char* end = s.seed_text.data() + s.seed_text.size();
  const auto [last, error] = std::from_chars(s.seed_text.data(), end, s.seed);
  if (error == std::errc{} && last == end) return;
  throw CLI::ValidationError("--seed: '" + s.seed_text + "' is not a whole number from 0 to 18446744073709551615");
}

/// Wrong usage: a page that this build cannot write, or one onto another output.
static void check_report(const Settings& s) {
  if (s.report.empty()) return;
  if (!has_report_page()) {
    throw CLI::ValidationError(
        "--report: this build leaves the page out; build where npm is installed (scripts/setup page), or use --json or "
        "--csv");
  }
  if (s.report == s.json || same_file(s.report, s.json)) throw CLI::ValidationError("--report and --json are one file");
}

/// Wrong usage: pictures that cannot be drawn here, or whose folder is another output.
static void check_figures(const Settings& s) {
  if (s.figures.empty()) {
    if (!s.picture_format.empty()) throw CLI::ValidationError("--format goes with --figures FOLDER");
    return;
  }
  if (s.figures == s.json || s.figures == s.report) {
    throw CLI::ValidationError("--figures is a folder; name another than the file of --json or --report");
  }
  if (!can_write_pictures(picture_format(s))) {
    throw CLI::ValidationError("--format " + s.picture_format +
                               ": this build leaves it out; use --format svg, or build where Cairo is installed "
                               "(scripts/setup figures)");
  }
}

void refuse_overwriting(const Settings& s, const std::vector<std::string>& inputs) {
  check_report(s);
  check_figures(s);
  for (const std::string& input : inputs) {
    if (!s.report.empty() && same_file(s.report, input)) {
      throw CLI::ValidationError("--report would overwrite " + input);
    }
    if (!s.json.empty() && same_file(s.json, input)) throw CLI::ValidationError("--json would overwrite " + input);
    if (s.csv.empty()) continue;
    const std::filesystem::path own_folder = std::filesystem::path(s.csv) / std::filesystem::path(input).stem();
    for (const OwnFile& file : output_tables) {
      if (same_file((s.csv / std::filesystem::path(file.name)).string(), input) ||
          same_file((own_folder / file.name).string(), input)) {
        throw CLI::ValidationError("--csv would overwrite " + input + " with its own " + std::string(file.name));
      }
    }
  }
}
