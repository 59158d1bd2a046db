#pragma once

#include <string>

#include "commands.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// What is said of a plan, on a terminal and on a page alike.

/// "8 rpm for 20 s", "9 mm at 8 rpm for 12 s, then 18 mm at 4 rpm for 24 s": what is different from `own`.
std::string experiment_text(const Experiment& experiment, const RunConditions& own);

/// The answer of a model: "frictional-lag", "nothing more".
std::string model_text(const ModelInQuestion& model);

/// What is open, with how likely each answer is so far.
std::string question_sentence(const DiagnosedTraces& diagnosed, const RunPlan& plan);

/// What to do, and what it will probably show.
std::string plan_verdict(const DiagnosedTraces& diagnosed, const RunPlan& plan);

/// Experiments with their minutes and their probabilities.
ReportTable experiments_table(const RunPlan& plan);

/// What each model predicts to be seen in an experiment, the clearest first.
ReportTable predictions_table(const RunPlan& plan, const PlannedExperiment& one, bool force);

/// What was planned with, and what was not asked.
std::vector<std::string> plan_notes(const RunPlan& plan);

/// What to type once the first experiment was made.
Suggestion next_after_plan(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options);

}  // namespace tribofit
