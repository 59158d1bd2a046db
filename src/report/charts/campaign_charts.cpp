#include <cmath>
#include <utility>

#include "campaign_parts.hpp"
#include "report/numbers.hpp"
#include "report/study_sentences.hpp"

namespace tribofit {

Chart scatter_chart(const DrawnCampaign& of, const std::string& law) {
  constexpr std::size_t kMostPoints = 300;
  Chart chart;
  chart.id = "scatter-" + law;
  chart.title = "The parameters of each run, " + law + " law";
  chart.note =
      "Joint protocol; bars: 95 % of the run's own error. Repeats that lie further apart differ from run to run.";
  chart.x = {.quantity = "run", .digits = 7};
  chart.panels.clear();
  for (std::size_t p = 0; chart.panels.size() == p; ++p) {  // as many as the law has
    std::string name, unit;
    for (std::size_t k = 0; k < of.shown.size(); ++k) {
      ChartLine line{
          .name = of.name_of(of.shown[k]), .stroke = marked(k, false), .bars = true, .panel = chart.panels.size()};
      const std::vector<std::size_t>& runs = of.groups()[of.shown[k]].runs;
      for (const std::size_t i : thinned(runs.size(), kMostPoints)) {
        const RunResult& run = of.runs[runs[i]];
        const ResultFit* fit = run.fit(law, "joint");
        if (fit == nullptr || fit->parameters.size() <= p || !fit->parameters[p].effect.empty()) continue;
        const ResultParameter& value = fit->parameters[p];
        name = value.name, unit = value.unit;
        const bool known = std::isfinite(value.lower95) && std::isfinite(value.upper95);
        line.add(static_cast<double>(run.position + 1), value.value);
        line.low.push_back(known ? value.lower95 : value.value);
        line.high.push_back(known ? value.upper95 : value.value);
      }
      if (!line.x.empty()) chart.lines.push_back(std::move(line));
    }
    if (!name.empty()) chart.panels.push_back({.axis = {.quantity = with_subscript(name), .unit = unit}});
  }
  chart.height = 110 + 130 * static_cast<int>(chart.panels.size());
  return chart;
}

}  // namespace tribofit
