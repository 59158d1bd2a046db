#pragma once

#include "tribofit/fit/identification.hpp"

namespace tribofit {

/// Fits every law of the options with the effects of friction among them, then the bare laws by the per-cycle extremes
/// where asked for, and names the best. A trace with fewer than three cycles is refused.
void fit_laws(const IdentifyOptions& options, Identification& trace, FitDetail detail = FitDetail::full);

}  // namespace tribofit
