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
#include "tribofit/execution/parallel.hpp"

namespace tribofit {
namespace {

struct BranchStyle {
  std::string_view name;
  Stroke stroke;
};
constexpr std::array<BranchStyle, 3> kBranches = {
    BranchStyle{"speeding up", {Colour::blue, Dash::solid, Symbol::triangle_up, 1.6, 5}},
    BranchStyle{"slowing down", {Colour::red, Dash::dashed, Symbol::triangle_down, 1.6, 5}},
    BranchStyle{"slip", {Colour::blue, Dash::solid, Symbol::circle, 1.6, 5}}};

const char* note_on_law(bool points) {
  return points
             ? "Points as measured, with their standard errors where they are stated. Bands of the laws: 95 % "
               "interval. Below: what the best law leaves, in units of the noise floor."
             : "Bands of the measurement: 5 to 95 % of the cycles. Bands of the laws: 95 % interval. Below: what each "
               "law leaves, in units of the noise floor. A law with effects is drawn along the slips, through both "
               "branches; its line of steady sliding, at the start of the record and over a turn of the disc, can "
               "be switched on.";
}

/// Adds a band over cycles, or its middle alone; speeds come in m/s.
ChartLine& add_band(const std::string& name, const CycleBand& band, bool whole, const Stroke& stroke, Chart& chart) {
  ChartLine& line = chart.line(name, stroke);
  line.x = in_unit(band.at, kMillimetre), line.y = band.middle;
  if (whole) line.low = band.low, line.high = band.high;
  return line;
}

/// What a model leaves of every sample, in units of the noise floor.
std::vector<double> residuals_of(const DrawnTrace& d, std::size_t model) {
  const std::vector<double>& friction = d.trace.motion.friction;
  const std::vector<double>& predicted = d.predictions[model];
  const double unit = residual_unit(*d.models[model]);
  std::vector<double> residuals(friction.size());
  for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] = (friction[i] - predicted[i]) / unit;
  return residuals;
}

/// The stroke of a model on one branch, whose symbol it has.
Stroke on_branch(std::size_t model, Branch branch, double width) {
  Stroke stroke = model_stroke(model);
  stroke.symbol = style_of(branch, kBranches).stroke.symbol;
  stroke.size = 4;
  stroke.width = width;
  return stroke;
}

/// Whether what a model says along the slips is more than a function of the speed; points have no slips.
bool has_loop(const DrawnTrace& d, const Fit& fit) {
  return !fit.model.effects().empty() && !d.trace.motion.is_points();
}

/// Bands over speed: of the measurement, of what each model leaves, then of what each says, where that is a loop.
std::vector<std::vector<BranchBand>> bands_of(const DrawnTrace& d) {
  const std::size_t models = d.models.size();
  std::vector<std::vector<BranchBand>> bands(1 + 2 * models);
  run_tasks(bands.size(), d.threads, [&](std::size_t k) {
    if (k > models && !has_loop(d, *d.models[k - 1 - models])) return;
    bands[k] = bands_over_speed(d.trace.motion, d.pieces,
                                k == 0        ? d.trace.motion.friction
                                : k <= models ? residuals_of(d, k - 1)
                                              : d.predictions[k - 1 - models],
                                chart_detail.speed_bins);
  });
  return bands;
}

void add_break_aways(const DrawnTrace& d, Chart& chart) {
  std::vector<double> levels;
  for (const Cycle& c : d.trace.segmentation.cycles) {
    if (std::isfinite(c.break_away_friction) && d.trace.segmentation.is_selected(c))
      levels.push_back(c.break_away_friction);
  }
  ChartLine& line = chart.line("break-away of each cycle", dots(Colour::grey, Symbol::diamond));
  for (const std::size_t k : drawn_samples(levels, d.bins(chart_detail.break_aways))) line.add(0, levels[k]);
}

/// The law of a fit with its band: from rest to a quarter beyond the fastest slip, or in equal ratios of the speeds.
Curve curve_over(const DrawnTrace& d, const ChartAxis& speed, const Fit& fit) {
  if (!speed.logarithmic) return curve_of(fit, chart_detail.curve_points, d.threads);
  std::vector<double> speeds;
  for (std::size_t k = 0; k < chart_detail.curve_points; ++k) {
    const double part = static_cast<double>(k) / (chart_detail.curve_points - 1.0);
    speeds.push_back(kMillimetre * d.slowest * std::pow(d.fastest / d.slowest, part));
  }
  return law_curve(fit, speeds, d.threads);
}

/// Those that no model beside the samples has can be switched on.
void add_curves(const DrawnTrace& d, Chart& chart) {
  for (const Fit* fit : d.curves) {
    const auto beside = std::find(d.models.begin(), d.models.end(), fit);
    const bool is_beside = beside != d.models.end();
    const auto k = static_cast<std::size_t>(beside - d.models.begin());
    const bool looped = is_beside && has_loop(d, *fit);
    Stroke stroke = is_beside ? model_stroke(k) : kPublished;
    if (looped) stroke.dash = Dash::dotted;
    const Curve curve = curve_over(d, chart.x, *fit);
    ChartLine& line = chart.line(curve_name(*fit) + (looped ? ", steady sliding" : ""), stroke);
    line.x = in_unit(curve.velocity, kMillimetre), line.y = curve.mu;
    line.low = curve.lower95, line.high = curve.upper95;
    line.shown = is_beside && !looped;
  }
}

/// Values of every point over its speed, with their standard errors where there are any.
void add_points(const DrawnTrace& d, const std::vector<double>& values, const std::vector<double>& std_errors,
                std::size_t panel, Chart& chart) {
  for (const int sign : {1, -1}) {
    ChartLine& line = sign > 0 ? chart.line("measured, forwards", dots(Colour::blue, Symbol::circle), panel)
                               : chart.line("measured, backwards", dots(Colour::red, Symbol::square), panel);
    for (const Cycle& cycle : d.trace.segmentation.cycles) {
      if (cycle.direction != sign) continue;
      for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) {
        const double speed = std::abs(d.trace.motion.relative_velocity[i]) / kMillimetre;
        const double value = sign * values[i];
        std_errors.empty() ? line.add(speed, value) : line.add(speed, value, std_errors[i]);
      }
    }
  }
}

/// What no slip reaches is grey.
void shade_beyond(const DrawnTrace& d, Chart& chart) {
  double fastest = 0, slowest = std::numeric_limits<double>::infinity();
  for (const Fit* fit : d.curves) {
    fastest = std::max(fastest, fit->fastest / kMillimetre);
    slowest = std::min(slowest, fit->slowest / kMillimetre);
  }
  if (!(fastest > 0) || chart.x.logarithmic) return;
  const double right = 1.12 * fastest;
  chart.x.low = -0.02 * right;
  chart.x.high = right;
  chart.stretches.push_back({fastest, 1.3 * fastest, Shade::beyond});
  if (slowest > 0 && slowest < fastest) chart.stretches.push_back({-fastest, slowest, Shade::beyond});
}

/// Relative error ([D] Eq 5): the mean of each bin as a line, its largest as points.
Chart error_chart(const DrawnTrace& d, const char* id, const char* title, ChartAxis x) {
  Chart chart = half_chart(
      d.id + "-" + id, title, std::move(x), {.quantity = "relative error", .unit = "1", .from_zero = true},
      "|(measured − law)/measured| of every slip sample. Each bin shows its mean and its largest. Measure and "
      "line at 8 %: the disc-block study with four friction radii of 2023, Eq 5 and Fig 12.");
  chart.marks = {{published_error_limit, false, Dash::dashed, "8 %"}};
  return chart;
}

void add_errors(const std::string& name, std::size_t k, const BinExtremes& errors, Chart& chart) {
  constexpr std::array<Symbol, 3> kLargest = {Symbol::triangle_up, Symbol::square, Symbol::cross};
  const auto add = [&](const char* which, const std::vector<double>& values, const Stroke& stroke) {
    chart.lines.push_back({name + which, errors.at, values, stroke});
    chart.lines.back().shown = k < 2;
  };
  const Stroke stroke = model_stroke(k);
  add(", mean", errors.mean, {stroke.colour, stroke.dash});
  add(", largest", errors.largest, dots(stroke.colour, kLargest[k % 3]));
}

/// Mean residual in units of the noise floor; raises `most` to what is to be seen of it.
Chart map_chart(const DrawnTrace& d, std::size_t model, double& most) {
  Chart chart = half_chart(d.id + "-map-" + std::to_string(model + 1),
                           "What " + curve_name(*d.models[model]) + " leaves over cycle and phase of the slip",
                           {"phase of the slip, 0 break-away to 1 re-stick", "1"}, {"cycle", ""});
  chart.note =
      "Mean residual in units of the noise floor. Upright stripes: the law has the wrong shape. Changes from cycle to "
      "cycle: something moves with time or angle.";
  ResidualMap map = residual_map(d.trace.motion, d.trace.segmentation, d.predictions[model]);
  const double floor = residual_unit(*d.models[model]);
  most = std::max(most, map.usual / floor);
  for (std::vector<double>& row : map.mean) row = in_unit(row, floor);
  chart.map = HeatMap{map.phase, map.first_cycle, map.mean, "residual / noise floor", "1", 0, 0, true};
  chart.panels[0].part = chart_detail.square;
  return chart;
}

}  // namespace

Chart law_chart(const DrawnTrace& d) {
  if (!(d.fastest > 0)) return {};
  const Motion& motion = d.trace.motion;
  const bool points = motion.is_points(), decades = d.slowest > 0 && d.fastest > chart_detail.decades * d.slowest;
  Chart chart = chart_of(d.id + "-law", "Friction over relative velocity",
                         {.quantity = "relative velocity |v_{r}|", .unit = "mm/s", .logarithmic = points && decades},
                         friction_axis(motion, 1.35), note_on_law(points));
  const auto bands = points ? std::vector<std::vector<BranchBand>>(1 + 2 * d.models.size()) : bands_of(d);
  if (points) add_points(d, motion.friction, motion.friction_std_error, 0, chart);
  for (const auto& [branch, band] : bands[0]) {
    const BranchStyle& style = style_of(branch, kBranches);
    add_band("measured, " + std::string(style.name), band, true, style.stroke, chart);
  }
  if (!points) add_break_aways(d, chart);
  const std::size_t models = d.models.size();
  for (std::size_t m = 0; m < models; ++m) {  // the loop that the measurement goes through, too
    for (const auto& [branch, band] : bands[1 + models + m])
      add_band(curve_name(*d.models[m]), band, false, on_branch(m, branch, 2), chart);
  }
  add_curves(d, chart);
  shade_beyond(d, chart);
  if (d.models.empty()) return chart;
  chart.panels.push_back({"residual / noise floor", "1"});
  chart.marks = {{2, false, Dash::dotted, "+2 noise floors", 1}, {-2, false, Dash::dotted, "−2 noise floors", 1}};
  if (points) add_points(d, residuals_of(d, 0), {}, 1, chart);
  for (std::size_t m = 0; m < models; ++m) {  // switched with the line of the model; one band is enough to look at
    for (const auto& [branch, band] : bands[1 + m]) {
      add_band(curve_name(*d.models[m]), band, m == 0, on_branch(m, branch, 1.3), chart).panel = 1;
    }
  }
  return chart;
}

std::vector<Chart> error_charts(const DrawnTrace& d) {
  if (!(d.fastest > 0) || d.models.empty()) return {};
  const Motion& m = d.trace.motion;
  std::vector<Chart> charts = {
      error_chart(d, "error-speed", "Relative error over speed", {"relative velocity |v_{r}|", "mm/s"}),
      error_chart(d, "error-time", "Relative error over time", {"time", "s"})};
  for (std::size_t k = 0; k < d.models.size(); ++k) {
    BinnedSamples speed(0, d.fastest, chart_detail.error_bins),
        time(m.time.front(), m.time.back(), chart_detail.time_bins);
    for (const SlipBranch& piece : d.pieces) {
      for (std::size_t i = piece.samples.begin; i < piece.samples.end; ++i) {
        const double error = std::abs((m.friction[i] - d.predictions[k][i]) / m.friction[i]);
        speed.add(std::abs(m.relative_velocity[i]) / kMillimetre, error);
        time.add(m.time[i], error);
      }
    }
    add_errors(curve_name(*d.models[k]), k, speed.extremes(), charts[0]);
    add_errors(curve_name(*d.models[k]), k, time.extremes(), charts[1]);
  }
  if (m.is_points()) charts.pop_back();
  if (d.trace.segmentation.kind != MotionKind::stick_slip) return charts;
  double most = 1;  // the maps have one scale
  for (std::size_t k = 0; k < std::min<std::size_t>(2, d.models.size()); ++k) charts.push_back(map_chart(d, k, most));
  for (Chart& chart : charts) {
    if (chart.map) chart.map->low = -most, chart.map->high = most;
  }
  return charts;
}

std::vector<Chart> profile_charts(const Fit& fit, const Motion& motion, const std::string& id) {
  std::vector<Chart> charts;
  for (const FitParameter& p : fit.parameters) {
    if (p.profile.empty()) continue;
    const std::string name = full_name(p);
    Chart chart = half_chart(id + "-profile-" + name, "Profile likelihood of " + name,
                             {.quantity = name, .unit = shown_unit(p, motion)},
                             {.quantity = "rise / that of 95 %", .unit = "1", .from_zero = true});
    chart.note =
        "Rise of the squares with this parameter held and all others refitted, in units of the rise at which the 95 % "
        "interval ends. Dotted: best value. A parabola means that the interval from the curvature is right.";
    chart.marks = {{1, false, Dash::dashed, "95 %"}, {shown(p, p.value), true, Dash::dotted, ""}};
    std::replace_if(
        chart.id.begin(), chart.id.end(), [](unsigned char c) { return !std::isalnum(c) && c != '-'; }, '-');
    ChartLine& line = chart.line("profile", {Colour::blue, Dash::solid, Symbol::circle});
    for (const ProfilePoint& point : p.profile) line.add(shown(p, point.value), point.rise);
    charts.push_back(std::move(chart));
  }
  return charts;
}

}  // namespace tribofit
