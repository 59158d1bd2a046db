#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tribofit/fit/observations.hpp"
#include "tribofit/friction/model.hpp"

// How the observations of a record are made.

namespace tribofit {

/// One range per slip of the segmentation that is selected; slips without stick are cut into pieces of about equal
/// length. Values are not assigned yet. noise: of friction, beside which a break-away is weighed; not needed where that
/// weight is not asked for.
std::vector<Observations::SlipObservation> slip_ranges(const Motion& motion, const Segmentation& segmentation,
                                                       const SensorNoise& noise = {});

/// Whether a sample of a slip is evidence: it was read, and its friction is the law's.
inline bool is_evidence(const Motion& motion, const Observations::SlipObservation& slip, std::size_t sample) {
  return sample < slip.law_end && !motion.has_fault(sample, SampleFault::any);
}

/// What the values reach: speeds and friction.
void set_extent(const Motion& motion, Observations& out);

/// Scales of several records: medians over the slips of all of them, the longest record.
RecordScales scales_of(std::span<const Observations> records);

/// The same slips in means over `per_value` neighbouring values each, weighted, with the variance of v_r within each
/// mean; what is known of a slip beside its values stays. Cost: one pass.
Observations reduced(const Observations& observations, std::size_t per_value);

/// Fewer values on which the search for the parameters of a model may run, about so many a slip; nothing where there
/// are not twice as many, or where means would hide what the model looks for (a spectral line, a function of time that
/// a user wrote).
std::optional<Observations> reduced_for_search(const FrictionModel& model, const Observations& observations,
                                               double values_per_slip);

}  // namespace tribofit
