#pragma once

#include <cstddef>
#include <vector>

#include "ingest/limits.hpp"
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

/// First samples after a gap in the clock, and both ends of what a fault of the recording spoilt.
inline std::vector<std::size_t> gaps_of(const Motion& motion) {
  std::vector<std::size_t> gaps;
  for (const Step& step : motion.steps) {
    const std::size_t b = step.begin;
    if (b > 0 && b < motion.size() && motion.time[b] - motion.time[b - 1] > kGapInterval * motion.step)
      gaps.push_back(b);
  }
  for (const SampleRange& stretch : spoilt_stretches(motion)) {
    gaps.push_back(stretch.begin);
    gaps.push_back(stretch.end);
  }
  return gaps;
}

}  // namespace tribofit::segmentation
