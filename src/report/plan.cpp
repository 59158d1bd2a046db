#include "tribofit/report/plan.hpp"

#include <fmt/format.h>

#include "json_parts.hpp"
#include "numbers.hpp"
#include "plan_sentences.hpp"
#include "terminal_text.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kExperimentsShown = 8;

bool is_force(const DiagnosedTraces& diagnosed) {
  return !diagnosed.traces.empty() && diagnosed.traces.front().motion.friction_kind == FrictionKind::force;
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

std::string render_plan(const DiagnosedTraces& diagnosed, const RunPlan& plan, const TerminalOptions& options) {
  TerminalText text(options);
  text.line(question_sentence(diagnosed, plan), 0);
  if (plan.answered() && !plan.experiments.empty()) {
    ReportTable experiments = experiments_table(plan);
    experiments.file = "the file of --json";
    text.table(experiments, kExperimentsShown);
    text.table(predictions_table(plan, plan.experiments.front(), is_force(diagnosed)));
  }
  text.heading("Plan");
  text.line(plan_verdict(diagnosed, plan));
  for (const std::string& note : plan_notes(plan)) text.line(note);
  text.next(next_after_plan(diagnosed, plan, options));
  return text.take();
}

std::string plan_json(const DiagnosedTraces& diagnosed, const RunPlan& plan, const JsonOptions& options) {
  Json json = diagnosed_json(diagnosed, options);
  json["plan"] = planned_json(diagnosed, plan, options);
  return text_of(json);
}

}  // namespace tribofit
