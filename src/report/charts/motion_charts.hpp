#pragma once

#include <string>
#include <vector>

#include "report/charts/styles.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

/// Motions of the block, simulated or measured, as portraits, over time and alive.

/// A few hundred extremes of each channel of a motion, three quarters of which lie in the slips, where things happen
/// fast.
template <class Motion>
Animation::Block drawn_motion(std::string name, const Motion& m) {
  Animation::Block out{std::move(name), {}, {}, {}, {}, {}};
  for (const std::size_t i : drawn_samples({m.displacement, m.velocity, m.friction}, m.sticks, chart_detail.motion)) {
    out.time.push_back(m.time[i]);
    out.displacement.push_back(m.displacement[i] / kMillimetre);
    out.velocity.push_back(m.velocity[i] / kMillimetre);
    out.friction.push_back(m.friction[i]);
    out.sticks.push_back(m.sticks[i]);
  }
  return out;
}

/// A motion and how it is drawn; closed: it ends where it began.
struct DrawnMotion {
  Animation::Block motion;
  Stroke stroke = {};
  bool closed = false;
};

/// Velocity over displacement; the speed of the disc [m/s] is marked where it is one.
Chart portrait_chart(std::string id, std::string title, double disc_velocity, const std::vector<DrawnMotion>& motions);
/// Velocity, friction and displacement over time, a panel each, with the sticks of the first motion shaded.
Chart motion_chart(std::string id, std::string title, double disc_velocity, const ChartAxis& friction,
                   const std::vector<DrawnMotion>& motions);

}  // namespace tribofit
