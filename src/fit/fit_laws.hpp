#pragma once

#include <span>

#include "tribofit/fit/identification.hpp"

namespace tribofit {

/// Fits every law of the options with the effects of friction among them, then the bare laws by the per-cycle extremes
/// where asked for, and names the best. A trace with fewer than three cycles is refused.
void fit_laws(const IdentifyOptions& options, const Motion& motion, TracePart& part);
inline void fit_laws(const IdentifyOptions& options, Identification& trace) {
  fit_laws(options, trace.motion, trace);
}

/// The observations by which a model is fitted, whoever asks for it: what the model needs, as finely as it acts, with
/// creep in stick as evidence where the model lets the block creep. One model and one record have one fit.
Observations observations_for(const FrictionModel& model, std::span<const Record> records);

}  // namespace tribofit
