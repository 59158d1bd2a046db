#pragma once

#include <vector>

#include "tribofit/segmentation/cycles.hpp"

namespace tribofit::segmentation {

/// Stretches of samples in which a fault of the recording leaves the motion unknown (SampleFault::stretch).
inline std::vector<SampleRange> spoilt_stretches(const Motion& motion) {
  std::vector<SampleRange> stretches;
  for (std::size_t i = 0; i < motion.faults.size(); ++i) {
    if (!motion.has_fault(i, SampleFault::stretch)) continue;
    if (stretches.empty() || stretches.back().end < i) stretches.push_back({i, i});
    stretches.back().end = i + 1;
  }
  return stretches;
}

}  // namespace tribofit::segmentation
