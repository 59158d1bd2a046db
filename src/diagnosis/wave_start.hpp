#pragma once

#include <vector>

#include "trial.hpp"

namespace tribofit::diagnosis {

/// A start of a wave (an effect with an amplitude first and one phase) with the amplitude and phase that fit there.
///
/// A cos(wt + phase) is linear in A cos(phase) and A sin(phase), and not in A and phase: from a small amplitude a step
/// in these turns the phase round, and a search ends far away. Here the step is taken in the former; the start is
/// returned as it was where that leaves more, and for every other effect. Cost: three passes over the values.
std::vector<double> with_amplitude_and_phase(const ModelResiduals& residuals, const FrictionModel& model,
                                             const EffectInfo& effect, const Bounds& bounds, std::vector<double> start);

}  // namespace tribofit::diagnosis
