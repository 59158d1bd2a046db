#include "tribofit/study/block_motion.hpp"

#include <algorithm>
#include <optional>
#include <span>

#include "tribofit/segmentation/slip_branches.hpp"

namespace tribofit {
namespace {

/// The first of `count` whole cycles in a row that are followed by another break-away in the same direction.
std::optional<std::size_t> first_of(const std::vector<Cycle>& cycles, std::size_t count) {
  if (cycles.size() <= count) return std::nullopt;
  return nearest_to_middle(cycles.size() - count - 1, [&](std::size_t first) {
    const std::span<const Cycle> shown = std::span(cycles).subspan(first, count + 1);
    return std::all_of(shown.begin(), shown.end(), [&](const Cycle& c) {
      const bool is_last = &c == &shown.back();
      return c.stick_complete && (is_last || c.slip_complete) && c.direction == shown.front().direction;
    });
  });
}

/// Sets beginning and end of the displacement by a straight line.
void set_ends(double begin, double end, BlockMotion& out) {
  const double from = begin - out.displacement.front(), to = end - out.displacement.back();
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(out.size() - 1);
    out.displacement[i] += from + part * (to - from);
  }
}

}  // namespace

BlockMotion block_motion(const Motion& motion, const Segmentation& segmentation, double compliance, std::size_t count) {
  BlockMotion out;
  if (segmentation.kind != MotionKind::stick_slip || count == 0) return out;
  const auto first = first_of(segmentation.cycles, count);
  if (!first) return out;
  const std::span<const Cycle> cycles = std::span(segmentation.cycles).subspan(*first, count + 1);
  const std::size_t begin = cycles.front().slip.begin, end = std::min(cycles.back().slip.begin + 1, motion.size());
  if (begin + 2 > end) return out;
  out.cycles = count;
  double displacement = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const double disc = motion.disc_velocity_at(i), v = disc - motion.relative_velocity[i];
    if (i > begin) displacement += 0.5 * motion.step * (v + out.velocity.back());
    out.time.push_back(motion.time[i] - cycles.front().break_away_time);
    out.displacement.push_back(displacement);
    out.velocity.push_back(v);
    out.friction.push_back(motion.friction[i]);
    out.sticks.push_back(1);
    out.disc_velocity += disc / static_cast<double>(end - begin);
  }
  for (const Cycle& c : cycles.first(count)) {
    const auto from = out.sticks.begin() + static_cast<std::ptrdiff_t>(c.slip.begin - begin);
    std::fill(from, from + static_cast<std::ptrdiff_t>(std::min(c.slip.end, end) - c.slip.begin), std::uint8_t{0});
  }
  const auto balanced = [&](const Cycle& c) { return compliance * c.direction * c.break_away_friction; };
  set_ends(balanced(cycles.front()), balanced(cycles.back()), out);
  return out;
}

}  // namespace tribofit
