#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "json_parts.hpp"

namespace tribofit {

/// A fit that is drawn beside the samples of a trace.
struct DrawnModel {
  std::string name;  ///< as the legend has it
  const Fit* fit;
};

/// Series of everything the page draws of one trace, in the units people read, reduced so that no peak is lost.
///
/// models: the fits whose friction stands beside the samples, the one to look at first. share: part of the points of a
/// page that this trace may have (1 for a trace alone).
Json trace_charts(const Identification& trace, const std::vector<DrawnModel>& models, double share = 1);

/// mu(v) of fits with their 95 % bands, to a quarter beyond the fastest slip. published: a fit's name says so.
Json curve_charts(const std::vector<DrawnModel>& models);

}  // namespace tribofit
