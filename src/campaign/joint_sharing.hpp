#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/sharing.hpp"

namespace tribofit {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A law that runs share parameters of.
struct SharedLaw {
  const ResultFit& like;                        ///< a fit of it, to know its parameters
  std::vector<std::size_t> runs;                ///< indices of the results that have such a fit
  std::vector<std::size_t> parameters;          ///< of each common parameter, its index
  std::vector<std::vector<std::size_t>> level;  ///< of each common parameter, the level of each of the runs
};

/// Fits all samples of the runs together and puts what is found in the place of what the single fits gave together.
/// Where the runs differ in what they are made to share, and each of them knows it, what the single fits gave stays: it
/// counts what differs. Returns why there is no such fit; empty where there is one, whichever values were kept.
std::string fit_jointly(const ResultReader& results, std::span<const RunResult> runs, const SharedLaw& law,
                        SharedFit& fit);

}  // namespace tribofit
