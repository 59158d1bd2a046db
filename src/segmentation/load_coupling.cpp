#include "tribofit/segmentation/load_coupling.hpp"

#include <cstddef>
#include <limits>
#include <vector>

#include "limits.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

namespace {

/// Straight line of the load over friction in one cycle.
struct Line {
  double slope = 0, level = 0;  ///< level: at no friction
  bool known = false;
};

/// Takes the straight line over time out of a course.
void remove_trend(std::vector<double>& course) {
  const StraightLine line = fit_line(course);
  for (std::size_t i = 0; i < course.size(); ++i) course[i] -= line.at(static_cast<double>(i));
}

/// Noise on friction would flatten the line of least squares. Friction a twentieth of the cycle earlier and later
/// serves as an instrument: it follows the same course and does not share the noise (Reiersol 1945). A load that rises
/// steadily does not follow friction, which rises over most of the cycle: a line over time is taken out of both.
Line line_of(const Motion& motion, std::size_t begin, std::size_t end) {
  Line line;
  const std::size_t shift = (end - begin) / 20;
  const auto n = static_cast<double>(end - begin - 2 * shift);
  double mean_load = 0, mean_friction = 0;
  std::vector<double> load, friction, instrument;
  for (std::size_t i = begin + shift; i < end - shift; ++i) {
    load.push_back(motion.load[i]);
    friction.push_back(motion.friction[i]);
    instrument.push_back(motion.friction[i - shift] + motion.friction[i + shift]);
    mean_load += load.back() / n;
    mean_friction += friction.back() / n;
  }
  for (std::vector<double>* course : {&load, &friction, &instrument}) remove_trend(*course);
  double with_load = 0, with_friction = 0;
  for (std::size_t i = 0; i < load.size(); ++i) {
    with_load += instrument[i] * load[i];
    with_friction += instrument[i] * friction[i];
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
