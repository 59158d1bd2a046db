#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/ingest/trace.hpp"

namespace tribofit::kinematics {

/// A slower channel in a faster record: each value is repeated until the next, or straight lines or
/// cubics (splines) lead there.
struct Hold {
  std::size_t samples = 1;  ///< of which one has a value of its own
  std::size_t first = 0;    ///< that has
};

/// samples = 1 where values change and lines bend at any sample, as those of a coarse converter do.
Hold find_hold(std::span<const double> channel);

/// Leaves the samples that have values of their own. Says so in the notes.
void keep_fresh_values(Trace& trace, int threads, std::vector<std::string>& notes);

}  // namespace tribofit::kinematics
