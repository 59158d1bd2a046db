#include "tribofit/segmentation/load_coupling.hpp"

#include <limits>

#include "tribofit/segmentation/mean_error.hpp"

namespace tribofit {

namespace {

/// Straight line of the load over friction in one cycle.
struct Line {
  double slope = 0, level = 0;  ///< level: at no friction
  bool known = false;
};

Line line_of(const Motion& motion, std::size_t begin, std::size_t end) {
  Line line;
  const auto n = static_cast<double>(end - begin);
  double mean_load = 0, mean_friction = 0;
  for (std::size_t i = begin; i < end; ++i) {
    mean_load += motion.load[i] / n;
    mean_friction += motion.friction[i] / n;
  }
  double product = 0, square = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const double x = motion.friction[i] - mean_friction;
    product += x * (motion.load[i] - mean_load);
    square += x * x;
  }
  line.known = square > 0;
  if (!line.known) return line;
  line.slope = product / square;
  line.level = mean_load - line.slope * mean_friction;
  return line;
}

}  // namespace

Measure load_coupling(const Motion& motion, const Segmentation& segmentation) {
  constexpr std::size_t kFewestCycles = 12, kFewestSamples = 20;
  Measure out;
  out.value = out.std_error = std::numeric_limits<double>::quiet_NaN();
  if (motion.load.empty() || segmentation.kind != MotionKind::stick_slip) return out;
  std::vector<double> slopes;
  for (const Cycle& cycle : segmentation.cycles) {
    if (cycle.stick.size() == 0 || cycle.slip.end < cycle.stick.begin + kFewestSamples) continue;
    const Line line = line_of(motion, cycle.stick.begin, cycle.slip.end);
    const double scale = motion.friction_kind == FrictionKind::force ? 1 : line.level;
    if (line.known && scale > 0) slopes.push_back(line.slope / scale);
  }
  if (slopes.size() < kFewestCycles) return out;
  out.value = 0;
  for (const double slope : slopes) out.value += slope / static_cast<double>(slopes.size());
  const MeanError error = mean_error(slopes);
  out.std_error = error.std_error;
  out.degrees_of_freedom = error.degrees_of_freedom;
  return out;
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
