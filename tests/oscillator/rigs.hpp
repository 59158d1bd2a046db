#pragma once

#include <vector>

#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/simulate.hpp"

namespace tribofit {

/// A published test ready to simulate.
struct Case {
  Rig rig;
  Drive drive;
  FrictionModel model;
  std::vector<double> p;
};

inline Case published_case(double radius, Law law) {
  const PublishedTest test = published_test(radius, law);
  Case made{test.rig, {}, FrictionModel(law), test.friction};
  made.drive.speed = constant_speed(test.speed);
  made.drive.radius = test.radius;
  made.drive.mean_load = test.load;
  return made;
}

inline SimulatedMotion simulate(const Case& c, const SimulationOptions& options) {
  return simulate(c.rig, c.drive, c.model, c.p, options);
}

/// Mean time from break-away to break-away, without the first.
inline double mean_period(const SimulatedMotion& motion) {
  const auto& slips = motion.slips;
  return (slips.back().break_away_time - slips[1].break_away_time) / static_cast<double>(slips.size() - 2);
}

}  // namespace tribofit
