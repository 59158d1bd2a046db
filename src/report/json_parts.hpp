#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/report/json.hpp"

namespace tribofit {

/// The parts of which the objects of identification and diagnosis are made.

using Json = nlohmann::ordered_json;

/// A number, or null for what is not known.
Json number(double value);
Json text_or_null(const std::string& text);

Json tool_json(const JsonOptions& options);
Json trace_json(const Identification& trace);
Json conditions_json(const Conditions& conditions);
/// With those of the steps, where there are several.
Json conditions_of(const Motion& motion);
Json health_json(const Motion& motion);
Json stick_slip_json(const Identification& trace);
/// In the units people read, which depend on whether friction is a force (`motion`).
Json parameter_json(const FitParameter& parameter, const Motion& motion);
Json fits_json(std::span<const Fit> fits, const Motion& motion);
Json rig_json(const RigFit& rig);
Json comparisons_json(std::span<const Fit> fits, std::size_t best);

/// The whole result of one trace.
Json identification_json(const Identification& result, const JsonOptions& options);
/// The whole result of a diagnosis.
Json diagnosed_json(const DiagnosedTraces& result, const JsonOptions& options);

std::string text_of(const Json& json);

}  // namespace tribofit
