#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "report/charts/styles.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

/// Motions of the block, simulated or measured, as portraits, over time and alive.

/// What is drawn of a motion: a few hundred extremes of each channel, three quarters of which lie in the slips, where
/// things happen fast.
using DrawnMotion = Animation::Block;
/// Of channels in SI.
DrawnMotion drawn_motion(std::string name, std::span<const double> time, std::span<const double> displacement,
                         std::span<const double> velocity, std::span<const double> friction,
                         std::span<const std::uint8_t> sticks);
template <class Motion>
DrawnMotion drawn_motion(std::string name, const Motion& m) {
  return drawn_motion(std::move(name), m.time, m.displacement, m.velocity, m.friction, m.sticks);
}

/// Velocity over displacement, without a line yet; the speed of the disc [m/s] is marked.
Chart portrait_plane(std::string id, std::string title, double disc_velocity);
/// Adds a motion to it; closed: it ends where it began.
void add_loop(const DrawnMotion& motion, const Stroke& stroke, Chart& chart, bool closed = false);

/// Adds a motion to a chart over time: velocity, friction and displacement, a panel each; the legend names it once.
void add_over_time(const DrawnMotion& motion, const ChartAxis& friction, const Stroke& stroke, Chart& chart);
void shade_sticks(const DrawnMotion& motion, Chart& chart);
/// The speed of the disc in the first panel.
ChartMark disc_mark(double disc_velocity);

}  // namespace tribofit
