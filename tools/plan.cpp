#include "tribofit/study/plan.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "console.hpp"
#include "diagnosed_runs.hpp"
#include "inputs.hpp"
#include "means_options.hpp"
#include "results.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/report/json.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

constexpr const char* kPlanFooter =
    "Diagnoses the traces and plans the run that settles what they leave open: effects that are not\n"
    "distinguishable, or one that is possible. Only what can be done is planned with; where nothing is said,\n"
    "a quarter to four times the disc speed, and a longer record (see `identify help plan`).\n"
    "With the new run beside the traces it goes on from there.\n\n"
    "Examples:\n"
    "  identify plan --radius 15mm --speeds 1rpm..8rpm --minutes 10 trace.csv\n"
    "  identify plan --radius 15mm --speeds 1rpm..8rpm --radii 9mm,18mm --loads 20N..100N --tap trace.csv\n"
    "  identify plan --speeds 1rpm..8rpm earlier/ new.csv";

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
  const Command verb = app.add_verb("plan", "The run that would settle what a diagnosis leaves open");
  verb.footer(kPlanFooter);
  const auto settings = std::make_shared<Settings>();
  const auto means = std::make_shared<MeansOptions>();
  add_input_options(verb, *settings);
  add_means_options(verb, *means);
  verb.in(section::kMeans)
      .add_option("--time-limit", settings->time_limit,
                  "Simulate no more runs after this time (10s, 2min) and report what is known");
  add_model_options(verb, *settings);
  add_parameter_options(verb, *settings);
  add_selection_options(verb, *settings);
  add_result_options(verb, *settings);
  add_report_option(verb, *settings);
  verb.on_run([settings, means, verb] { return run_plan(*settings, *means, verb.own_options()); });
}
