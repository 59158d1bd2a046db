#pragma once

#include <string_view>
#include <vector>

#include "evidence.hpp"
#include "probes.hpp"
#include "trial.hpp"

namespace tribofit::diagnosis {

/// The trial's model without one of its effects, fitted.
Trial try_without(const DiagnosisContext& context, const Level& level, const Trial& full, std::string_view key,
                  int threads = 1);

/// The model of `rest` with the effect of a candidate, at the values found when it was judged, at low resolution.
Trial try_instead(const DiagnosisContext& context, const Trial& rest, const Candidate& candidate, const Trial& judged);

/// Another law with the effects of a trial, at low resolution; not usable where an effect cannot act on it. It is
/// searched for from the data, and from the levels of the other law.
Trial try_law(const DiagnosisContext& context, const Law& law, const Trial& known);

/// Friction falls with speed, or its rise levels off within the data: a straight rise is what a viscous part says.
bool is_law_of_its_own(const DiagnosisContext& context, const Trial& trial);

/// On a bound a law has become another one.
bool is_on_bound(const Trial& trial);

/// What the largest structure that free functions found would take away of the held-out squares; 0 where none is left.
double largest_fall(const std::vector<Probe>& probes);

}  // namespace tribofit::diagnosis
