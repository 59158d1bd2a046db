#include "tribofit/segmentation/slip_branches.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tribofit {

std::vector<SlipBranch> slip_branches(const Motion& motion, const Segmentation& s, std::size_t pieces) {
  std::vector<SlipBranch> out;
  const std::vector<double>& v = motion.relative_velocity;
  for (const Cycle& c : s.cycles) {
    const std::size_t end = std::min(c.slip.end, v.size());
    if (c.slip.begin >= end) continue;
    if (s.kind == MotionKind::stick_slip && !s.is_selected(c)) continue;
    if (s.kind == MotionKind::always_slipping) {
      const std::size_t n = end - c.slip.begin, count = std::min(n, pieces);
      for (std::size_t k = 0; k < count; ++k) {
        const SampleRange part{c.slip.begin + n * k / count, c.slip.begin + n * (k + 1) / count};
        if (s.is_selected(part)) out.push_back({Branch::both, part, c.direction});
      }
      continue;
    }
    const auto first = v.begin() + static_cast<std::ptrdiff_t>(c.slip.begin);
    const auto last = v.begin() + static_cast<std::ptrdiff_t>(end);
    const auto fastest = std::max_element(first, last, [](double a, double b) { return std::abs(a) < std::abs(b); });
    const auto peak = static_cast<std::size_t>(fastest - v.begin());
    out.push_back({Branch::accelerating, {c.slip.begin, peak}, c.direction});
    out.push_back({Branch::decelerating, {peak, end}, c.direction});
  }
  return out;
}

double fastest_of(const Motion& motion, const std::vector<SlipBranch>& branches) {
  double fastest = 0;
  for (const SlipBranch& branch : branches) {
    for (std::size_t i = branch.samples.begin; i < branch.samples.end; ++i) {
      fastest = std::max(fastest, std::abs(motion.relative_velocity[i]));
    }
  }
  return fastest;
}

std::vector<BranchBand> bands_over_speed(const Motion& motion, const std::vector<SlipBranch>& branches,
                                         std::span<const double> values, std::size_t bins) {
  const double fastest = fastest_of(motion, branches);
  std::vector<BinnedSamples> bands(3, BinnedSamples(0, fastest, bins));
  for (const SlipBranch& piece : branches) {
    BinnedSamples& band = bands[static_cast<std::size_t>(piece.branch)];
    for (std::size_t i = piece.samples.begin; i < piece.samples.end; ++i) {
      band.add(std::abs(motion.relative_velocity[i]), piece.direction * values[i]);
    }
    band.end_cycle();
  }
  std::vector<BranchBand> out;
  for (std::size_t k = 0; k < bands.size(); ++k) {
    CycleBand band = bands[k].band();
    if (!band.at.empty()) out.push_back({static_cast<Branch>(k), std::move(band)});
  }
  return out;
}

std::size_t whole_cycles_near_middle(const Segmentation& segmentation, std::size_t count) {
  const std::span<const Cycle> cycles(segmentation.cycles);
  const std::size_t last = cycles.size() - count;
  const auto whole = [&](std::size_t first) {
    const std::span<const Cycle> shown = cycles.subspan(first, count);
    return std::all_of(shown.begin(), shown.end(), [&](const Cycle& c) {
      return c.stick_complete && c.slip_complete && segmentation.is_selected(c);
    });
  };
  return nearest_to_middle(last, whole).value_or(last / 2);
}

}  // namespace tribofit
