#include "report/charts/motion_charts.hpp"

#include <algorithm>

#include "report/numbers.hpp"
#include "statistics/thinning.hpp"

namespace tribofit {

DrawnMotion drawn_motion(std::string name, std::span<const double> time, std::span<const double> displacement,
                         std::span<const double> velocity, std::span<const double> friction,
                         std::span<const std::uint8_t> sticks) {
  DrawnMotion out{std::move(name), {}, {}, {}, {}, {}};
  for (const std::size_t i : drawn_samples({displacement, velocity, friction}, sticks, chart_detail.motion)) {
    out.time.push_back(time[i]);
    out.displacement.push_back(displacement[i] / kMillimetre);
    out.velocity.push_back(velocity[i] / kMillimetre);
    out.friction.push_back(friction[i]);
    out.sticks.push_back(sticks[i]);
  }
  return out;
}

Chart portrait_plane(std::string id, std::string title, double disc_velocity) {
  return {.id = std::move(id),
          .title = std::move(title),
          .x = {.quantity = "displacement of the block", .unit = "mm"},
          .panels = {{.quantity = "velocity of the block", .unit = "mm/s"}},
          .marks = {disc_mark(disc_velocity)},
          .height = 420};
}

void add_loop(const DrawnMotion& m, const Stroke& stroke, Chart& chart, bool closed) {
  ChartLine line{m.name, m.displacement, m.velocity, stroke};
  if (closed) line.add(line.x.front(), line.y.front());
  chart.lines.push_back(std::move(line));
}

void add_over_time(const DrawnMotion& m, const ChartAxis& friction, const Stroke& stroke, Chart& chart) {
  chart.panels = {{"velocity v_{b}", "mm/s"}, friction, {"displacement", "mm"}};
  std::size_t panel = 0;
  for (const auto* values : {&m.velocity, &m.friction, &m.displacement}) {
    chart.lines.push_back({m.name, m.time, *values, stroke});
    chart.lines.back().panel = panel++;
  }
}

void shade_sticks(const DrawnMotion& m, Chart& chart) {
  for (const FlagRun& run : runs_of(m.sticks)) {
    if (!run.set || chart.stretches.size() >= chart_detail.shown_sticks) continue;
    chart.stretches.push_back({m.time[run.begin], m.time[std::min(run.end, m.time.size() - 1)], Shade::stick});
  }
}

ChartMark disc_mark(double disc_velocity) {
  return {disc_velocity / kMillimetre, false, Dash::dash_dotted, "speed of the disc"};
}

}  // namespace tribofit
