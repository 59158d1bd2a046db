#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fit/assessment.hpp"
#include "report/charts/styles.hpp"
#include "report/charts/trace_charts.hpp"
#include "report/numbers.hpp"

namespace tribofit {
namespace {

constexpr double kDecades = 100;  ///< fastest over slowest from which speeds are drawn by their logarithm
constexpr int kPointsOfCurve = 161;

/// Speeds at which laws are drawn [m/s].
std::vector<double> speeds_of(double slowest, double fastest, bool logarithmic) {
  std::vector<double> speeds;
  for (int k = 0; k < kPointsOfCurve; ++k) {
    const double part = k / (kPointsOfCurve - 1.0);
    speeds.push_back(logarithmic ? slowest * std::pow(fastest / slowest, part) : fastest * part);
  }
  return speeds;
}

struct Direction {
  const char* name;
  int sign;
  Stroke stroke;
};
constexpr Direction kDirections[] = {{"measured, forwards", 1, dots(Colour::blue, Symbol::circle)},
                                     {"measured, backwards", -1, dots(Colour::red, Symbol::square)}};

/// Adds value(sample) of every point over its speed.
template <class Value>
void add_points(const Motion& motion, const Segmentation& segmentation, Value value, std::size_t panel, bool with_error,
                Chart& chart) {
  for (const Direction& direction : kDirections) {
    ChartLine& line = chart.line(direction.name, direction.stroke, panel);
    line.listed = panel == 0;
    line.bars = with_error;
    for (const Cycle& cycle : segmentation.cycles) {
      if (cycle.direction != direction.sign) continue;
      for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) {
        const double speed = std::abs(motion.relative_velocity[i]) / kMillimetre, y = direction.sign * value(i);
        if (with_error) {
          line.add(speed, y, motion.friction_std_error[i]);
        } else {
          line.add(speed, y);
        }
      }
    }
  }
}

}  // namespace

Chart points_chart(const DrawnTrace& d) {
  if (!(d.fastest > 0)) return {};
  const Motion& motion = d.trace.motion;
  double slowest = std::numeric_limits<double>::infinity();
  for (const double v : motion.relative_velocity) slowest = std::min(slowest, std::abs(v) / kMillimetre);
  const bool logarithmic = slowest > 0 && d.fastest > kDecades * slowest;
  Chart chart{.id = d.id + "-law",
              .title = "Friction over relative velocity",
              .note =
                  "Points as measured, with their standard errors where they are stated. Bands of the laws: 95 % "
                  "interval. Below: what the best law leaves, in units of the noise floor.",
              .x = {.quantity = "relative velocity |v_{r}|", .unit = "mm/s", .logarithmic = logarithmic},
              .panels = {{friction_axis(motion), 1.35}},
              .height = 560};
  add_points(
      motion, d.trace.segmentation, [&](std::size_t i) { return motion.friction[i]; }, 0,
      !motion.friction_std_error.empty(), chart);
  for (std::size_t k = 0; k < d.curves.size(); ++k) {
    const Curve curve = law_curve(*d.curves[k], speeds_of(slowest * kMillimetre, d.fastest * kMillimetre, logarithmic));
    ChartLine& line = chart.line(curve_name(*d.curves[k]), model_stroke(k));
    for (const double v : curve.velocity) line.x.push_back(v / kMillimetre);
    line.y = curve.mu;
    line.low = curve.lower95, line.high = curve.upper95;
    line.shown = k < 2;
  }
  if (d.models.empty()) return chart;
  const double unit = residual_unit(*d.models[0]);
  chart.panels.push_back({{"residual / floor", "1"}});
  add_points(
      motion, d.trace.segmentation, [&](std::size_t i) { return (motion.friction[i] - d.predictions[0][i]) / unit; }, 1,
      false, chart);
  for (const double bound : {-2.0, 2.0}) chart.marks.push_back({bound, false, Dash::dotted, "", 1});
  return chart;
}

}  // namespace tribofit
