#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "fit/assessment.hpp"
#include "report/charts/styles.hpp"
#include "report/charts/trace_charts.hpp"
#include "report/numbers.hpp"
#include "statistics/thinning.hpp"
#include "tribofit/campaign/figures.hpp"
#include "tribofit/diagnosis/residual_map.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kSpeedBins = 48, kErrorBins = 80, kTimeBins = 400, kCurvePoints = 161, kBreakAways = 200;

struct BranchStyle {
  std::string_view name;
  Stroke stroke;
};
constexpr std::array<BranchStyle, 3> kBranches = {
    BranchStyle{"speeding up", {Colour::blue, Dash::solid, Symbol::triangle_up, 1.6, 5}},
    BranchStyle{"slowing down", {Colour::red, Dash::dashed, Symbol::triangle_down, 1.6, 5}},
    BranchStyle{"slip", {Colour::blue, Dash::solid, Symbol::circle, 1.6, 5}}};

/// Adds a band over cycles; speeds come in m/s.
ChartLine& add_band(const std::string& name, CycleBand band, const Stroke& stroke, Chart& chart) {
  return chart.lines.emplace_back(
      ChartLine{name, in_unit(band.at, kMillimetre), band.middle, stroke, band.low, band.high});
}

/// Residuals of each model on both branches, switched with the line of their model.
void add_residuals(const DrawnTrace& d, Chart& chart) {
  const std::vector<double>& friction = d.trace.motion.friction;
  for (std::size_t m = 0; m < d.models.size(); ++m) {
    std::vector<double> residuals;
    for (std::size_t i = 0; i < friction.size(); ++i) residuals.push_back(friction[i] - d.predictions[m][i]);
    residuals = in_unit(residuals, residual_unit(*d.models[m]));
    for (const auto& [branch, band] : bands_over_speed(d.trace.motion, d.pieces, residuals, kSpeedBins)) {
      ChartLine& line = add_band(curve_name(*d.models[m]), band, style_of(branch, kBranches).stroke, chart);
      line.stroke.width = 1.3;
      line.panel = 1;
      line.listed = false;
      if (m == 0) continue;
      line.stroke.colour = model_stroke(m).colour;
      line.stroke.dash = model_stroke(m).dash;
      line.low.clear(), line.high.clear();  // one band is enough to look at
    }
  }
}

void add_break_aways(const DrawnTrace& d, Chart& chart) {
  std::vector<double> levels;
  for (const Cycle& c : d.trace.segmentation.cycles) {
    if (std::isfinite(c.break_away_friction) && d.trace.segmentation.is_selected(c))
      levels.push_back(c.break_away_friction);
  }
  ChartLine& line = chart.line("break-away of each cycle", dots(Colour::grey, Symbol::diamond));
  for (const std::size_t k : drawn_samples(levels, d.bins(kBreakAways))) line.add(0, levels[k]);
}

/// The law of each fit with its band; those that no model beside the samples has can be switched on.
void add_curves(const DrawnTrace& d, Chart& chart) {
  for (const Fit* fit : d.curves) {
    const auto beside = std::find(d.models.begin(), d.models.end(), fit);
    const bool is_beside = beside != d.models.end();
    const Curve curve = curve_of(*fit, kCurvePoints);
    ChartLine& line = chart.line(
        curve_name(*fit), is_beside ? model_stroke(static_cast<std::size_t>(beside - d.models.begin())) : kPublished);
    line.x = in_unit(curve.velocity, kMillimetre), line.y = curve.mu;
    line.low = curve.lower95, line.high = curve.upper95;
    line.shown = is_beside;
  }
}

/// What no slip reaches is grey.
void shade_beyond(const DrawnTrace& d, Chart& chart) {
  double fastest = 0, slowest = std::numeric_limits<double>::infinity();
  for (const Fit* fit : d.curves) {
    fastest = std::max(fastest, fit->fastest / kMillimetre);
    slowest = std::min(slowest, fit->slowest / kMillimetre);
  }
  if (!(fastest > 0)) return;
  const double right = 1.12 * fastest;
  chart.x.low = -0.02 * right;
  chart.x.high = right;
  chart.stretches.push_back({fastest, 1.3 * fastest, Shade::beyond});
  if (slowest > 0 && slowest < fastest) chart.stretches.push_back({-fastest, slowest, Shade::beyond});
}

/// Relative error ([D] Eq 5): the mean of each bin as a line, its largest as points.
Chart error_chart(const DrawnTrace& d, const char* id, const char* title, ChartAxis x) {
  return {.id = d.id + "-" + id,
          .title = title,
          .note = "|(measured − law)/measured| of every slip sample, Eq 5. Each bin shows its mean and its largest.",
          .x = std::move(x),
          .panels = {{.axis = {.quantity = "relative error", .unit = "1", .from_zero = true}}},
          .marks = {{published_error_limit, false, Dash::dashed, "0.08 of [D]"}},
          .half = true};
}

void add_errors(const std::string& name, std::size_t k, const BinExtremes& errors, Chart& chart) {
  constexpr std::array<Symbol, 3> kLargest = {Symbol::triangle_up, Symbol::square, Symbol::cross};
  const Stroke stroke = model_stroke(k);
  const bool shown = k < 2;
  chart.lines.push_back({.name = name + ", mean",
                         .x = errors.at,
                         .y = errors.mean,
                         .stroke = {stroke.colour, stroke.dash},
                         .shown = shown});
  chart.lines.push_back({.name = name + ", largest",
                         .x = errors.at,
                         .y = errors.largest,
                         .stroke = dots(stroke.colour, kLargest[k % 3]),
                         .shown = shown});
}

/// Mean residual in units of the noise floor.
HeatMap map_of(const DrawnTrace& d, std::size_t model) {
  ResidualMap map = residual_map(d.trace.motion, d.trace.segmentation, d.predictions[model]);
  const double floor = residual_unit(*d.models[model]), most = std::max(1.0, map.usual / floor);
  for (std::vector<double>& row : map.mean) row = in_unit(row, floor);
  return {map.phase, map.first_cycle, map.mean, "residual / floor", "1", -most, most};
}

Chart map_chart(const DrawnTrace& d, std::size_t model) {
  return {.id = d.id + "-map-" + std::to_string(model + 1),
          .title = "What " + curve_name(*d.models[model]) + " leaves over cycle and phase of the slip",
          .note =
              "Mean residual in units of the noise floor. Upright stripes: the law has the wrong shape. Changes from "
              "cycle to cycle: something moves with time or angle.",
          .x = {"phase of the slip, 0 break-away to 1 re-stick", "1"},
          .panels = {{{"cycle", ""}}},
          .map = map_of(d, model),
          .height = 360,
          .half = true};
}

}  // namespace

Chart law_chart(const DrawnTrace& d) {
  if (!(d.fastest > 0)) return {};
  Chart chart{.id = d.id + "-law",
              .title = "Friction over relative velocity",
              .note =
                  "Bands of the measurement: 5 to 95 % of the cycles. Bands of the laws: 95 % interval. Below: what "
                  "each law leaves, in units of the noise floor. Laws are those of steady sliding at the start of "
                  "the record, over a turn of the disc.",
              .x = {"relative velocity |v_{r}|", "mm/s"},
              .panels = {{friction_axis(d.trace.motion), 1.35}},
              .height = 560};
  const Motion& motion = d.trace.motion;
  for (const auto& [branch, band] : bands_over_speed(motion, d.pieces, motion.friction, kSpeedBins)) {
    const BranchStyle& style = style_of(branch, kBranches);
    add_band("measured, " + std::string(style.name), band, style.stroke, chart);
  }
  add_break_aways(d, chart);
  add_curves(d, chart);
  shade_beyond(d, chart);
  if (d.models.empty()) return chart;
  chart.panels.push_back({{"residual / floor", "1"}});
  add_residuals(d, chart);
  for (const double bound : {-2.0, 2.0}) chart.marks.push_back({bound, false, Dash::dotted, "", 1});
  return chart;
}

std::vector<Chart> error_charts(const DrawnTrace& d) {
  if (!(d.fastest > 0) || d.models.empty()) return {};
  const Motion& m = d.trace.motion;
  std::vector<Chart> charts = {
      error_chart(d, "error-speed", "Relative error over speed", {"relative velocity |v_{r}|", "mm/s"}),
      error_chart(d, "error-time", "Relative error over time", {"time", "s"})};
  for (std::size_t k = 0; k < d.models.size(); ++k) {
    ExtremesInBins speed(0, d.fastest, kErrorBins), time(m.time.front(), m.time.back(), kTimeBins);
    for (const SlipBranch& piece : d.pieces) {
      for (std::size_t i = piece.samples.begin; i < piece.samples.end; ++i) {
        const double error = std::abs((m.friction[i] - d.predictions[k][i]) / m.friction[i]);
        speed.add(std::abs(m.relative_velocity[i]) / kMillimetre, error);
        time.add(m.time[i], error);
      }
    }
    add_errors(curve_name(*d.models[k]), k, speed.result(), charts[0]);
    add_errors(curve_name(*d.models[k]), k, time.result(), charts[1]);
  }
  if (m.is_points()) charts.pop_back();
  if (d.trace.segmentation.kind == MotionKind::stick_slip) {
    for (std::size_t k = 0; k < std::min<std::size_t>(2, d.models.size()); ++k) charts.push_back(map_chart(d, k));
  }
  return charts;
}

std::vector<Chart> profile_charts(const Fit& fit, const Motion& motion, const std::string& id) {
  std::vector<Chart> charts;
  for (const FitParameter& p : fit.parameters) {
    if (p.profile.empty()) continue;
    const std::string name = full_name(p);
    Chart chart{
        .id = id + "-profile-" + name,
        .title = "Profile likelihood of " + name,
        .note =
            "Rise of the squares with this parameter held and all others refitted, in units of the rise at which "
            "the 95 % interval ends. Dotted: best value. A parabola means that the interval from the curvature is "
            "right.",
        .x = {.quantity = name, .unit = shown_unit(p, motion), .digits = 9},
        .panels = {{.axis = {.quantity = "rise / that of 95 %", .unit = "1", .from_zero = true}}},
        .marks = {{1, false, Dash::dashed, "95 %"}, {shown(p, p.value), true, Dash::dotted, ""}},
        .height = 280,
        .half = true};
    std::replace_if(
        chart.id.begin(), chart.id.end(), [](unsigned char c) { return !std::isalnum(c) && c != '-'; }, '-');
    ChartLine& line = chart.line("profile", {Colour::blue, Dash::solid, Symbol::circle});
    for (const ProfilePoint& point : p.profile) line.add(shown(p, point.value), point.rise);
    charts.push_back(std::move(chart));
  }
  return charts;
}

}  // namespace tribofit
