#pragma once

#include <cstddef>
#include <vector>

#include "open_question.hpp"
#include "tribofit/study/plan.hpp"

namespace tribofit {

/// Chance that what is measured by hand tells this answer from all others, beyond three standard uncertainties as for
/// what an instruments file declares. A tap recorded at some rate [Hz] shows an edge that is shifted, or one that is
/// slower than a filter of a quarter of the rate makes it, which a few samples show; the block lifted off the disc
/// shows the zero of the force sensor. truth: index of the model.
double chance_by_hand(const OpenQuestion& question, std::size_t truth, const Experiment& experiment);

/// What it shows, within what can be read off it.
std::vector<Prediction> predict_by_hand(const OpenQuestion& question, const Experiment& experiment);

}  // namespace tribofit
