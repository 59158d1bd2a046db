#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "report/campaign_parts.hpp"
#include "report/charts/styles.hpp"
#include "report/numbers.hpp"
#include "statistics/thinning.hpp"
#include "tribofit/campaign/pool.hpp"

namespace tribofit {
namespace {

using Maybe = std::optional<Estimate>;

/// "mu_s" as markup: "mu_{s}".
std::string with_subscript(const std::string& name) {
  const std::size_t at = name.find('_');
  return at == std::string::npos ? name : name.substr(0, at) + "_{" + name.substr(at + 1) + "}";
}

/// A chart over the conditions, panel by panel: lines of means with their standard errors, a line for each series of
/// conditions, and earlier values beside them.
class MeansChart {
 public:
  MeansChart(const DrawnCampaign& campaign, const OverConditions& over, std::string id, std::string title)
      : of_(campaign), over_(over), chart_{.id = std::move(id), .title = std::move(title)} {
    chart_.note = "Means over repeats; bars: one standard error.";
    chart_.x = {.quantity = over.quantity, .unit = over.unit, .names = over.names};
    chart_.panels.clear();
  }
  /// What is added from now on stands in a panel of its own.
  MeansChart& panel(std::string quantity, std::string unit) {
    chart_.panels.push_back({.quantity = std::move(quantity), .unit = std::move(unit)});
    return *this;
  }
  /// value: of a group, nothing where there is none.
  template <class Value>
  MeansChart& add(const std::string& name, std::size_t kind, Value value) {
    const bool alone = over_.series.size() == 1;
    std::size_t k = 0;
    for (const OverConditions::Series& series : over_.series) {
      ChartLine& line = new_line(alone || series.name.empty() ? name : name + ", " + series.name, marked(kind));
      if (!alone) line.stroke.dash = stroke_of(k++).dash;
      for (std::size_t i = 0; i < series.groups.size(); ++i) {
        const Maybe measure = value(series.groups[i]);
        if (measure && std::isfinite(measure->value)) line.add(series.x[i], measure->value, measure->std_error);
      }
    }
    return *this;
  }
  /// The measure of that name, and earlier values of it.
  MeansChart& measure(const char* measure) {
    add("this campaign", 0, [&](std::size_t g) { return pooled_mean(of_.groups[g].measures, measure); });
    return earlier(measure);
  }
  /// The earlier values of that name, one for each of the conditions.
  MeansChart& earlier(const std::string& name) {
    if (of_.earlier == nullptr) return *this;
    ChartLine& line = new_line(of_.earlier_name(), dots(Colour::red, Symbol::cross, 9));
    std::vector<bool> met(of_.groups.size(), false);
    for (const ComparedValue& v : of_.earlier->values) {
      if (v.earlier.name != name || met[v.group]) continue;
      met[v.group] = true;
      line.add(over_.x[v.group], v.earlier.value, v.earlier.std_error);
    }
    return *this;
  }
  Chart chart(const std::string& note = "") {
    chart_.note += note;
    return std::move(chart_);
  }

 private:
  ChartLine& new_line(const std::string& name, const Stroke& stroke) {
    return chart_.line(name, stroke, chart_.panels.size() - 1);
  }

  const DrawnCampaign& of_;
  const OverConditions& over_;
  Chart chart_;
};

/// Fig 9 of [D]: both protocols, as the joint one has neither bias.
Chart levels_chart(const DrawnCampaign& campaign, const OverConditions& over) {
  MeansChart chart(campaign, over, "fig09-static-kinetic", "Static and kinetic friction and their difference");
  const auto kinds = kinds_of_levels(campaign.groups);
  const auto add_kinds = [&](auto value) {
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const std::string &law = kinds[k].first, &protocol = kinds[k].second;
      chart.add(protocol == to_string(Protocol::published) ? protocol_text(Protocol::published) : law + " law", k,
                [&](std::size_t g) {
                  const PooledGroup::OfFit* fit = campaign.groups[g].fit(law, protocol);
                  return fit == nullptr ? Maybe{} : value(campaign.groups[g], *fit);
                });
    }
  };
  const auto add_level = [&](const char* name) {
    add_kinds([&](const PooledGroup&, const auto& fit) { return pooled_mean(fit.parameters, name); });
    chart.earlier(name);
  };
  const std::string unit = campaign.friction_unit();
  for (const char* level : {static_level_name, kinetic_level_name}) {
    chart.panel(with_subscript(level), unit);
    add_level(level);
  }
  chart.panel("mu_{s} - mu_{k}", unit);
  add_kinds([&](const PooledGroup& group, const auto& fit) { return Maybe{drop_of(campaign.runs, group, fit)}; });
  return chart.chart();
}

/// What laws have besides mu_s and mu_k (the rest of Table 4 of [D]): a panel each, both protocols.
Chart other_parameters_chart(const DrawnCampaign& campaign, const OverConditions& over) {
  MeansChart chart(campaign, over, "table4-decay", "Other parameters of the laws");
  std::vector<std::string> names;
  for (const OtherParameter& other : other_parameters(campaign.groups)) {
    const auto value_by = [&](Protocol protocol) {
      return [&, protocol](std::size_t g) {
        const PooledGroup::OfFit* own = campaign.groups[g].fit(other.law, to_string(protocol));
        return own == nullptr ? Maybe{} : pooled_mean(own->parameters, other.name);
      };
    };
    chart.panel(with_subscript(other.name), other.unit)
        .add(protocol_text(Protocol::joint), 0, value_by(Protocol::joint));
    chart.add(protocol_text(Protocol::published), 1, value_by(Protocol::published)).earlier(other.name);
    names.push_back(fmt::format("{} of the {} law", other.name, other.law));
  }
  return chart.chart(fmt::format(" From top to bottom: {}.", fmt::join(names, ", ")));
}

/// A chart with a panel for each of the groups shown; add: from the figures of a run to a line.
template <class Add>
Chart panels_of_groups(const DrawnCampaign& campaign, const char* id, const char* title, ChartAxis x,
                       const ChartAxis& y, Add add) {
  Chart chart{.id = id, .title = title, .x = std::move(x), .panels = {}};
  std::vector<std::string> from;
  for (const std::size_t g : campaign.shown) {
    const auto drawn = first_figures(campaign.results, campaign.runs, campaign.groups[g]);
    if (!drawn) continue;
    const std::string conditions = conditions_text(campaign.groups[g]);
    ChartLine& line = chart.line(conditions, stroke_of(chart.panels.size()), chart.panels.size());
    line.stroke.dash = Dash::solid;  // each has a panel of its own
    add(drawn->figures, line);
    if (line.x.empty()) {
      chart.lines.pop_back();
      continue;
    }
    chart.panels.push_back(y);
    from.push_back(fmt::format("{} ({})", conditions, drawn->run));
  }
  if (!from.empty()) chart.note = fmt::format("From top to bottom: {}.", fmt::join(from, "; "));
  return chart;
}

Chart cycles_chart(const DrawnCampaign& campaign, const char* id, const char* title, const ChartAxis& y,
                   std::vector<double> RunFigures::*channel) {
  return panels_of_groups(campaign, id, title, {.quantity = "time", .unit = "s", .from_zero = true}, y,
                          [&](const RunFigures& f, ChartLine& line) {
                            for (const double t : f.time) line.x.push_back(t - f.time.front());
                            line.y = f.*channel;
                          });
}

Chart spectrum_chart(const DrawnCampaign& campaign) {
  return panels_of_groups(campaign, "fig07-spectrum", "Amplitude spectrum of the relative velocity",
                          {.quantity = "frequency", .unit = "Hz", .from_zero = true},
                          {.quantity = "v_{r}", .unit = "mm/s", .from_zero = true},
                          [](const RunFigures& f, ChartLine& line) {
                            for (std::size_t k = 0; k < f.spectrum.size(); ++k) {
                              line.add(static_cast<double>(k) * f.spectrum_step, f.spectrum[k]);
                            }
                          });
}

/// Measured and fitted friction of a run over v_r (Fig 10 and 11 of [D]), and the relative error of the mean friction
/// of each bin (Fig 12); the per-cycle extremes are switched off at first.
void add_run(const FiguresOfRun& run, const std::string& conditions, const std::string& unit, std::size_t number,
             ReportSection& section) {
  const RunFigures& f = run.figures;
  const ChartAxis speed{.quantity = "v_{r}", .unit = "mm/s", .from_zero = true};
  Chart friction = half_chart(fmt::format("fig10-friction-{}", number), "Friction over velocity, " + conditions, speed,
                              {"mu", unit});
  friction.note = "Means in bins of v_r of " + run.run + ", and what the laws say there.";
  Chart error = half_chart(fmt::format("fig12-error-{}", number), "Relative error, " + conditions, speed,
                           {.quantity = "relative error", .unit = "1", .from_zero = true});
  error.note = "Of the mean friction of each bin.";
  error.marks = {{published_error_limit, false, Dash::dashed, "8 %", 0}};
  friction.line("measured", dots(Colour::black, Symbol::circle)).y = f.bin_friction;
  for (std::size_t k = 0; k < f.errors.size(); ++k) {
    const ErrorCurve& curve = f.errors[k];
    const bool published = curve.protocol == to_string(Protocol::published);
    const std::string name = curve.law + (published ? ", " + protocol_text(Protocol::published) : "");
    friction.line(name, stroke_of(k + 1)).y = curve.fitted;
    ChartLine& errors = error.line(name, marked(k + 1));
    errors.stroke.size = 4;
    for (std::size_t b = 0; b < f.bin_friction.size(); ++b) errors.y.push_back(f.error_of_mean(curve, b));
    errors.shown = friction.lines.back().shown = !published;
  }
  for (Chart* chart : {&friction, &error}) {
    for (ChartLine& line : chart->lines) {
      for (std::size_t b = 0; b < f.bin_samples.size(); ++b)
        line.x.push_back((static_cast<double>(b) + 0.5) * f.bin_width);
    }
    section.add(std::move(*chart));
  }
}

}  // namespace

DrawnCampaign::DrawnCampaign(const ResultReader& all_results, std::span<const RunResult> all_runs, const Pooled& pooled,
                             const std::optional<ComparisonReport>& comparison)
    : results(all_results), runs(all_runs), groups(pooled.groups), earlier(comparison ? &comparison->values : nullptr) {
  shown = OverConditions(groups).some(chart_detail.shown_groups);
}

std::string DrawnCampaign::earlier_name() const {
  return earlier == nullptr ? "" : std::filesystem::path(earlier->path).filename().string();
}

ReportSection motion_figures(const DrawnCampaign& campaign) {
  ReportSection section{"motion", "Motion and friction under each of the conditions", {}};
  const OverConditions over(campaign.groups);
  section.add(MeansChart(campaign, over, "fig05-rms-velocity", "RMS velocity of the block")
                  .panel("RMS of v_{b}", "mm/s")
                  .measure("rms_velocity")
                  .chart());
  section.add(cycles_chart(campaign, "fig06-velocity", "Relative velocity over three cycles",
                           {.quantity = "v_{r}", .unit = "mm/s"}, &RunFigures::velocity));
  section.add(spectrum_chart(campaign));
  section.add(
      MeansChart(campaign, over, "fig07-fundamental", "Stick-slip frequency and amplitude")
          .panel("frequency", "Hz")
          .measure("frequency")
          .panel("fundamental", "mm/s")
          .add("this campaign", 0,
               [&](std::size_t g) { return fundamental_of(campaign.results, campaign.runs, campaign.groups[g]); })
          .panel("peak of v_{r}", "mm/s")
          .measure("amplitude")
          .chart(" The fundamental is the amplitude of the sine of that frequency in v_r."));
  section.add(cycles_chart(campaign, "fig08-friction", "Friction over three cycles",
                           {.quantity = "mu", .unit = campaign.friction_unit()}, &RunFigures::friction));
  section.add(levels_chart(campaign, over));
  section.add(other_parameters_chart(campaign, over));
  return section;
}

ReportSection law_figures(const DrawnCampaign& campaign) {
  ReportSection section{"laws", "Measured and fitted friction, and the relative error", {}};
  if (campaign.shown.size() < campaign.groups.size()) {
    section.soft(fmt::format("Runs of {} of {} conditions are drawn; the tables have all.", campaign.shown.size(),
                             campaign.groups.size()));
  }
  for (std::size_t k = 0; k < campaign.shown.size(); ++k) {
    const auto drawn = first_figures(campaign.results, campaign.runs, campaign.groups[campaign.shown[k]]);
    if (!drawn || drawn->figures.errors.empty()) continue;
    add_run(*drawn, conditions_text(campaign.groups[campaign.shown[k]]), campaign.friction_unit(), k + 1, section);
  }
  return section;
}

Chart scatter_chart(const DrawnCampaign& campaign, const std::string& law) {
  Chart chart{
      .id = "scatter-" + law,
      .title = "The parameters of each run, " + law + " law",
      .note =
          "Joint protocol; bars: 95 % of the run's own error. Repeats that lie further apart differ from run to run.",
      .x = {.quantity = "run"},
      .panels = {}};
  for (std::size_t p = 0; chart.panels.size() == p; ++p) {  // as many as the law has
    std::string name, unit;
    for (std::size_t k = 0; k < campaign.shown.size(); ++k) {
      ChartLine& line = chart.line(conditions_text(campaign.groups[campaign.shown[k]]), marked(k, false), p);
      const std::vector<std::size_t>& runs = campaign.groups[campaign.shown[k]].runs;
      for (const std::size_t i : thinned(runs.size(), chart_detail.runs)) {
        const RunResult& run = campaign.runs[runs[i]];
        const ResultFit* fit = run.fit(law, to_string(Protocol::joint));
        if (fit == nullptr || fit->parameters.size() <= p || !fit->parameters[p].effect.empty()) continue;
        const ResultParameter& value = fit->parameters[p];
        name = value.name, unit = value.unit;
        line.add(static_cast<double>(run.position + 1), value.value, 0);
        if (!std::isfinite(value.lower95) || !std::isfinite(value.upper95)) continue;
        line.low.back() = value.lower95;
        line.high.back() = value.upper95;
      }
    }
    if (!name.empty()) chart.panels.push_back({.quantity = with_subscript(name), .unit = unit});
  }
  return chart;
}

}  // namespace tribofit
