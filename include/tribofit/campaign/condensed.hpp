#pragma once

#include <string>
#include <vector>

#include "tribofit/fit/identification.hpp"
#include "tribofit/fit/observations.hpp"

namespace tribofit {

/// What a run keeps of its samples for a fit of all runs together: the means over a few neighbours by which laws are
/// fitted (see Observations), without channels. A megabyte in memory at the most, but for runs of thousands of slips.
struct CondensedRun {
  /// Bounds of the parameters of a joint fit [SI]; held where they are equal.
  struct OfFit {
    std::string law;
    std::vector<std::string> effects;
    std::vector<double> lower, upper;
  };
  Observations observations;
  bool is_points = false;
  double within = 0;  ///< mean square of friction about the values, over all samples [1 or N^2]
  std::vector<OfFit> fits;

  /// That of a law with these effects; null where there is none.
  const OfFit* fit(const std::string& law, const std::vector<std::string>& effects) const;
};

/// Condenses an analysed trace. Up to kMostCondensedValues values are those of its own fit; beyond that each is a mean
/// over more samples, with the variance of speed within it.
CondensedRun condensed(const Identification& result);

}  // namespace tribofit
