#include "report/charts/motion_charts.hpp"

#include <algorithm>

#include "report/numbers.hpp"
#include "statistics/thinning.hpp"

namespace tribofit {
namespace {

void mark_disc(double velocity, Chart& chart) {
  if (velocity > 0) {
    chart.marks.push_back({velocity / kMillimetre, false, Dash::dash_dotted, "speed of the disc"});
  }
}

}  // namespace

Chart portrait_chart(std::string id, std::string title, double disc_velocity, const std::vector<DrawnMotion>& motions) {
  Chart chart = chart_of(std::move(id), std::move(title), {"displacement of the block", "mm"},
                         {.quantity = "velocity of the block", .unit = "mm/s", .part = chart_detail.square});
  mark_disc(disc_velocity, chart);
  for (const auto& [m, stroke, closed] : motions) {
    ChartLine& line = chart.lines.emplace_back(ChartLine{m.name, m.displacement, m.velocity, stroke});
    if (closed) line.add(line.x.front(), line.y.front());
  }
  return chart;
}

Chart motion_chart(std::string id, std::string title, double disc_velocity, const ChartAxis& friction,
                   const std::vector<DrawnMotion>& motions) {
  Chart chart = chart_of(std::move(id), std::move(title), {"time", "s"}, {"velocity v_{b}", "mm/s"});
  chart.panels.insert(chart.panels.end(), {friction, {"displacement", "mm"}});
  mark_disc(disc_velocity, chart);
  for (const DrawnMotion& one : motions) {
    const Animation::Block& m = one.motion;
    for (const auto* values : {&m.velocity, &m.friction, &m.displacement}) {
      chart.lines.push_back({m.name, m.time, *values, one.stroke});
      chart.lines.back().panel = (chart.lines.size() - 1) % chart.panels.size();
    }
  }
  const Animation::Block& first = motions.front().motion;
  for (const FlagRun& run : runs_of(first.sticks)) {
    if (!run.set || chart.stretches.size() >= chart_detail.shown_sticks) continue;
    const std::size_t end = std::min(run.end, first.time.size() - 1);
    chart.stretches.push_back({first.time[run.begin], first.time[end], Shade::stick});
  }
  return chart;
}

}  // namespace tribofit
