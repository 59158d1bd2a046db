#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "phases.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

namespace {

SampleRange whole(const Cycle& cycle) {
  return {cycle.stick.size() > 0 ? cycle.stick.begin : cycle.slip.begin, cycle.slip.end};
}

void exclude_cycles(const Selection::Cycles& selected, const Motion& motion, Segmentation& segmentation) {
  if (segmentation.kind != MotionKind::stick_slip) {
    segmentation.notes.push_back("there are no cycles of stick and slip to choose from: all of the motion is used");
    return;
  }
  const auto& cycles = segmentation.cycles;
  if (cycles.empty()) return;
  const std::size_t begin = selected.first < cycles.size() ? whole(cycles[selected.first]).begin : motion.size();
  const std::size_t end = selected.last < cycles.size() ? whole(cycles[selected.last]).end : motion.size();
  segmentation.left_out.push_back({0, begin});
  segmentation.left_out.push_back({std::max(begin, end), motion.size()});
}

/// First sample at or after a time.
std::size_t sample_at(const Motion& motion, double time) {
  return static_cast<std::size_t>(std::lower_bound(motion.time.begin(), motion.time.end(), time) - motion.time.begin());
}

}  // namespace

bool Segmentation::is_selected(const SampleRange& samples) const {
  return std::none_of(left_out.begin(), left_out.end(),
                      [&](const SampleRange& out) { return out.begin < samples.end && samples.begin < out.end; });
}

bool Segmentation::is_selected(const Cycle& cycle) const {
  return is_selected(whole(cycle));
}

std::size_t samples_in_slip(const Segmentation& segmentation) {
  std::size_t samples = 0;
  for (const Cycle& cycle : segmentation.cycles) {
    const bool is_piece = segmentation.kind == MotionKind::always_slipping;
    if (segmentation.is_selected(is_piece ? cycle.slip : whole(cycle))) samples += cycle.slip.size();
  }
  return samples;
}

void exclude(const Selection& selection, const Motion& motion, Segmentation& segmentation) {
  segmentation.left_out = segmentation::spoilt_stretches(motion);
  if (selection.empty()) return;
  if (motion.is_points()) {
    segmentation.notes.emplace_back("points have neither cycles nor time to choose by: all of them are used");
    return;
  }
  if (selection.cycles) exclude_cycles(*selection.cycles, motion, segmentation);
  for (const Selection::Stretch& stretch : selection.excluded) {
    segmentation.left_out.push_back({sample_at(motion, stretch.from), sample_at(motion, stretch.to)});
  }
  std::erase_if(segmentation.left_out, [](const SampleRange& span) { return span.begin >= span.end; });
  if (segmentation.kind != MotionKind::stick_slip) return;
  const auto& cycles = segmentation.cycles;
  const auto left =
      std::count_if(cycles.begin(), cycles.end(), [&](const Cycle& c) { return segmentation.is_selected(c); });
  if (static_cast<std::size_t>(left) == cycles.size()) {
    segmentation.notes.push_back("all cycles are used: what was to be left out holds none of them");
    return;
  }
  segmentation.notes.push_back(
      fmt::format("{} of {} cycles are used in the fit, the others were left out by request", left, cycles.size()));
}

}  // namespace tribofit
