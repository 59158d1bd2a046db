#include <csignal>
#include <exception>
#include <new>

#include "memory.hpp"
#include "tribofit/output/whole_file.hpp"
#include "tribofit/version.hpp"
#include "verbs.hpp"

namespace {

constexpr const char* kDescription =
    "Identifies the friction law of a tribometer trace: stick-slip measures, parameters with\n"
    "uncertainties, errors against the noise floor.";

constexpr const char* kProgramFooter =
    "Units are accepted in any usual form: 15mm, 0.015 m, 4rpm, 0.419rad/s, 50N, 20kHz.\n"
    "The command line overrides a folder's manifest.csv, which overrides the file.\n\n"
    "Examples:\n"
    "  identify --radius 15mm trace.csv\n"
    "  identify --radius 15mm --effect viscous --csv out/ trace.csv\n"
    "  identify diagnose --radius 15mm trace.csv\n"
    "  identify plan --radius 15mm --speeds 1rpm..8rpm trace.csv   the run that settles what is open\n"
    "  identify rig --radius 15mm --load 50N trace.csv    mass, damping and stiffness behind it\n"
    "  identify twin --radius 15mm --load 50N trace.csv   the motion that law and rig predict\n"
    "  identify runs/                     every trace of a folder, results in runs-results/\n"
    "  identify columns export.mat        what a file holds, and the --columns line for it\n"
    "  identify --radius 15mm --columns time=t,mu=COF,v_b=Velocity:mm/s trace.csv\n\n"
    "Exit status: 0 done; 1 data read but no analysis possible, or one of several traces failed;\n"
    "2 wrong usage; 3 unreadable or invalid input.";

ExitStatus run(int argc, char** argv) {
  const Program program{"identify", kDescription, kProgramFooter, "identify " + std::string(tribofit::version)};
  return run_program(program, argc, argv, [](const Command& identify) {
    add_identify(identify);
    add_columns(identify);
    add_manifest(identify);
    add_merge(identify);
    add_diagnose(identify);
    add_plan(identify);
    add_explore(identify);
    add_rig(identify);
    add_twin(identify);
    add_effects(identify);
    add_cite(identify);
    add_simulate(identify);
    add_study(identify);
    add_help(identify);
    add_completion(identify);
  });
}

ExitStatus run_and_report(int argc, char** argv) {
  try {
    tribofit::name_settings([](std::string_view key) { return "--" + std::string(key); });
    return run(argc, argv);
  } catch (const tribofit::InputError& error) {
    print_error(error.what());
    return ExitStatus::bad_input;
  } catch (const tribofit::WriteError& error) {
    print_error(error.what());
    return ExitStatus::bad_input;
  } catch (const std::bad_alloc&) {
    print_error("not enough memory for this trace; use a larger machine or a part of the trace");
  } catch (const std::exception& error) {
    print_error(error.what());
  }
  return ExitStatus::failed;
}

/// Leaves nothing half-written behind, then ends as the signal would have.
void leave(int signal) {
  tribofit::end_writing();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

int main(int argc, char** argv) {
  set_memory(Memory::kept);
  std::signal(SIGPIPE, SIG_IGN);  // `identify ... | head` is no accident
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (std::signal(signal, leave) == SIG_IGN) std::signal(signal, SIG_IGN);  // as under nohup
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is reported like a full disc
  return static_cast<int>(run_and_report(argc, argv));
}
