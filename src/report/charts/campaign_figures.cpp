#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "campaign_parts.hpp"
#include "report/numbers.hpp"

namespace tribofit {
namespace {

using Maybe = std::optional<ResultMeasure>;

/// The first run of a group that has figures.
std::optional<RunFigures> figures_of_group(const DrawnCampaign& of, std::size_t group, std::string* run = nullptr) {
  for (const std::size_t k : of.groups()[group].runs) {
    auto figures = of.results.figures(of.runs[k].position);
    if (!figures) continue;
    if (run != nullptr) *run = of.runs[k].run.name;
    return figures;
  }
  return std::nullopt;
}

Maybe mean_of(const PooledValue* value) {
  if (value == nullptr) return std::nullopt;
  return ResultMeasure{value->mean, value->standard_error_of_mean};
}

Chart over_conditions(const OverConditions& over, const std::string& id, const std::string& title) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.note = "Means over repeats; bars: one standard error.";
  chart.x = over.axis();
  return chart;
}

/// Fig 5 of [D].
Chart rms_chart(const DrawnCampaign& of, const OverConditions& over) {
  Chart chart = over_conditions(over, "fig05-rms-velocity", "RMS velocity of the block");
  chart.panels[0].axis = {.quantity = "RMS of v_{b}", .unit = "mm/s"};
  add_over_conditions(
      over, "RMS of v_b", marked(0), 0,
      [&](std::size_t g) { return mean_of(pooled_value(of.groups()[g].measures, "rms_velocity")); }, chart);
  return chart;
}

/// Amplitude of the fundamental over the runs of a group [mm/s].
Maybe fundamental_of(const DrawnCampaign& of, std::size_t group) {
  std::vector<double> values;
  for (const std::size_t k : of.groups()[group].runs) {
    const auto figures = of.results.figures(of.runs[k].position);
    if (figures && !figures->harmonics.empty()) values.push_back(figures->harmonics.front().amplitude);
  }
  if (values.empty()) return std::nullopt;
  ResultMeasure out{0, std::numeric_limits<double>::quiet_NaN()};
  const auto n = static_cast<double>(values.size());
  for (const double v : values) out.value += v / n;
  double squares = 0;
  for (const double v : values) squares += (v - out.value) * (v - out.value);
  if (values.size() > 1) out.std_error = std::sqrt(squares / (n - 1) / n);
  return out;
}

/// Fundamental frequency, its amplitude, and the peaks of v_r.
Chart fundamental_chart(const DrawnCampaign& of, const OverConditions& over) {
  Chart chart = over_conditions(over, "fig07-fundamental", "Stick-slip frequency and amplitude");
  chart.panels = {{.axis = {.quantity = "frequency", .unit = "Hz"}},
                  {.axis = {.quantity = "fundamental", .unit = "mm/s"}},
                  {.axis = {.quantity = "peak of v_{r}", .unit = "mm/s"}}};
  const auto measure = [&](const char* name, std::size_t panel) {
    add_over_conditions(
        over, "this campaign", marked(0), panel,
        [&, name](std::size_t g) { return mean_of(pooled_value(of.groups()[g].measures, name)); }, chart);
    add_earlier(of, over, name, panel, chart);
  };
  measure("frequency", 0);
  add_over_conditions(
      over, "this campaign", marked(0), 1, [&](std::size_t g) { return fundamental_of(of, g); }, chart);
  measure("amplitude", 2);
  chart.note += " The fundamental is the amplitude of the sine of that frequency in v_r.";
  chart.height = 600;
  return chart;
}

/// Fig 9 of [D]: both protocols, as the joint one has neither bias.
Chart levels_chart(const DrawnCampaign& of, const OverConditions& over) {
  Chart chart = over_conditions(over, "fig09-static-kinetic", "Static and kinetic friction and their difference");
  const std::string unit = of.friction_unit();
  chart.panels = {{.axis = {.quantity = "mu_{s}", .unit = unit}},
                  {.axis = {.quantity = "mu_{k}", .unit = unit}},
                  {.axis = {.quantity = "mu_{s} - mu_{k}", .unit = unit}}};
  std::vector<std::pair<std::string, std::string>> kinds;  // law, protocol
  for (const PooledGroup& group : of.groups()) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      const bool published = fit.protocol == "published";  // the same levels whatever the law
      const auto same = [&](const auto& k) { return k.second == fit.protocol && (published || k.first == fit.law); };
      if (std::none_of(kinds.begin(), kinds.end(), same)) kinds.emplace_back(fit.law, fit.protocol);
    }
  }
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const auto& [law, protocol] = kinds[k];
    const std::string name = protocol == "published" ? "published protocol" : law + " law";
    const auto fit_of = [&](std::size_t g) -> const PooledGroup::OfFit* {
      for (const PooledGroup::OfFit& fit : of.groups()[g].fits) {
        if (fit.law == law && fit.protocol == protocol) return &fit;
      }
      return nullptr;
    };
    for (std::size_t panel = 0; panel < 2; ++panel) {
      add_over_conditions(
          over, name, marked(k), panel,
          [&](std::size_t g) {
            const PooledGroup::OfFit* fit = fit_of(g);
            return fit == nullptr ? Maybe{} : mean_of(pooled_value(fit->parameters, panel == 0 ? "mu_s" : "mu_k"));
          },
          chart);
    }
    add_over_conditions(
        over, name, marked(k), 2,
        [&](std::size_t g) {
          const PooledGroup::OfFit* fit = fit_of(g);
          return fit == nullptr ? Maybe{} : Maybe{drop_of(of.runs, of.groups()[g], *fit)};
        },
        chart);
  }
  add_earlier(of, over, "mu_s", 0, chart);
  add_earlier(of, over, "mu_k", 1, chart);
  chart.height = 560;
  return chart;
}

/// alpha and beta, the rest of Table 4 of [D]: a panel a law, both protocols.
Chart decay_chart(const DrawnCampaign& of, const OverConditions& over) {
  Chart chart = over_conditions(over, "table4-decay", "Decay factors of the laws");
  chart.panels.clear();
  for (const BaseLaw law : {BaseLaw::exponential, BaseLaw::fractional}) {
    std::string name, unit;
    const auto value_of_group = [&](std::size_t g, const char* protocol) {
      for (const PooledGroup::OfFit& fit : of.groups()[g].fits) {
        if (fit.law != to_string(law) || fit.protocol != protocol || fit.parameters.size() < 3) continue;
        name = fit.parameters[2].name, unit = fit.parameters[2].unit;
        return mean_of(&fit.parameters[2]);
      }
      return Maybe{};
    };
    const std::size_t panel = chart.panels.size();
    const auto add = [&](const char* line, const char* protocol, std::size_t k) {
      add_over_conditions(
          over, line, marked(k), panel, [&](std::size_t g) { return value_of_group(g, protocol); }, chart);
    };
    add("joint fit", "joint", 0);
    add("published protocol", "published", 1);
    if (name.empty()) continue;
    add_earlier(of, over, name, panel, chart);
    chart.panels.push_back({.axis = {.quantity = name, .unit = unit}});
  }
  chart.height = 110 + 180 * static_cast<int>(std::max<std::size_t>(1, chart.panels.size()));
  return chart;
}

/// A chart with a panel for each of the groups shown.
template <class AddLine>
Chart panels_of_groups(const DrawnCampaign& of, const std::string& id, const std::string& title, const ChartAxis& x,
                       const ChartAxis& y, AddLine&& add) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.x = x;
  chart.panels.clear();
  for (const std::size_t g : of.shown) {
    std::string run;
    const auto figures = figures_of_group(of, g, &run);
    if (!figures) continue;
    ChartLine line{of.name_of(g), {}, {}, stroke_of(chart.panels.size())};
    line.stroke.dash = Dash::solid;  // each has a panel of its own
    add(*figures, line);
    if (line.x.empty()) continue;
    line.panel = chart.panels.size();
    chart.panels.push_back({.axis = y});
    chart.note += (chart.note.empty() ? "From top to bottom: " : "; ") + of.name_of(g) + " (" + run + ")";
    chart.lines.push_back(std::move(line));
  }
  if (!chart.note.empty()) chart.note += ".";
  chart.height = 110 + 120 * static_cast<int>(std::max<std::size_t>(1, chart.panels.size()));
  return chart;
}

Chart cycles_chart(const DrawnCampaign& of, bool of_velocity) {
  return panels_of_groups(of, of_velocity ? "fig06-velocity" : "fig08-friction",
                          of_velocity ? "Relative velocity over three cycles" : "Friction over three cycles",
                          {.quantity = "time", .unit = "s", .from_zero = true, .digits = 7},
                          of_velocity ? ChartAxis{.quantity = "v_{r}", .unit = "mm/s"}
                                      : ChartAxis{.quantity = "mu", .unit = of.friction_unit()},
                          [&](const RunFigures& f, ChartLine& line) {
                            line.x = f.time;
                            if (!line.x.empty()) {
                              for (double& t : line.x) t -= f.time.front();
                            }
                            line.y = of_velocity ? f.velocity : f.friction;
                          });
}

Chart spectrum_chart(const DrawnCampaign& of) {
  return panels_of_groups(of, "fig07-spectrum", "Amplitude spectrum of the relative velocity",
                          {.quantity = "frequency", .unit = "Hz", .from_zero = true},
                          {.quantity = "v_{r}", .unit = "mm/s", .from_zero = true},
                          [](const RunFigures& f, ChartLine& line) {
                            for (std::size_t k = 0; k < f.spectrum.size(); ++k) {
                              line.x.push_back(static_cast<double>(k) * f.spectrum_step);
                              line.y.push_back(f.spectrum[k]);
                            }
                          });
}

void add_drawn(Chart chart, ReportSection& section) {
  if (!chart.lines.empty()) section.items.emplace_back(std::move(chart));
}

/// Measured and fitted friction of a run over v_r (Fig 10 and 11 of [D]).
Chart friction_chart(const RunFigures& f, const std::string& unit) {
  Chart chart;
  chart.x = {.quantity = "v_{r}", .unit = "mm/s", .from_zero = true};
  chart.panels[0].axis = {.quantity = "mu", .unit = unit};
  std::vector<double> middle;
  for (std::size_t k = 0; k < f.bin_samples.size(); ++k) middle.push_back((static_cast<double>(k) + 0.5) * f.bin_width);
  ChartLine measured{"measured", middle, f.bin_friction, {.symbol = Symbol::circle, .size = 5}};
  measured.stroke.joined = false;
  chart.lines.push_back(std::move(measured));
  std::size_t k = 1;
  for (const ErrorCurve& curve : f.errors) {
    const bool published = curve.protocol == "published";
    ChartLine line{curve.law + (published ? ", published protocol" : ""), middle, curve.fitted, stroke_of(k++)};
    line.shown = !published;
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

/// Relative error of the mean friction of a bin (Fig 12 of [D]).
Chart error_chart(const RunFigures& f) {
  Chart chart;
  chart.x = {.quantity = "v_{r}", .unit = "mm/s", .from_zero = true};
  chart.panels[0].axis = {.quantity = "relative error", .unit = "1", .from_zero = true};
  std::size_t k = 1;
  for (const ErrorCurve& curve : f.errors) {
    const bool published = curve.protocol == "published";
    Stroke stroke = marked(k++);
    stroke.size = 4;
    ChartLine line{curve.law + (published ? ", published protocol" : ""), {}, {}, stroke};
    line.shown = !published;
    for (std::size_t b = 0; b < f.bin_samples.size(); ++b) {
      line.x.push_back((static_cast<double>(b) + 0.5) * f.bin_width);
      line.y.push_back(std::abs((f.bin_friction[b] - curve.fitted[b]) / f.bin_friction[b]));
    }
    chart.lines.push_back(std::move(line));
  }
  chart.marks.push_back({published_error_limit, false, Dash::dashed, "0.08 of [D]", 0});
  return chart;
}

}  // namespace

ReportSection motion_figures(const DrawnCampaign& of) {
  ReportSection section{"motion", "Motion and friction under each of the conditions", {}};
  const OverConditions over(of.groups());
  add_drawn(rms_chart(of, over), section);
  add_drawn(cycles_chart(of, true), section);
  add_drawn(spectrum_chart(of), section);
  add_drawn(fundamental_chart(of, over), section);
  add_drawn(cycles_chart(of, false), section);
  add_drawn(levels_chart(of, over), section);
  add_drawn(decay_chart(of, over), section);
  return section;
}

ReportSection law_figures(const DrawnCampaign& of) {
  ReportSection section{"laws", "Measured and fitted friction, and the relative error", {}};
  if (of.shown.size() < of.groups().size()) {
    section.items.emplace_back(ReportText{
        fmt::format("Runs of {} of {} conditions are drawn; the tables have all.", of.shown.size(), of.groups().size()),
        ReportText::Kind::soft});
  }
  for (std::size_t k = 0; k < of.shown.size(); ++k) {
    std::string run;
    const auto figures = figures_of_group(of, of.shown[k], &run);
    if (!figures || figures->errors.empty()) continue;
    Chart friction = friction_chart(*figures, of.friction_unit()), error = error_chart(*figures);
    friction.id = fmt::format("fig10-friction-{}", k + 1);
    friction.title = "Friction over velocity, " + of.name_of(of.shown[k]);
    friction.note = "Fig 10 and 11 of [D]: means in bins of v_r of " + run + ", and what the laws say there.";
    error.id = fmt::format("fig12-error-{}", k + 1);
    error.title = "Relative error (Eq 5), " + of.name_of(of.shown[k]);
    error.note = "Of the mean friction of each bin.";
    friction.half = error.half = true;
    section.items.emplace_back(std::move(friction));
    section.items.emplace_back(std::move(error));
  }
  return section;
}

}  // namespace tribofit
