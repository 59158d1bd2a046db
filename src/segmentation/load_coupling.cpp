#include "tribofit/segmentation/load_coupling.hpp"

#include <limits>

#include "limits.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

namespace {

/// Straight line of the load over friction in one cycle.
struct Line {
  double slope = 0, level = 0;  ///< level: at no friction
  bool known = false;
};

/// Noise on friction would flatten the line of least squares. Friction a twentieth of the cycle earlier and later
/// serves as an instrument: it follows the same course and does not share the noise (Reiersol 1945).
Line line_of(const Motion& motion, std::size_t begin, std::size_t end) {
  Line line;
  const std::size_t shift = (end - begin) / 20;
  const auto n = static_cast<double>(end - begin - 2 * shift);
  const auto instrument = [&](std::size_t i) { return motion.friction[i - shift] + motion.friction[i + shift]; };
  double mean_load = 0, mean_friction = 0, mean_instrument = 0;
  for (std::size_t i = begin + shift; i < end - shift; ++i) {
    mean_load += motion.load[i] / n;
    mean_friction += motion.friction[i] / n;
    mean_instrument += instrument(i) / n;
  }
  double with_load = 0, with_friction = 0;
  for (std::size_t i = begin + shift; i < end - shift; ++i) {
    const double z = instrument(i) - mean_instrument;
    with_load += z * (motion.load[i] - mean_load);
    with_friction += z * (motion.friction[i] - mean_friction);
  }
  line.known = with_friction > 0;
  if (!line.known) return line;
  line.slope = with_load / with_friction;
  line.level = mean_load - line.slope * mean_friction;
  return line;
}

}  // namespace

Estimate load_coupling(const Motion& motion, const Segmentation& segmentation) {
  Estimate out;
  out.value = out.std_error = std::numeric_limits<double>::quiet_NaN();
  if (motion.load.empty() || segmentation.kind != MotionKind::stick_slip) return out;
  std::vector<double> slopes;
  for (const Cycle& cycle : segmentation.cycles) {
    if (cycle.stick.size() == 0 || cycle.slip.end < cycle.stick.begin + segmentation::kShortestPull) continue;
    const Line line = line_of(motion, cycle.stick.begin, cycle.slip.end);
    const double scale = motion.friction_kind == FrictionKind::force ? 1 : line.level;
    if (line.known && scale > 0) slopes.push_back(line.slope / scale);
  }
  if (slopes.size() < segmentation::kFewestCoupledCycles) return out;
  return mean_with_error(std::move(slopes));
}

void uncouple_load(double kappa, Motion& motion) {
  for (std::size_t i = 0; i < motion.load.size(); ++i) {
    if (motion.friction_kind == FrictionKind::force) {
      motion.load[i] -= kappa * motion.friction[i];
    } else {
      motion.load[i] /= 1 + kappa * motion.friction[i];
    }
  }
}

}  // namespace tribofit
