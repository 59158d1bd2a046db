#pragma once

#include <span>

#include "output/json.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

/// The members of which the objects of all verbs are made.

Json tool_json(const JsonOptions& options);
/// "tool", "trace", "conditions", "health" and "stick_slip": how the object of one trace begins.
Json record_json(const Identification& trace, const JsonOptions& options);
Json trace_json(const Identification& trace);
/// With those of the steps, where there are several.
Json conditions_of(const Motion& motion);
void add_parameters(std::span<const FitParameter> parameters, std::span<const Correlation> correlations,
                    const Motion& motion, ResultFit& out);
Json fits_json(std::span<const Fit> fits, const Motion& motion);
Json rig_json(const RigFit& rig);

/// The whole result of one trace.
Json identification_json(const Identification& result, const JsonOptions& options);
/// The whole result of a diagnosis.
Json diagnosed_json(const DiagnosedTraces& result, const JsonOptions& options);
/// A report, or a section of one, as the page takes it: members under their own names, numbers with no more digits than
/// are drawn.
Json report_json(const Report& report);
Json section_json(const ReportSection& section);

}  // namespace tribofit
