#pragma once

#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/report/chart.hpp"

namespace tribofit {

/// What a diagnosis is looked at by: the ladder of held-out errors with the noise floor, where the error above it goes
/// before and after, and the error with each candidate.
std::vector<Chart> diagnosis_charts(const DiagnosedTraces& result);

}  // namespace tribofit
