#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "trial.hpp"
#include "tribofit/fit/fit.hpp"

namespace tribofit::diagnosis {

/// What a diagnosis takes from its records before it tries anything.

/// Everything these data offer to an effect.
Channels all_channels(std::span<const Record> records);

/// The noise of each record.
std::vector<RecordNoise> noises_of(std::span<const Record> records, int threads = 1);

/// The observations of all records as one. stick_unit: noise of a sample of friction [1 or N]; it sets what a stick
/// counts for.
Observations observe_all(std::span<const Record> records, std::span<const RecordNoise> noises, const Channels& channels,
                         std::size_t values_per_slip, double stick_unit);

/// Units of evidence: cycles, points, or stretches of a record in which nothing sticks.
std::size_t count_cycles(std::span<const Record> records);

/// Sensor noise of all records, without a line that runs through it, and scatter of break-away.
Floor floor_of(std::span<const Record> records, std::span<const RecordNoise> noises);

/// Values of a slip in which candidates that come near each other are compared.
std::size_t finest_values(std::size_t cycles);

/// Records as models are judged by them. `records` must outlive it, and hold enough cycles.
class RecordEvidence {
 public:
  RecordEvidence(std::span<const Record> records, int threads, std::vector<GivenParameter> known = {});
  RecordEvidence(const RecordEvidence&) = delete;
  RecordEvidence& operator=(const RecordEvidence&) = delete;

  const std::vector<RecordNoise> noises;
  const Floor floor;
  const Observations fine, coarse;
  const DiagnosisContext context;
};

}  // namespace tribofit::diagnosis
