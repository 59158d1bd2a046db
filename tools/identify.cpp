#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "console.hpp"
#include "settings.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/report/csv.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/terminal.hpp"
#include "tribofit/report/whole_file.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

constexpr int kDone = 0, kFailed = 1, kBadInput = 3;

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

void add_fit_options(CLI::App& app, Settings& s) {
  const auto fit = [&](const char* name, auto& value, const char* help) {
    return app.add_option(name, value, help)->group("Law and fit");
  };
  fit("--law", s.laws, "exponential, fractional or coulomb (repeatable; default the first two)")
      ->check(CLI::IsMember({"exponential", "fractional", "coulomb"}))
      ->allow_extra_args(false);
  fit("--effect", s.effects, "Effect to add to every law (repeatable; see `identify effects`)")
      ->allow_extra_args(false);
  fit("--formula", s.formulas, "Effect of your own: 'name = a*exp(-v/w); a=0.02, w=6mm/s' (repeatable)")
      ->allow_extra_args(false);
  fit("--protocol", s.protocol, "joint, published, or both (default)")
      ->check(CLI::IsMember({"both", "joint", "published"}));
  fit("--loss", s.loss, "squares (default), huber or soft-l1")->check(CLI::IsMember({"squares", "huber", "soft-l1"}));
  fit("--starts", s.starts, "Starting points of the search (default 5)")->check(CLI::Range(1, 1000));
  fit("--folds", s.folds, "Blocks of cycles held out in turn (default 5)")->check(CLI::Range(2, 1000));
  app.add_flag("--profile", s.profile, "Profile likelihood intervals as well")->group("Law and fit");
  fit("--seed", s.seed, "Seed of the random starts (default 1)");
}

void add_output_options(CLI::App& app, Settings& s) {
  app.add_option("--json", s.json, "Write the result as JSON ('-': to standard output, without the table)")
      ->group("Output");
  app.add_option("--csv", s.csv, "Write samples, cycles, curves and errors into this folder")->group("Output");
  app.add_option("--threads", s.threads, "Threads (default: all; the result is the same)")
      ->check(CLI::Range(0, 1024))
      ->group("Output");
  app.add_flag("--quiet", s.quiet, "Do not print the table")->group("Output");
}

/// The options as typed that shape the analysis, for the next command.
std::vector<std::string> own_options(const CLI::App& app) {
  std::vector<std::string> arguments;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || option->get_positional()) continue;
    if (name == "--json" || name == "--csv" || name == "--quiet") continue;
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

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored);
}

void check_usage(const Settings& s, const std::vector<std::string>& traces) {
  if (traces.size() > 1) {
    const auto alone = [](bool given, const char* name) {
      if (given) throw CLI::ValidationError(std::string(name) + " goes with one trace at a time");
    };
    alone(!s.json.empty(), "--json");
    alone(!s.csv.empty(), "--csv");
    alone(!s.second_file.empty(), "--with");
    alone(!s.continued_in.empty(), "--continue");
  }
  std::vector<std::string> inputs = traces;
  inputs.insert(inputs.end(), s.continued_in.begin(), s.continued_in.end());
  inputs.push_back(s.second_file);
  inputs.push_back(s.instruments);
  for (const std::string& input : inputs) {
    if (!s.json.empty() && same_file(s.json, input)) throw CLI::ValidationError("--json would overwrite " + input);
    for (const char* name : {"samples.csv", "cycles.csv", "curves.csv", "errors.csv"}) {
      if (!s.csv.empty() && same_file((std::filesystem::path(s.csv) / name).string(), input)) {
        throw CLI::ValidationError("--csv would overwrite " + input + " with its own " + name);
      }
    }
  }
}

/// Both outputs or none: the JSON is on the disc before the CSV gets its names, and gets its own after it.
void write_results(const Settings& s, const Identification& result, const std::vector<std::string>& arguments) {
  std::optional<WholeFile> json;
  if (!s.json.empty()) {
    json.emplace(s.json == "-" ? "/dev/stdout" : s.json);
    json->write(to_json(result, {arguments}));
    json->finish();
  }
  if (!s.csv.empty()) write_csv_folder(s.csv, result);
  if (json) json->commit();
}

int run_one(const Settings& s, const std::string& trace, const IdentifyOptions& options,
            const std::vector<std::string>& arguments) {
  const Identification result = identify(trace, options);
  write_results(s, result, arguments);
  if (!s.quiet && s.json != "-") {
    TerminalOptions terminal;
    terminal.colour = wants_colour();
    terminal.width = terminal_width();
    terminal.instruments_declared = !s.instruments.empty();
    terminal.csv_written = !s.csv.empty();
    terminal.arguments = arguments;
    print(render_terminal(result, terminal));
  }
  const bool fitted = std::any_of(result.fits.begin(), result.fits.end(),
                                  [](const Fit& f) { return f.converged && !f.parameters.empty(); });
  if (result.analysed && fitted) return kDone;
  std::string reason = result.warnings.empty() ? "no fit converged" : result.warnings.back();
  complain(trace + ": the analysis could not be done: " + reason);
  return kFailed;
}

int run_all(const Settings& s, const std::vector<std::string>& traces, const IdentifyOptions& options,
            const std::vector<std::string>& arguments) {
  if (traces.size() == 1) return run_one(s, traces.front(), options, arguments);
  std::size_t unreadable = 0;
  int status = kDone;
  for (std::size_t k = 0; k < traces.size(); ++k) {
    progress("[" + std::to_string(k + 1) + "/" + std::to_string(traces.size()) + "] " + traces[k]);
    if (k > 0 && !s.quiet) print("\n");
    try {
      status = std::max(status, run_one(s, traces[k], options, arguments));
    } catch (const InputError& error) {
      complain(error.what());
      ++unreadable;
    }
  }
  if (unreadable == traces.size()) return kBadInput;
  return unreadable > 0 ? kFailed : status;
}

}  // namespace

void add_identify(CLI::App& app, int& status) {
  const auto settings = std::make_shared<Settings>();
  add_input_options(app, *settings);
  add_fit_options(app, *settings);
  add_output_options(app, *settings);
  app.parse_complete_callback([settings, &app] {  // runs before that of a verb
    const auto verbs = app.get_subcommands();
    if (verbs.empty() || (own_options(app).empty() && settings->traces.empty())) return;
    const std::string verb = verbs.front()->get_name();
    throw CLI::ValidationError("options of `identify " + verb + "` stand behind '" + verb + "'");
  });
  app.callback([settings, &app, &status] {
    if (!app.get_subcommands().empty()) return;
    const Settings& s = *settings;
    const std::vector<std::string> arguments = own_options(app);
    if (s.traces.empty()) throw CLI::ValidationError("no trace given; try `identify --radius 15mm trace.csv`");
    const IdentifyOptions options = options_from(s);
    const std::vector<std::string> traces = traces_from(s.traces);
    check_usage(s, traces);
    status = run_all(s, traces, options, arguments);
  });
}
