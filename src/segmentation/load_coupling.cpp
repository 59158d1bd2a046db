#include "tribofit/segmentation/load_coupling.hpp"

#include <cstddef>
#include <optional>
#include <vector>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

namespace {

/// Takes the straight line over time out of a course.
void remove_trend(std::vector<double>& course) {
  const StraightLine line = fit_line(course);
  for (std::size_t i = 0; i < course.size(); ++i) course[i] -= line.at(static_cast<double>(i));
}

/// Noise on friction would flatten the line of least squares. Friction a twentieth of the cycle earlier and later
/// serves as an instrument: it follows the same course and does not share the noise (Reiersol 1945). A load that rises
/// steadily does not follow friction, which rises over most of the cycle: a line over time is taken out of both.
/// The slope of that line, over the load without friction where friction is a coefficient; nothing where it is not
/// known.
std::optional<double> coupling_in(const Motion& motion, std::size_t begin, std::size_t end) {
  const std::size_t shift = (end - begin) / 20;
  std::vector<double> load, friction, instrument;
  for (std::size_t i = begin + shift; i < end - shift; ++i) {
    load.push_back(motion.load[i]);
    friction.push_back(motion.friction[i]);
    instrument.push_back(motion.friction[i - shift] + motion.friction[i + shift]);
  }
  const double mean_load = mean_of(load), mean_friction = mean_of(friction);
  for (std::vector<double>* course : {&load, &friction, &instrument}) remove_trend(*course);
  double with_load = 0, with_friction = 0;
  for (std::size_t i = 0; i < load.size(); ++i) {
    with_load += instrument[i] * load[i];
    with_friction += instrument[i] * friction[i];
  }
  if (!(with_friction > 0)) return std::nullopt;
  const double slope = with_load / with_friction;
  const double scale = motion.friction_kind == FrictionKind::force ? 1 : mean_load - slope * mean_friction;
  return scale > 0 ? std::optional(slope / scale) : std::nullopt;
}

}  // namespace

Estimate load_coupling(const Motion& motion, const Segmentation& segmentation) {
  std::vector<double> slopes;
  for (const Cycle& cycle : segmentation.cycles) {
    if (motion.load.empty() || segmentation.kind != MotionKind::stick_slip) break;
    if (cycle.stick.size() == 0 || cycle.slip.end < cycle.stick.begin + segmentation::kShowsLine) continue;
    const std::optional<double> slope = coupling_in(motion, cycle.stick.begin, cycle.slip.end);
    if (slope) slopes.push_back(*slope);
  }
  if (slopes.size() < segmentation::kFewestCoupledCycles) slopes.clear();
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
