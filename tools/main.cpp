#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <csignal>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "console.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/report/whole_file.hpp"
#include "tribofit/version.hpp"
#include "verbs.hpp"

namespace {

constexpr int kFailed = 1, kWrongUsage = 2, kBadInput = 3;

constexpr const char* kDescription =
    "Identifies the friction law of a tribometer trace (CSV): stick-slip measures, parameters with\n"
    "uncertainties, errors against the noise floor.";

constexpr const char* kFooter =
    "Units are accepted in any usual form: 15mm, 0.015 m, 4rpm, 0.419rad/s, 50N, 20kHz.\n"
    "What the command line says beats a folder's manifest.csv, which beats the file.\n\n"
    "Examples:\n"
    "  identify --radius 15mm trace.csv\n"
    "  identify --radius 15mm --effect viscous --csv out/ trace.csv\n"
    "  identify diagnose --radius 15mm trace.csv\n"
    "  identify rig --radius 15mm --load 50N trace.csv    mass, damping and stiffness behind it\n"
    "  identify twin --radius 15mm --load 50N trace.csv   the motion that law and rig predict\n"
    "  identify runs/                     every trace of a folder, results in runs-results/\n"
    "  identify --radius 15mm --columns time=t,mu=COF,v_b=Velocity:mm/s trace.csv\n\n"
    "Exit status: 0 done; 1 data read but no analysis possible, or one of several traces failed;\n"
    "2 wrong usage; 3 unreadable or invalid input.";

/// The option meant by a misspelt one, for the message.
std::string nearest_option(const CLI::App& app, const std::string& message) {
  const std::size_t at = message.find("--");
  if (at == std::string::npos) return "";
  const std::string word = message.substr(at, message.find_first_of("= ", at) - at);
  std::vector<std::string> known;
  for (const CLI::App* part : {&app, app.get_subcommands().empty() ? &app : app.get_subcommands().front()}) {
    for (const CLI::Option* option : part->get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
  }
  const std::string nearest = tribofit::nearest_name(word, known);
  constexpr std::size_t kAlike = 4;  // two dashes and two letters: anything less is not a misspelling
  return nearest.substr(0, kAlike) == word.substr(0, kAlike) ? "; did you mean " + nearest + "?" : "";
}

int usage_error(const CLI::App& app, const CLI::ParseError& error) {
  std::string text = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) text += nearest_option(app, text);
  const auto verbs = app.get_subcommands();
  print_error(text + "\n`identify " + (verbs.empty() ? "" : verbs.front()->get_name() + " ") +
              "--help` lists the options");
  return kWrongUsage;
}

int run(int argc, char** argv) {
  CLI::App app(kDescription, "identify");
  app.footer(kFooter);
  app.get_formatter()->column_width(30);
  app.set_version_flag("--version", "identify " + std::string(tribofit::version), "Print the version and leave");
  int status = 0;
  add_identify(app, status);
  add_manifest(app, status);
  add_merge(app, status);
  add_diagnose(app, status);
  add_explore(app, status);
  add_rig(app, status);
  add_twin(app, status);
  add_effects(app, status);
  add_simulate(app, status);
  add_study(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help and version
    return usage_error(app, error);
  }
  return status;
}

/// Leaves nothing half-written behind, then ends as the signal would have.
void leave(int signal) {
  tribofit::remove_unfinished_files();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // `identify ... | head` is no accident
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (std::signal(signal, leave) == SIG_IGN) std::signal(signal, SIG_IGN);  // as under nohup
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is reported like a full disc
  try {
    return run(argc, argv);
  } catch (const tribofit::InputError& error) {
    print_error(error.what());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    print_error("not enough memory for this trace; run it on a larger machine or give a part of it");
    return kFailed;
  } catch (const std::exception& error) {
    print_error(error.what());
    return kFailed;
  }
}
