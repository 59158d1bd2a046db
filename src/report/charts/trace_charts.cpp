#include "report/charts/trace_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "report/charts/styles.hpp"
#include "report/numbers.hpp"
#include "statistics/thinning.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/statistics/spectrum.hpp"

namespace tribofit {
namespace {

/// Samples [begin, end) that are drawn, and how their times are shown.
struct Window {
  std::size_t begin, end, bins;
  double origin = 0, unit = 1;  ///< of the abscissa [s]
};

/// Adds a line of the values of the window's samples.
ChartLine& add_drawn(const DrawnTrace& d, const Window& w, const std::string& name, std::span<const double> values,
                     const Stroke& stroke, std::size_t panel, Chart& chart) {
  ChartLine& line = chart.line(name, stroke, panel);
  for (const std::size_t k : drawn_samples(values, w.bins)) {
    line.add((d.trace.motion.time[w.begin + k] - w.origin) / w.unit, values[k]);
  }
  return line;
}

/// Friction with its models; below v_b with a disc of known speed, else v_r.
Chart window_chart(const DrawnTrace& d, const Window& w, bool with_models) {
  const Motion& motion = d.trace.motion;
  const bool varies = !motion.disc_velocity.empty();
  const bool of_block =
      motion.velocity_kind != VelocityKind::fixed_block && (varies || motion.constant_disc_velocity != 0);
  const auto in = [&](const std::vector<double>& values) {
    return std::span(values).subspan(w.begin, w.end - w.begin);
  };
  const auto of_each = [&](auto&& value) {  // one at a time: of a long record each is as large as a channel
    std::vector<double> values(w.end - w.begin);
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = value(w.begin + k) / kMillimetre;
    return values;
  };
  const auto disc = [&](std::size_t i) { return motion.disc_velocity_at(i); };
  const auto velocity = [&](std::size_t i) {
    const double v_r = motion.relative_velocity[i];
    return of_block ? disc(i) - v_r : v_r;
  };
  Chart chart{.x = {.quantity = "time", .unit = "s"},
              .panels = {friction_axis(motion, 1.3), {of_block ? "v_{b}" : "v_{r}", "mm/s"}}};
  add_drawn(d, w, "measured", in(motion.friction), kMeasured, 0, chart);
  for (std::size_t k = 0; with_models && k < d.models.size(); ++k) {
    add_drawn(d, w, curve_name(*d.models[k]), in(d.predictions[k]), model_stroke(k), 0, chart).shown = k < 2;
  }
  add_drawn(d, w, "measured", of_each(velocity), kMeasured, 1, chart);
  if (!of_block) return chart;
  add_drawn(d, {w.begin, w.end, varies ? w.bins : 1, w.origin, w.unit}, "ω r of the disc", of_each(disc), kDisc, 1,
            chart);
  return chart;
}

void shade_phases(const Motion& motion, const Cycle& c, Chart& chart) {
  if (c.stick.size() > 0) {
    chart.stretches.push_back({motion.time[c.stick.begin], c.break_away_time, Shade::stick});
  }
  const double end = std::isfinite(c.restick_time) && c.slip_complete
                         ? c.restick_time
                         : motion.time[std::min(c.slip.end, motion.size() - 1)];
  if (c.slip.size() > 0) chart.stretches.push_back({c.break_away_time, end, Shade::slip});
}

/// What is not used in fits.
void shade_left_out(const DrawnTrace& d, Chart& chart) {
  const std::vector<double>& time = d.trace.motion.time;
  for (const SampleRange& span : d.trace.segmentation.left_out) {
    if (span.begin >= time.size()) continue;
    chart.stretches.push_back({time[span.begin], time[std::min(span.end, time.size() - 1)], Shade::left_out});
  }
}

/// Every sample within `half` [s] of an event, with the event at zero.
Chart zoom_chart(const DrawnTrace& d, double at, double half, const char* id, const char* title) {
  const std::vector<double>& time = d.trace.motion.time;
  const auto index_at = [&](double t) {
    return static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), t) - time.begin());
  };
  const std::size_t begin = index_at(at - half), end = index_at(at + half);
  if (end < begin + 2) return {};
  Chart chart = window_chart(d, {begin, end, d.bins(chart_detail.zoom), at, kMillisecond}, true);
  chart.id = d.id + "-" + id;
  chart.title = title;
  chart.note = fmt::format("±{} ms about {} s.", significant(half / kMillisecond, 2), significant(at, 6));
  chart.x = {.quantity = "time from the event", .unit = "ms"};
  chart.marks.push_back({0, true, Dash::dotted, ""});
  chart.half = true;
  return chart;
}

/// The cycles drawn: the first of them, and their samples [begin, end); none where there are too few.
struct ShownCycles {
  std::size_t first = 0, begin = 0, end = 0;
};

ShownCycles shown_cycles(const DrawnTrace& d) {
  const std::vector<Cycle>& cycles = d.trace.segmentation.cycles;
  if (d.trace.segmentation.kind != MotionKind::stick_slip || cycles.size() < chart_detail.shown_cycles) return {};
  const std::size_t first = whole_cycles_near_middle(d.trace.segmentation, chart_detail.shown_cycles);
  const Cycle& head = cycles[first];
  const Cycle& tail = cycles[first + chart_detail.shown_cycles - 1];
  const std::size_t begin = head.stick.size() > 0 ? head.stick.begin : head.slip.begin;
  const std::size_t margin = (tail.slip.end - begin) / 20;  // a little of the next stick
  return {first, begin, std::min(d.trace.motion.size(), tail.slip.end + margin)};
}

/// Amplitudes of v_r, up to twelve times the stick-slip frequency where there is one.
Chart spectrum_chart(const DrawnTrace& d) {
  const Motion& motion = d.trace.motion;
  const std::vector<double>& v_r = motion.relative_velocity;
  const double peak = d.trace.spectral_peak.frequency;
  const Spectrum spectrum =
      spectrum_up_to(v_r, motion.step, peak > 0 ? chart_detail.harmonics * peak : 0.5 / motion.step);
  const std::vector<double> amplitude = in_unit(spectrum.amplitude, kMillimetre);
  if (amplitude.empty()) return {};
  Chart chart = half_chart(d.id + "-spectrum", "Spectrum of the relative velocity", {"frequency", "Hz"},
                           {.quantity = "amplitude of v_{r}", .unit = "mm/s", .from_zero = true});
  chart.note = "Hann window over the whole record.";
  if (peak > 0) {
    chart.note = "Strongest line at " + significant(peak, 4) + " Hz (dotted). " + chart.note;
    chart.marks.push_back({peak, true, Dash::dotted, ""});
  }
  ChartLine& line = chart.line("amplitude", kMeasured);
  for (const std::size_t k : drawn_samples(amplitude, d.bins(chart_detail.spectrum))) {
    line.add(static_cast<double>(k) * spectrum.bin_width, amplitude[k]);
  }
  return chart;
}

struct CycleMeasure {
  const char* name;
  double Cycle::*value;
  Colour colour;
  Symbol symbol;
};

/// Measures of each cycle as points over time.
Chart cycle_chart(const DrawnTrace& d, const char* id, const char* title, ChartAxis axis, double unit,
                  std::initializer_list<CycleMeasure> measures) {
  Chart chart = half_chart(d.id + "-" + id, title, {.quantity = "time of break-away", .unit = "s"}, std::move(axis));
  const std::vector<Cycle>& cycles = d.trace.segmentation.cycles;
  for (const CycleMeasure& measure : measures) {
    std::vector<double> values;
    for (const Cycle& c : cycles) values.push_back(c.*measure.value / unit);
    ChartLine& line = chart.line(measure.name, dots(measure.colour, measure.symbol));
    for (const std::size_t k : drawn_samples(values, d.bins(chart_detail.measures))) {
      line.add(cycles[k].break_away_time, values[k]);
    }
  }
  shade_left_out(d, chart);
  return chart;
}

Chart record_chart(const DrawnTrace& d) {
  Chart chart = window_chart(d, {0, d.trace.motion.size(), d.bins(chart_detail.record)}, false);
  chart.id = d.id + "-record";
  chart.title = "The whole record";
  chart.note = "Each drawn interval shows its smallest and largest sample, so single-sample spikes stay visible.";
  shade_left_out(d, chart);
  return chart;
}

}  // namespace

DrawnTrace::DrawnTrace(const Identification& identification, const DrawnLaws& laws, std::string prefix, double part,
                       std::size_t record, int draw_on)
    : DrawnLaws(laws), trace(identification), id(std::move(prefix)), share(part), threads(draw_on) {
  pieces = slip_branches(trace.motion, trace.segmentation);
  fastest = fastest_of(trace.motion, pieces) / kMillimetre;
  slowest = fastest;
  for (const double v : trace.motion.relative_velocity) slowest = std::min(slowest, std::abs(v) / kMillimetre);
  predictions.resize(models.size());
  run_tasks(models.size(), threads, [&](std::size_t k) {
    predictions[k] = predict(*models[k], trace.motion, trace.segmentation, record, threads);
  });
}

std::size_t DrawnTrace::bins(std::size_t whole) const {
  return std::max(chart_detail.least, static_cast<std::size_t>(share * static_cast<double>(whole)));
}

ChartAxis friction_axis(const Motion& motion, double part) {
  const bool force = friction_unit(motion) == "N";
  return {.quantity = force ? "friction force" : "friction μ", .unit = force ? "N" : "1", .part = part};
}

std::vector<Chart> cycle_charts(const DrawnTrace& d) {
  const std::vector<Cycle>& cycles = d.trace.segmentation.cycles;
  const Motion& motion = d.trace.motion;
  const auto [first, begin, end] = shown_cycles(d);
  if (motion.is_points()) return {};  // which have no time
  if (end < begin + 2) return {record_chart(d)};
  Chart chart = window_chart(d, {begin, end, d.bins(chart_detail.cycles)}, true);
  chart.id = d.id + "-cycles";
  chart.title = d.models.empty() ? "Three cycles" : "Three cycles, measured and by the law";
  chart.note = "Cycles " + std::to_string(first) + " to " + std::to_string(first + chart_detail.shown_cycles - 1) +
               ". In stick the spring sets friction, so the law applies in slip only.";
  for (std::size_t k = first; k < first + chart_detail.shown_cycles; ++k) shade_phases(motion, cycles[k], chart);
  std::vector<Chart> charts = {chart};
  const Cycle& shown = cycles[first + chart_detail.shown_cycles / 2];
  const double half = chart_detail.event * static_cast<double>(shown.slip.size()) * motion.step;
  if (shown.stick.size() > 0) charts.push_back(zoom_chart(d, shown.break_away_time, half, "break-away", "Break-away"));
  if (shown.slip_complete) charts.push_back(zoom_chart(d, shown.restick_time, half, "restick", "Re-stick"));
  return charts;
}

std::vector<Chart> measure_charts(const DrawnTrace& d) {
  std::vector<Chart> charts;
  if (d.trace.segmentation.cycles.size() > 1) {
    charts = {cycle_chart(d, "levels", "Friction levels of each cycle", friction_axis(d.trace.motion), 1,
                          {{"break-away", &Cycle::break_away_friction, Colour::blue, Symbol::circle},
                           {"largest in stick", &Cycle::stick_maximum, Colour::red, Symbol::triangle_up},
                           {"least in slip", &Cycle::slip_minimum, Colour::green, Symbol::triangle_down}}),
              cycle_chart(d, "peaks", "Fastest of each slip", {"peak |v_{r}|", "mm/s"}, kMillimetre,
                          {{"peak velocity", &Cycle::peak_velocity, Colour::blue, Symbol::circle}}),
              cycle_chart(d, "times", "Durations of each cycle", {"duration", "ms"}, kMillisecond,
                          {{"stick", &Cycle::stick_time, Colour::blue, Symbol::circle},
                           {"slip", &Cycle::slip_time, Colour::red, Symbol::triangle_up},
                           {"period", &Cycle::period, Colour::green, Symbol::square}})};
  }
  charts.push_back(spectrum_chart(d));
  if (const ShownCycles shown = shown_cycles(d); shown.end >= shown.begin + 2) charts.push_back(record_chart(d));
  return charts;
}

}  // namespace tribofit
