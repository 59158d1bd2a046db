#pragma once

#include <cstddef>
#include <vector>

#include "open_question.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// Chance that a tap recorded at this rate [Hz] tells this answer from all others: an edge that is shifted, beyond
/// three standard uncertainties as for what an instruments file declares, or one that is slower than a filter of a
/// quarter of the rate makes it, which a few samples show. truth: index of the model.
double chance_of_tap(const OpenQuestion& question, std::size_t truth, double rate);

/// What a tap shows, within what can be read off it.
std::vector<Prediction> predict_tap(const OpenQuestion& question, double rate);

}  // namespace tribofit
