#include "tribofit/study/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/conclusions.hpp"
#include "diagnosis_parts.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "report/charts/styles.hpp"
#include "tribofit/friction/effect_pairs.hpp"
#include "tribofit/friction/effects/force_bandwidth.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kPredictionsShown = 4;
constexpr double kClear = 2;  // spreads by which models are apart that a person sees

bool differs(double a, double b) {
  return std::abs(a - b) > 1e-6 * std::abs(b);
}

std::string pauses_text(const std::vector<Pause>& pauses) {
  if (pauses.empty()) return "";
  const auto [shortest, longest] = std::minmax_element(
      pauses.begin(), pauses.end(), [](const Pause& a, const Pause& b) { return a.duration < b.duration; });
  return fmt::format("with {} pauses of {} to {} s", pauses.size(), significant(shortest->duration, 2),
                     significant(longest->duration, 2));
}

/// "9 mm at 8 rpm for 12 s".
std::string run_text(const RunConditions& run, const RunConditions& own) {
  std::vector<std::string> parts;
  const auto add = [&](bool is_said, const std::string& part) {
    if (is_said) parts.push_back(part);
  };
  const std::string speed = brief(run.speed / kRpm) + " rpm";
  add(differs(run.radius, own.radius), brief(run.radius / kMillimetre) + " mm");
  if (run.reversing > 0) {
    parts.push_back(fmt::format("forth and back at up to {}, {} s a turn", speed, brief(1 / run.reversing)));
  } else {
    add(differs(run.speed, own.speed), parts.empty() ? speed : "at " + speed);
  }
  add(differs(run.load, own.load), "under " + brief(run.load) + " N");
  add(differs(run.stiffness, own.stiffness), "on a spring of " + brief(run.stiffness * kMillimetre) + " N/mm");
  add(run.mass_below > 0, "with " + brief(1e3 * run.mass_below) + " g more below the force sensor");
  add(!run.pauses.empty(), pauses_text(run.pauses));
  add(differs(run.rate, own.rate), "sampled at " + frequency_text(run.rate));
  add(parts.empty(), "the same again");
  const double s = run.duration;
  return fmt::format("{} for {}", fmt::join(parts, " "),
                     s < 120 ? fmt::format("{:.0f} s", std::ceil(s)) : fmt::format("{:.1f} min", s / 60));
}

/// A name for the file of a new run, from which `identify manifest` reads its conditions.
std::string file_for(const RunConditions& run, const RunConditions& own) {
  std::string name;
  if (differs(run.radius, own.radius)) name += "r" + brief(run.radius / kMillimetre) + "mm_";
  name += brief(run.speed / kRpm) + "rpm";
  if (differs(run.load, own.load)) name += "_" + brief(run.load) + "N";
  return name + "_new.csv";
}

/// The experiment of the catalogue for the first two models.
std::string catalogue_experiment(const RunPlan& plan) {
  if (plan.models.size() < 2) return {};
  const auto key = [](const ModelInQuestion& model) { return model.name.substr(0, model.name.find(':')); };
  for (std::size_t k = 1; k < plan.models.size(); ++k) {
    const std::string known = discriminating_experiment(key(plan.models[0]), key(plan.models[k]));
    if (!known.empty()) return known;
  }
  return {};
}

/// "9 mm at 8 rpm for 12 s, then 18 mm at 4 rpm for 24 s": what is different from `own`.
std::string experiment_text(const Experiment& experiment, const RunConditions& own) {
  if (experiment.tap > 0) return "tap the block";
  if (experiment.lift) return "lift the block off the disc and read the force sensor";
  if (experiment.accelerometer) return "an accelerometer beside the vibrometer";
  std::vector<std::string> runs;
  for (const RunConditions& run : experiment.runs) runs.push_back(run_text(run, own));
  return fmt::format("{}", fmt::join(runs, ", then "));
}

/// "35 %"; "-" where it is not known.
std::string whole_percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.0f} %", 100 * share) : "-";
}

/// The answer of a model: "frictional-lag", "nothing more".
std::string model_text(const ModelInQuestion& model) {
  return model.name.empty() ? "nothing more" : model.name;
}

/// What is open, with how likely each answer is so far.
std::string question_sentence(const DiagnosedTraces& diagnosed, const RunPlan& plan) {
  if (plan.kind == QuestionKind::nothing) {
    const std::vector<Rung> found = found_effects(diagnosed.diagnosis);
    std::vector<std::string> names;
    for (const Rung& rung : found) names.push_back(rung.added);
    return found.empty() ? "These records ask for no effect, and none is possible: there is nothing to settle."
                         : fmt::format("{} {} found alone: there is nothing to settle.", capitalised(enumerated(names)),
                                       names.size() == 1 ? "is" : "are");
  }
  std::vector<std::string> answers;
  for (const ModelInQuestion& model : plan.models) {
    answers.push_back(model_text(model) + (plan.reason.empty() ? " (" + whole_percent(model.probability) + ")" : ""));
  }
  return fmt::format("Open: {}. {}", enumerated(answers, "or"),
                     plan.kind == QuestionKind::possible ? "What it would explain may be chance."
                                                         : "These records do not distinguish them.");
}

/// What to do, and what it will probably show.
std::string plan_verdict(const DiagnosedTraces& diagnosed, const RunPlan& plan) {
  if (!plan.reason.empty()) return "Nothing could be planned: " + plan.reason + ".";
  if (plan.kind == QuestionKind::nothing) {
    const std::string& next = diagnosed.diagnosis.next_experiment;
    return next.empty() ? "A repeat of the run, held back with --confirm, would confirm the law." : next;
  }
  const std::string known = catalogue_experiment(plan), instead = known.empty() ? "" : " What would: " + known + ".";
  if (plan.experiments.empty()) {
    return (plan.kind == QuestionKind::plateau ? "No run distinguishes them: they move the plateau alike in every one."
                                               : "None of the stated means changes anything that could be seen.") +
           instead;
  }
  const PlannedExperiment& best = plan.experiments.front();
  const std::string run = experiment_text(best.experiment, plan.own), chance = whole_percent(best.probability);
  if (!plan.hopeless) return fmt::format("Best: {}. It names the effect alone with a probability of {}.", run, chance);
  return fmt::format(
      "Nothing within the stated means is likely to settle it: the best, {}, does so with a probability of {}.{}", run,
      chance, instead);
}

/// Experiments with their minutes and their probabilities.
ReportTable experiments_table(const RunPlan& plan) {
  ReportTable table("Experiments, the best first");
  table.text({"what to do"}).numbers({"minutes", "names it"});
  for (const ModelInQuestion& model : plan.models) table.columns.push_back({"if " + model_text(model), true, 1, {}});
  table.columns.push_back({"diagnosed", true, 2, {}});
  for (const PlannedExperiment& one : plan.experiments) {
    std::vector<std::string> row = {experiment_text(one.experiment, plan.own), fixed(one.minutes(), 1),
                                    one.reason.empty() ? whole_percent(one.probability) : "-"};
    for (const double p : one.of_models) row.push_back(whole_percent(p));
    row.push_back(one.simulated > 0 ? fmt::format("{} of {}", one.named, one.simulated) : "");
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// What each model predicts to be seen in an experiment, the clearest first.
ReportTable predictions_table(const RunPlan& plan, const PlannedExperiment& one, bool force) {
  ReportTable table("What is to be seen: " + experiment_text(one.experiment, plan.own));
  table.text({""});
  for (const ModelInQuestion& model : plan.models) table.numbers({"if " + model_text(model)});
  table.text({"unit"});
  for (const Prediction& prediction : one.predictions) {
    if (table.rows.size() >= kPredictionsShown || (prediction.apart < kClear && !table.rows.empty())) break;
    std::vector<std::string> row = {prediction.name};
    for (const PredictedValue& value : prediction.models) {
      const double spread = 0.25 * (value.upper95 - value.lower95) / prediction.si;
      row.push_back(std::isfinite(value.value) ? with_error(value.value / prediction.si, spread) : "-");
    }
    row.push_back(prediction.unit.empty() && force ? "N" : prediction.unit);
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// What was planned with, and what was not asked.
std::vector<std::string> plan_notes(const RunPlan& plan) {
  std::vector<std::string> notes = plan.messages;
  if (plan.usual_means && plan.kind != QuestionKind::nothing && plan.reason.empty()) {
    notes.emplace_back(
        "No means were stated: planned with a quarter to four times the disc speed, at the same radius, and with a "
        "longer record. --speeds, --radii, --loads, --springs, --pauses, --reversing, --tap, --lift and --rates say "
        "what can be done.");
  }
  if (!plan.experiments.empty() && plan.experiments.front().experiment.tap > 0) {
    notes.push_back(
        fmt::format("A slower edge of the tap is the filter itself: fit it with --effect {}.", ForceBandwidth::key));
  }
  if (!plan.not_asked.empty()) {
    notes.push_back("Not asked, because these records cannot show them: " + enumerated(plan.not_asked) + ".");
  }
  return notes;
}

/// What to type once the first experiment was made.
Suggestion next_after_plan(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options) {
  const std::vector<std::string> inputs = options.inputs_or(diagnosed.traces.front().path);
  const bool open = plan.reason.empty() && plan.kind != QuestionKind::nothing && !plan.experiments.empty();
  const Experiment best = open ? plan.experiments.front().experiment : Experiment{};
  const auto diagnose = [&](const char* verb, std::vector<std::string> words, const char* dropped,
                            const std::vector<std::string>& files = {}) {
    words.insert(words.begin(), verb);
    return command_line(words_of(words, options.arguments, {dropped}), joined(inputs, files));
  };
  const std::string with_lab = diagnose("diagnose", {"--instruments", "lab.json"}, "--instruments=");
  std::vector<std::string> files;
  bool same_place = true, repeats = false;
  for (const RunConditions& run : best.runs) {
    files.push_back(file_for(run, plan.own));
    same_place &= !differs(run.radius, plan.own.radius) && !differs(run.load, plan.own.load);
    repeats |= !differs(run.speed, plan.own.speed) && run.pauses.empty() && !(run.reversing > 0);
  }
  // A diagnosis would keep a repeat to confirm what it finds; a plan goes on from it.
  return first_of(
      {{!open, "to see the diagnosis behind it", diagnose("diagnose", {}, "")},
       {best.accelerometer, "once the gain that it shows stands in lab.json (vibrometer.gain)", with_lab},
       {best.lift, "once its zero stands in lab.json (force_sensor.zero)", with_lab},
       {best.tap > 0,
        "once the shift that the tap shows stands in lab.json (vibrometer.delay), and what a sharp edge allows "
        "(force_sensor.bandwidth_at_least)",
        with_lab},
       {same_place, "with the new run beside the record",
        diagnose(repeats ? "plan" : "diagnose", {}, "--speed=", files)},
       {true, fmt::format("with all records in runs/, the new one as {}", enumerated(files)),
        command_line({"manifest", "runs/", "--out", "runs/manifest.csv"}, {})}});
}

/// What each model predicts over a variable, with bands.
Chart predicted_chart(const RunPlan& plan, const PredictedCurves& curves, const std::string& id, bool force) {
  Chart chart =
      chart_of(id, capitalised(curves.quantity) + " as each model predicts it", {curves.name, curves.unit},
               {curves.quantity, force ? "N" : "1"},
               "Bands hold 95 % of the records that a model makes, with its parameters drawn within their errors.");
  for (std::size_t m = 0; m < curves.models.size() && m < plan.models.size(); ++m) {
    const PredictedCurves::OfModel& model = curves.models[m];
    ChartLine& line = chart.line("if " + model_text(plan.models[m]), stroke_of(m));
    line.x = in_unit(model.x, curves.si);
    line.y = model.y, line.low = model.lower95, line.high = model.upper95;
  }
  return chart;
}

Json run_json(const RunConditions& run) {
  return object("radius_mm", run.radius / kMillimetre, "speed_rpm", run.speed / kRpm, "load_N", run.load,
                "stiffness_N_per_mm", run.stiffness * kMillimetre, "mass_below_g", 1e3 * run.mass_below, "duration_s",
                run.duration, "rate_hz", run.rate, "reversing_hz", positive_or_null(run.reversing), "pauses",
                list_of(run.pauses, [](const Pause& pause) {
                  return object("begin_s", pause.begin, "duration_s", pause.duration);
                }));
}

Json prediction_json(const Prediction& prediction) {
  const auto value = [&](const PredictedValue& v) {
    return object("value", v.value / prediction.si, "ci95",
                  interval_json(v.lower95 / prediction.si, v.upper95 / prediction.si));
  };
  return object("name", prediction.name, "unit", prediction.unit.empty() ? "1" : prediction.unit, "apart",
                prediction.apart, "models", list_of(prediction.models, value));
}

Json experiment_json(const PlannedExperiment& one, const RunConditions& own) {
  return object("text", experiment_text(one.experiment, own), "runs", list_of(one.experiment.runs, run_json), "tap_hz",
                positive_or_null(one.experiment.tap), "lift", one.experiment.lift, "accelerometer",
                one.experiment.accelerometer, "minutes", one.minutes(), "probability", one.probability, "expected",
                one.expected, "probability_by_model", list_of(one.of_models, number), "simulated", one.simulated,
                "named", one.named, "wrong", one.wrong, "predictions", list_of(one.predictions, prediction_json),
                "reason", text_or_null(one.reason));
}

Json planned_json(const DiagnosedTraces& diagnosed, const RunPlan& plan, const JsonOptions& options) {
  const auto model = [](const ModelInQuestion& m) {
    return object("effect", text_or_null(m.name), "probability", m.probability);
  };
  return object("question", to_string(plan.kind), "models", list_of(plan.models, model), "own", run_json(plan.own),
                "experiments",
                list_of(plan.experiments, [&](const PlannedExperiment& one) { return experiment_json(one, plan.own); }),
                "usual_means", plan.usual_means, "hopeless", plan.hopeless, "not_asked", plan.not_asked, "messages",
                plan.messages, "reason", text_or_null(plan.reason), "next",
                next_after_plan(diagnosed, plan, {options.arguments}).command);
}

}  // namespace

ReportSection plan_section(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options) {
  const bool force = !diagnosed.traces.empty() && diagnosed.traces.front().motion.friction_kind == FrictionKind::force;
  ReportSection section{"plan", "What to run next", {}};
  section.plain(question_sentence(diagnosed, plan));
  section.plain(plan_verdict(diagnosed, plan), Medium::page);
  if (plan.answered() && !plan.experiments.empty()) {
    ReportTable experiments = experiments_table(plan);
    experiments.file = "the file of --json";
    section.add(std::move(experiments));
    for (std::size_t k = 0; k < plan.curves.size(); ++k) {
      section.add(predicted_chart(plan, plan.curves[k], fmt::format("predicted-{}", k + 1), force));
    }
    for (const PlannedExperiment& one : plan.experiments) {
      if (one.predictions.empty()) continue;
      section.add(predictions_table(plan, one, force), &one == &plan.experiments.front() ? Medium::any : Medium::page);
    }
  }
  section.heading("Plan", Medium::terminal);
  section.plain(plan_verdict(diagnosed, plan), Medium::terminal);
  for (const std::string& note : plan_notes(plan)) section.soft(note);
  const Suggestion next = next_after_plan(diagnosed, plan, options);
  section.plain("Next, " + next.reason + ":", Medium::page);
  section.command(next.command, Medium::page);
  return section;
}

Report plan_report(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options) {
  Report report = report_of(diagnosed, options);
  report.kind = "plan";
  report.lead = question_sentence(diagnosed, plan) + " " + plan_verdict(diagnosed, plan);
  report.next = {next_after_plan(diagnosed, plan, options)};
  report.keep_for(Medium::page);
  for (ReportSection& section : report.sections) section.medium = Medium::page;  // a terminal shows the plan alone
  report.sections.insert(report.sections.begin(), plan_section(diagnosed, plan, options));
  return report;
}

std::string plan_json(const DiagnosedTraces& diagnosed, const RunPlan& plan, const JsonOptions& options) {
  Json json = diagnosed_json(diagnosed, options);
  json["plan"] = planned_json(diagnosed, plan, options);
  return text_of(json);
}

}  // namespace tribofit
