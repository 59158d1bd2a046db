#pragma once

#include <string>

#include "tribofit/report/json.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// As of the diagnosis, with "plan": {"question", "models", "own", "experiments", "usual_means", "hopeless",
/// "not_asked", "reason", "next"}; every number in the unit its name says.
std::string plan_json(const DiagnosedTraces& diagnosed, const RunPlan& plan, const JsonOptions& options = {});

/// What a person reads of a plan: what is open and how likely each answer is so far; the experiments with their
/// minutes and the probability that each names the effect; what each model predicts to be seen in them; where nothing
/// settles it, that; and the command to type afterwards.
ReportSection plan_section(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options = {});

/// The plan; on a page the report of the diagnosis behind it, too.
Report plan_report(const DiagnosedTraces& diagnosed, const RunPlan& plan, const ReportOptions& options = {});

}  // namespace tribofit
