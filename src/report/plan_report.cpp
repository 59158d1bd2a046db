#include <fmt/format.h>

#include <utility>

#include "numbers.hpp"
#include "plan_sentences.hpp"
#include "report/charts/styles.hpp"
#include "tribofit/report/plan.hpp"

namespace tribofit {
namespace {

/// What each model predicts over a variable, with bands.
Chart predicted_chart(const RunPlan& plan, const PredictedCurves& curves, const std::string& id, bool force) {
  Chart chart;
  chart.id = id;
  chart.title = capitalised(curves.quantity) + " as each model predicts it";
  chart.note = "Bands hold 95 % of the records that a model makes, with its parameters drawn within their errors.";
  chart.x = {.quantity = curves.name, .unit = curves.unit};
  chart.panels[0].axis = {.quantity = curves.quantity, .unit = force ? "N" : "1"};
  for (std::size_t m = 0; m < curves.models.size() && m < plan.models.size(); ++m) {
    const PredictedCurves::OfModel& model = curves.models[m];
    ChartLine& line = chart.line("if " + model_text(plan.models[m]), stroke_of(m));
    line.x = in_unit(model.x, curves.si);
    line.y = model.y;
    line.low = model.lower95;
    line.high = model.upper95;
  }
  return chart;
}

}  // namespace

ReportSection plan_section(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options) {
  const bool force = !diagnosed.traces.empty() && diagnosed.traces.front().motion.friction_kind == FrictionKind::force;
  ReportSection section{"plan", "What to run next", {}};
  section.plain(question_sentence(diagnosed, plan));
  section.plain(plan_verdict(diagnosed, plan));
  if (plan.answered() && !plan.experiments.empty()) {
    section.add(experiments_table(plan));
    std::size_t k = 0;
    for (const PredictedCurves& curves : plan.curves) {
      section.add(predicted_chart(plan, curves, fmt::format("predicted-{}", ++k), force));
    }
    for (const PlannedExperiment& one : plan.experiments) {
      if (!one.predictions.empty()) section.add(predictions_table(plan, one, force));
    }
  }
  for (const std::string& note : plan_notes(plan)) section.soft(note);
  const Suggestion next = next_after_plan(diagnosed, plan, options);
  section.plain("Next, " + next.reason + ":");
  section.command(next.command);
  return section;
}

Report plan_report(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options) {
  Report report = report_of(diagnosed, options);
  report.kind = "plan";
  report.lead = question_sentence(diagnosed, plan) + " " + plan_verdict(diagnosed, plan);
  report.sections.insert(report.sections.begin(), plan_section(diagnosed, plan, options));
  return report;
}

}  // namespace tribofit
