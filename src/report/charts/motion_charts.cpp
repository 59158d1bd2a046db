#include "report/charts/motion_charts.hpp"

#include <algorithm>

#include "report/numbers.hpp"
#include "statistics/thinning.hpp"

namespace tribofit {
namespace {

std::vector<double> picked(std::span<const double> values, std::span<const std::size_t> samples, double unit) {
  std::vector<double> out;
  out.reserve(samples.size());
  for (const std::size_t i : samples) out.push_back(values[i] / unit);
  return out;
}

}  // namespace

Chart portrait_plane(std::string id, std::string title, double disc_velocity) {
  return {.id = std::move(id),
          .title = std::move(title),
          .x = {.quantity = "displacement of the block", .unit = "mm"},
          .panels = {{.axis = {.quantity = "velocity of the block", .unit = "mm/s"}}},
          .marks = {disc_mark(disc_velocity)},
          .height = 420};
}

void add_loop(const DrawnMotion& m, const Stroke& stroke, Chart& chart, bool closed) {
  std::vector<std::size_t> kept = drawn_samples({m.displacement, m.velocity}, m.sticks, chart_detail.motion);
  if (closed) kept.push_back(kept.front());
  chart.lines.push_back(
      {m.name, picked(m.displacement, kept, kMillimetre), picked(m.velocity, kept, kMillimetre), stroke});
}

void add_over_time(const DrawnMotion& m, const std::vector<MotionChannel>& channels, const Stroke& stroke,
                   Chart& chart) {
  if (chart.lines.empty()) {
    chart.panels.clear();
    for (const MotionChannel& channel : channels) chart.panels.push_back({channel.axis});
  }
  const std::vector<std::size_t> kept =
      drawn_samples({m.displacement, m.velocity, m.friction}, m.sticks, chart_detail.motion);
  const std::vector<double> time = picked(m.time, kept, 1);
  for (std::size_t panel = 0; panel < channels.size(); ++panel) {
    const MotionChannel& channel = channels[panel];
    chart.lines.push_back({m.name, time, picked(m.*channel.values, kept, channel.unit), stroke});
    chart.lines.back().panel = panel;
  }
}

void shade_sticks(const DrawnMotion& m, Chart& chart) {
  for (const FlagRun& run : runs_of(m.sticks)) {
    if (!run.set || chart.stretches.size() >= chart_detail.shown_sticks) continue;
    chart.stretches.push_back({m.time[run.begin], m.time[std::min(run.end, m.time.size() - 1)], Shade::stick});
  }
}

ChartMark disc_mark(double disc_velocity, std::size_t panel) {
  return {disc_velocity / kMillimetre, false, Dash::dash_dotted, "speed of the disc", panel};
}

Animation::Block animated(const DrawnMotion& m) {
  const std::vector<std::size_t> kept = drawn_samples({m.displacement, m.friction}, m.sticks, chart_detail.motion);
  Animation::Block block{
      m.name, picked(m.time, kept, 1), picked(m.displacement, kept, kMillimetre), picked(m.friction, kept, 1), {}};
  for (double& t : block.time) t -= m.time.front();
  for (const std::size_t i : kept) block.sticks.push_back(m.sticks[i] != 0);
  return block;
}

}  // namespace tribofit
