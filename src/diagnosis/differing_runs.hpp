#pragma once

#include <vector>

#include "diagnose_traces.hpp"

namespace tribofit::diagnosis {

/// Takes the effects back that a diagnosis of several runs found, where the base law describes each run by itself and
/// all together are not described even with the effects: then the parameters of the law differ from run to run, and an
/// effect that was found only follows their differences. Says so, and what to do.
/// Costs a fit of each run, only where the diagnosis leaves an error well above the noise floor.
void withhold_of_differing_runs(const std::vector<PreparedTrace>& traces, const IdentifyOptions& options,
                                const std::vector<Effect>& from_the_start, Diagnosed& diagnosed);

}  // namespace tribofit::diagnosis
