#include <fmt/format.h>

#include <cmath>

#include "report/numbers.hpp"
#include "report/rate_state.hpp"
#include "styles.hpp"

namespace tribofit {
namespace {

std::string law_name(const RateStateFit& fit) {
  return std::string(to_string(fit.evolution)) + " law";
}

/// Of friction, as of a.
const std::string& unit_of_friction(const RateStateAnalysis& analysis) {
  return analysis.fits[analysis.best].parameters.front().parameter.unit;
}

/// What was measured between two displacements, and what the laws make of it, the best on top.
void add_step(const RateStateAnalysis& analysis, const RateStateCurve& curve, double origin, double from, double to,
              Chart& chart) {
  const auto add = [&](const std::string& name, const std::vector<double>& values, const Stroke& stroke) {
    ChartLine& line = chart.line(name, stroke);
    for (std::size_t i = 0; i < curve.time.size(); ++i) {
      const double x = curve.displacement[i] - origin;
      if (!(x < from || x > to)) line.add(x / kMicrometre, values[i]);
    }
  };
  add("measured", curve.friction, kMeasured);
  if (!curve.other.empty()) add(law_name(analysis.fits[1 - analysis.best]), curve.other, model_stroke(1));
  add(law_name(analysis.fits[analysis.best]), curve.model, model_stroke(0));
}

Chart whole_chart(const RateStateAnalysis& analysis) {
  Chart chart =
      chart_of("t1-response", "Friction and the fitted response", {"displacement of the load point", "um"},
               {"friction", unit_of_friction(analysis)},
               "The samples that were fitted, over the displacement of the load point; dotted lines mark where "
               "its speed changes.");
  for (const RateStateCurve& curve : analysis.curves) {
    add_step(analysis, curve, 0, -1e300, 1e300, chart);
    const VelocityStep& step = analysis.steps[curve.step];
    chart.marks.push_back(
        {step.displacement / kMicrometre, true, Dash::dotted,
         step.hold > 0 ? fmt::format("{} s", significant(step.hold, 3)) : sliding_speed_text(step.after)});
  }
  return chart;
}

/// Around the step: as far behind it as friction takes to settle.
Chart zoom_chart_of(const RateStateAnalysis& analysis, const RateStateCurve& curve) {
  const VelocityStep& step = analysis.steps[curve.step];
  constexpr double kBehind = 6, kBeforeIt = 1.5;  // D_c
  const RateStateFit& fit = analysis.fits[analysis.best];
  const double distance = fit.parameters[2].value + fit.parameters[0].value / fit.parameters.back().value;
  Chart chart =
      half_chart(fmt::format("t1-step-{}", curve.step + 1),
                 step.hold > 0 ? fmt::format("Step {}: hold of {} s", curve.step + 1, significant(step.hold, 3))
                               : fmt::format("Step {}: {} to {}", curve.step + 1, sliding_speed_text(step.before),
                                             sliding_speed_text(step.after)),
                 {"displacement since the step", "um"}, {"friction", unit_of_friction(analysis)});
  add_step(analysis, curve, step.displacement, -kBeforeIt * distance, kBehind * distance, chart);
  return chart;
}

Chart healing_chart(const Healing& healing, const std::string& unit) {
  Chart chart = half_chart("t1-healing", "Healing: peak less sliding friction over the time at rest",
                           {"time at rest", "s"}, {"healing", unit});
  chart.x.logarithmic = true;
  ChartLine& line = chart.line("holds", dots(Colour::blue, Symbol::circle));
  for (const HoldMeasures& hold : healing.holds)
    line.add(hold.duration, hold.healing, std::hypot(hold.peak.std_error, hold.sliding.std_error));
  return chart;
}

}  // namespace

std::vector<Chart> rate_state_charts(const RateStateAnalysis& analysis) {
  std::vector<Chart> charts;
  if (!analysis.fitted() || analysis.curves.empty()) return charts;
  charts.push_back(whole_chart(analysis));
  for (const RateStateCurve& curve : analysis.curves) {
    if (charts.size() <= chart_detail.shown_steps) charts.push_back(zoom_chart_of(analysis, curve));
  }
  if (analysis.healing && analysis.healing->holds.size() > 1)
    charts.push_back(healing_chart(*analysis.healing, unit_of_friction(analysis)));
  return charts;
}

}  // namespace tribofit
