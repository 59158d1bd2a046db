#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/report/csv.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

ExitStatus run_diagnose(const Settings& s, const std::vector<std::string>& arguments) {
  const IdentifyOptions options = options_from(s);
  LeftOut left_out;
  const Split split = usable_runs(s, options, "diagnose", left_out);
  if (split.diagnosed.empty()) return left_out.any_read ? ExitStatus::failed : ExitStatus::bad_input;
  DiagnoseOptions more;
  more.diagnosis.threads = options.threads;
  more.diagnosis.until = end_of(s.time_limit);
  more.confirm = traces_of(split.kept);
  DiagnosedTraces result;
  {
    ProgressLine line;
    more.diagnosis.progress = [&line](std::string_view what, double part) { line.show(what, part); };
    result = diagnose(traces_of(split.diagnosed), options, more);
  }
  add_remarks(split, result);
  const TerminalOptions shown = shown_as(split, s, arguments);
  deliver(s, {[&] { return report_of(result, shown); }, [&] { return to_json(result, {arguments}); },
              [&](const std::string& folder) { write_csv_folder(folder, result); }});
  if (result.analysed && result.diagnosis.verdict != Verdict::not_enough_data)
    return left_out.reasons.empty() ? ExitStatus::done : ExitStatus::failed;
  print_error("the diagnosis could not be done: " + reason_of(result));
  return ExitStatus::failed;
}

}  // namespace

void add_diagnose(const Command& app) {
  const Command verb = app.add_verb(
      "diagnose", "Where a law fails, which effect explains it, what to measure next",
      "Several traces are diagnosed together, with shared parameters; a folder stands for the runs of its\n"
      "manifest.csv (columns file, radius, speed, load, repeat), or for every .csv in it. The last repeat of\n"
      "each condition is held back to confirm the finding.\n"
      "Every effect of the catalogue is tested; --effect KEY adds one to the law from the start, --formula\n"
      "adds one of your own to those tested.\n\n"
      "Examples:\n"
      "  identify diagnose --radius 15mm trace.csv\n"
      "  identify diagnose --radius 15mm --formula @mine.txt --json found.json trace.csv\n"
      "  identify diagnose --confirm runs/r4.csv runs/");
  const auto settings = std::make_shared<Settings>();
  add_input_options(verb, *settings);
  add_spring_options(verb, *settings);
  verb.in(section::kReading)
      .add_option("--confirm", settings->confirm,
                  "A run held back from the diagnosis to confirm the finding (repeatable)");
  verb.add_option("--time-limit", settings->time_limit,
                  "End the search for effects after this time (10s, 2min) and report what is known");
  add_model_options(verb, *settings);
  add_parameter_options(verb, *settings);
  add_output_options(verb, *settings, true);
  verb.on_run([settings, verb] { return run_diagnose(*settings, verb.own_options()); });
}
