#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/pool.hpp"

namespace tribofit {

/// The condition over which groups of repeats are shown: the one that takes most values, else their number.
class OverConditions {
 public:
  explicit OverConditions(std::span<const PooledGroup> groups);

  const std::string& quantity() const { return quantity_; }  ///< "friction radius"; "conditions" for their number
  const std::string& unit() const { return unit_; }          ///< "mm"; empty for their number
  /// The conditions of each group where they are only numbered, else empty.
  const std::vector<std::string>& names() const { return names_; }

  /// Groups of one line, by rising abscissa, and what they have in common ("50 N").
  struct Series {
    std::string name;
    std::vector<std::size_t> groups;
    std::vector<double> x;
  };
  const std::vector<Series>& series() const { return series_; }
  double x_of(std::size_t group) const { return x_[group]; }
  /// At most so many groups, evenly, in the order of the series.
  std::vector<std::size_t> some(std::size_t most) const;

 private:
  std::string quantity_ = "conditions", unit_;
  std::vector<std::string> names_;
  std::vector<Series> series_;
  std::vector<double> x_;
};

}  // namespace tribofit
