#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "report/charts/styles.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

/// Motions of the block, simulated or measured, as portraits, over time and alive.

/// A motion that is drawn; its samples live elsewhere. SI.
struct DrawnMotion {
  std::string name;
  std::span<const double> time, displacement, velocity, friction;
  std::span<const std::uint8_t> sticks;

  template <class Motion>
  DrawnMotion(std::string its_name, const Motion& m)
      : name(std::move(its_name)),
        time(m.time),
        displacement(m.displacement),
        velocity(m.velocity),
        friction(m.friction),
        sticks(m.sticks) {}
  bool empty() const { return time.empty(); }
};

/// Velocity over displacement, without a line yet; the speed of the disc [m/s] is marked.
Chart portrait_plane(std::string id, std::string title, double disc_velocity);
/// Adds a motion to it, of a few hundred extremes of each channel, three quarters of which lie in the slips, where
/// things happen fast; closed: it ends where it began.
void add_loop(const DrawnMotion& motion, const Stroke& stroke, Chart& chart, bool closed = false);

/// A channel over time in a panel of its own.
struct MotionChannel {
  ChartAxis axis;
  std::span<const double> DrawnMotion::*values;
  double unit;
};
/// Adds a motion with the same extremes to a chart over time, a line a channel; the legend names it once.
void add_over_time(const DrawnMotion& motion, const std::vector<MotionChannel>& channels, const Stroke& stroke,
                   Chart& chart);
void shade_sticks(const DrawnMotion& motion, Chart& chart);
ChartMark disc_mark(double disc_velocity, std::size_t panel = 0);

/// A block that is drawn in motion.
Animation::Block animated(const DrawnMotion& motion);

}  // namespace tribofit
