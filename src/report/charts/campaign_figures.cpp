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

/// A chart over the conditions: a line of means with their standard errors for each add().
class MeansChart {
 public:
  MeansChart(const DrawnCampaign& of, const OverConditions& over, std::string id, std::string title)
      : of_(of), over_(over), chart_{.id = std::move(id), .title = std::move(title)} {
    chart_.note = "Means over repeats; bars: one standard error.";
    chart_.x = axis_over(over);
    chart_.panels.clear();
  }
  /// What add() draws from now on stands in a panel of its own.
  MeansChart& panel(std::string quantity, std::string unit) {
    chart_.panels.push_back({.axis = {.quantity = std::move(quantity), .unit = std::move(unit)}});
    return *this;
  }
  template <class Value>
  MeansChart& add(const std::string& name, std::size_t kind, Value value) {
    add_over_conditions(over_, name, marked(kind), chart_.panels.size() - 1, value, chart_);
    return *this;
  }
  MeansChart& measure(const std::string& name, const char* measure) {
    return add(name, 0, [&](std::size_t g) { return mean_of(pooled_value(of_.groups()[g].measures, measure)); });
  }
  MeansChart& earlier(const std::string& name) {
    add_earlier(of_, over_, name, chart_.panels.size() - 1, chart_);
    return *this;
  }
  Chart chart(int height, const std::string& note = "") const {
    Chart out = chart_;
    out.height = height;
    out.note += note;
    return out;
  }

 private:
  const DrawnCampaign& of_;
  const OverConditions& over_;
  Chart chart_;
};

/// Law and protocol of every line of levels; per-cycle extremes give the same levels whatever the law.
std::vector<std::pair<std::string, std::string>> kinds_of_levels(std::span<const PooledGroup> groups) {
  std::vector<std::pair<std::string, std::string>> kinds;
  for (const PooledGroup& group : groups) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      const bool published = fit.protocol == "published";
      const auto same = [&](const auto& k) { return k.second == fit.protocol && (published || k.first == fit.law); };
      if (std::none_of(kinds.begin(), kinds.end(), same)) kinds.emplace_back(fit.law, fit.protocol);
    }
  }
  return kinds;
}

/// Fig 9 of [D]: both protocols, as the joint one has neither bias.
Chart levels_chart(const DrawnCampaign& of, const OverConditions& over) {
  MeansChart chart(of, over, "fig09-static-kinetic", "Static and kinetic friction and their difference");
  const auto kinds = kinds_of_levels(of.groups());
  const auto add_kinds = [&](auto value) {
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const auto& [law, protocol] = kinds[k];
      chart.add(protocol == "published" ? "per-cycle extremes" : law + " law", k, [&](std::size_t g) {
        const PooledGroup::OfFit* fit = fit_of(of.groups()[g], law, protocol);
        return fit == nullptr ? Maybe{} : value(of.groups()[g], *fit);
      });
    }
  };
  const auto add_level = [&](const char* name) {
    add_kinds([&](const PooledGroup&, const auto& fit) { return mean_of(pooled_value(fit.parameters, name)); });
    chart.earlier(name);
  };
  const std::string unit = of.friction_unit();
  chart.panel("mu_{s}", unit);
  add_level("mu_s");
  chart.panel("mu_{k}", unit);
  add_level("mu_k");
  chart.panel("mu_{s} - mu_{k}", unit);
  add_kinds([&](const PooledGroup& group, const auto& fit) { return Maybe{drop_of(of.runs, group, fit)}; });
  return chart.chart(560);
}

/// What the laws have besides mu_s and mu_k (alpha and beta, the rest of Table 4 of [D]): a panel each, both protocols.
Chart other_parameters_chart(const DrawnCampaign& of, const OverConditions& over) {
  MeansChart chart(of, over, "table4-decay", "Other parameters of the laws");
  std::vector<std::pair<std::string, std::string>> drawn;  // law and name
  for (const PooledGroup& group : of.groups()) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      for (const PooledValue& v : fit.parameters) {
        const bool is_level = v.name == "mu_s" || v.name == "mu_k",
                   known = std::count(drawn.begin(), drawn.end(), std::pair(fit.law, v.name)) > 0;
        if (is_level || known || !v.effect.empty()) continue;
        drawn.emplace_back(fit.law, v.name);
        const auto value_by = [&](const char* protocol) {
          return [&, protocol](std::size_t g) {
            const PooledGroup::OfFit* own = fit_of(of.groups()[g], fit.law, protocol);
            return own == nullptr ? Maybe{} : mean_of(pooled_value(own->parameters, v.name));
          };
        };
        chart.panel(with_subscript(v.name), v.unit).add("joint fit", 0, value_by("joint"));
        chart.add("per-cycle extremes", 1, value_by("published")).earlier(v.name);
      }
    }
  }
  std::string note = " From top to bottom: ";
  for (const auto& [law, name] : drawn)
    note += (&law == &drawn.front().first ? "" : ", ") + name + " of the " + law + " law";
  return chart.chart(110 + 180 * std::max(1, static_cast<int>(drawn.size())), note + ".");
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

Chart cycles_chart(const DrawnCampaign& of, const char* id, const char* title, ChartAxis y,
                   std::vector<double> RunFigures::*channel) {
  return panels_of_groups(of, id, title, {.quantity = "time", .unit = "s", .from_zero = true, .digits = 7}, y,
                          [&](const RunFigures& f, ChartLine& line) {
                            for (const double t : f.time) line.x.push_back(t - f.time.front());
                            line.y = f.*channel;
                          });
}

Chart spectrum_chart(const DrawnCampaign& of) {
  return panels_of_groups(of, "fig07-spectrum", "Amplitude spectrum of the relative velocity",
                          {.quantity = "frequency", .unit = "Hz", .from_zero = true},
                          {.quantity = "v_{r}", .unit = "mm/s", .from_zero = true},
                          [](const RunFigures& f, ChartLine& line) {
                            for (std::size_t k = 0; k < f.spectrum.size(); ++k) {
                              line.add(static_cast<double>(k) * f.spectrum_step, f.spectrum[k]);
                            }
                          });
}

/// Over v_r in bins of a run, a line a fit; those of the per-cycle extremes are switched off at first.
template <class Value>
void add_fits(const RunFigures& f, bool with_symbols, Value value, Chart& chart) {
  chart.x = {.quantity = "v_{r}", .unit = "mm/s", .from_zero = true};
  chart.half = true;
  std::size_t k = 1;
  for (const ErrorCurve& curve : f.errors) {
    const bool published = curve.protocol == "published";
    ChartLine line{.name = curve.law + (published ? ", per-cycle extremes" : ""),
                   .stroke = with_symbols ? marked(k) : stroke_of(k),
                   .shown = !published};
    line.stroke.size = 4;
    for (std::size_t b = 0; b < f.bin_samples.size(); ++b) {
      line.add((static_cast<double>(b) + 0.5) * f.bin_width, value(curve, b));
    }
    chart.lines.push_back(std::move(line));
    ++k;
  }
}

/// Measured and fitted friction of a run over v_r (Fig 10 and 11 of [D]).
Chart friction_chart(const RunFigures& f, const std::string& unit) {
  Chart chart{.panels = {{.axis = {.quantity = "mu", .unit = unit}}}};
  ChartLine measured{.name = "measured", .y = f.bin_friction, .stroke = dots(Colour::black, Symbol::circle)};
  for (std::size_t b = 0; b < f.bin_samples.size(); ++b) {
    measured.x.push_back((static_cast<double>(b) + 0.5) * f.bin_width);
  }
  chart.lines.push_back(std::move(measured));
  add_fits(
      f, false, [](const ErrorCurve& curve, std::size_t b) { return curve.fitted[b]; }, chart);
  return chart;
}

/// Relative error of the mean friction of a bin (Fig 12 of [D]).
Chart error_chart(const RunFigures& f) {
  Chart chart{.note = "Of the mean friction of each bin.",
              .panels = {{.axis = {.quantity = "relative error", .unit = "1", .from_zero = true}}},
              .marks = {{published_error_limit, false, Dash::dashed, "0.08 of [D]", 0}}};
  const auto error = [&](const ErrorCurve& curve, std::size_t b) {
    return std::abs((f.bin_friction[b] - curve.fitted[b]) / f.bin_friction[b]);
  };
  add_fits(f, true, error, chart);
  return chart;
}

void add_drawn(Chart chart, ReportSection& section) {
  if (!chart.lines.empty()) section.items.emplace_back(std::move(chart));
}

}  // namespace

ReportSection motion_figures(const DrawnCampaign& of) {
  ReportSection section{"motion", "Motion and friction under each of the conditions", {}};
  const OverConditions over(of.groups());
  add_drawn(MeansChart(of, over, "fig05-rms-velocity", "RMS velocity of the block")
                .panel("RMS of v_{b}", "mm/s")
                .measure("RMS of v_b", "rms_velocity")
                .chart(340),
            section);
  add_drawn(cycles_chart(of, "fig06-velocity", "Relative velocity over three cycles",
                         {.quantity = "v_{r}", .unit = "mm/s"}, &RunFigures::velocity),
            section);
  add_drawn(spectrum_chart(of), section);
  const std::string own = "this campaign";
  add_drawn(MeansChart(of, over, "fig07-fundamental", "Stick-slip frequency and amplitude")
                .panel("frequency", "Hz")
                .measure(own, "frequency")
                .earlier("frequency")
                .panel("fundamental", "mm/s")
                .add(own, 0, [&](std::size_t g) { return fundamental_of(of.results, of.runs, of.groups()[g]); })
                .panel("peak of v_{r}", "mm/s")
                .measure(own, "amplitude")
                .earlier("amplitude")
                .chart(600, " The fundamental is the amplitude of the sine of that frequency in v_r."),
            section);
  add_drawn(cycles_chart(of, "fig08-friction", "Friction over three cycles",
                         {.quantity = "mu", .unit = of.friction_unit()}, &RunFigures::friction),
            section);
  add_drawn(levels_chart(of, over), section);
  add_drawn(other_parameters_chart(of, over), section);
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
    section.items.emplace_back(std::move(friction));
    section.items.emplace_back(std::move(error));
  }
  return section;
}

}  // namespace tribofit
