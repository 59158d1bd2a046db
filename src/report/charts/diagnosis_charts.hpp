#pragma once

#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/report/chart.hpp"

namespace tribofit {

/// The ladder of held-out errors, as effects are added.
Chart ladder_chart(const DiagnosedTraces& result);
/// Error of the law and of the final model that goes with each variable, and the whole of it, on one scale.
Chart where_chart(const DiagnosedTraces& result);
/// Held-out error with each candidate.
Chart candidates_chart(const DiagnosedTraces& result);

enum class Order { status, error };
/// By their status, then by their held-out error; or by that error alone.
std::vector<const EffectFinding*> sorted_findings(const Diagnosis& d, Order by);

}  // namespace tribofit
