#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/pool.hpp"

namespace tribofit {

/// The condition over which groups of repeats are shown: the one that takes most values, else their number.
struct OverConditions {
  explicit OverConditions(std::span<const PooledGroup> groups);
  /// At most so many groups, evenly, in the order of the series.
  std::vector<std::size_t> some(std::size_t most) const;

  /// Groups of one line, by rising abscissa, and what they have in common ("50 N").
  struct Series {
    std::string name;
    std::vector<std::size_t> groups;
    std::vector<double> x;
  };
  std::string quantity = "conditions", unit;  ///< "friction radius", "mm"; "conditions" for their number
  std::vector<std::string> names;             ///< the conditions of each group where they are only numbered
  std::vector<Series> series;
  std::vector<double> x;  ///< of each group
};

}  // namespace tribofit
