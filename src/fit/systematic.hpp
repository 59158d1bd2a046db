#pragma once

#include <span>
#include <vector>

#include "model_residuals.hpp"
#include "tribofit/fit/fit.hpp"

namespace tribofit {

/// Standard uncertainty of each parameter from what the instruments file declares (and from a high-pass that was found
/// and undone): every declared uncertainty moves velocity or friction by one standard deviation, one Newton step says
/// how far the parameters follow, and independent sources add in squares. So does the offset between the clocks of two
/// instruments. What is declared moves all records alike, what was found in a record moves that one. Zero where nothing
/// is declared; NaN where something is whose effect on these records is not known.
std::vector<double> systematic_errors(const FrictionModel& model, const std::vector<double>& p,
                                      std::span<const Record> records, const Observations& observations,
                                      const Instruments& instruments, const std::vector<bool>& free, bool published);

/// Standard uncertainty of each parameter from when a spring slider breaks away, which its smoothed velocity shows
/// early or late by a part of the smoothing, in every cycle alike. Zero for other records.
std::vector<double> smoothing_errors(const FrictionModel& model, const std::vector<double>& p,
                                     std::span<const Record> records, const Observations& observations,
                                     const std::vector<bool>& free, bool published);

}  // namespace tribofit
