#include "campaign_parts.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "report/numbers.hpp"
#include "report/study_sentences.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kShownGroups = 6;

}  // namespace

std::string DrawnCampaign::name_of(std::size_t group) const {
  const PooledGroup& g = pooled.groups[group];
  return conditions_text(g.conditions, g.others);
}

std::string DrawnCampaign::earlier_name() const {
  return comparison == nullptr ? "" : std::filesystem::path(comparison->values.path).filename().string();
}

DrawnCampaign drawn_campaign(const ResultReader& results, std::span<const RunResult> runs, const Pooled& pooled,
                             const std::optional<ComparisonReport>& comparison) {
  std::vector<std::size_t> order, shown;  // as the charts over the conditions have them
  const OverConditions over(pooled.groups);
  for (const OverConditions::Series& series : over.series()) {
    order.insert(order.end(), series.groups.begin(), series.groups.end());
  }
  for (const std::size_t k : thinned(order.size(), kShownGroups)) shown.push_back(order[k]);
  return {results, runs, pooled, comparison ? &*comparison : nullptr, std::move(shown)};
}

ChartAxis axis_over(const OverConditions& over) {
  return {.quantity = over.quantity(), .unit = over.unit(), .names = over.names()};
}

void add_over_conditions(const OverConditions& over, const std::string& name, const Stroke& stroke, std::size_t panel,
                         const std::function<std::optional<ResultMeasure>(std::size_t group)>& value, Chart& chart) {
  const bool alone = over.series().size() == 1;
  std::size_t k = 0;
  for (const OverConditions::Series& series : over.series()) {
    ChartLine line{.name = alone || series.name.empty() ? name : name + ", " + series.name,
                   .stroke = stroke,
                   .bars = true,
                   .panel = panel};
    if (!alone) line.stroke.dash = stroke_of(k++).dash;
    for (std::size_t i = 0; i < series.groups.size(); ++i) {
      const auto measure = value(series.groups[i]);
      if (measure && std::isfinite(measure->value)) line.add(series.x[i], measure->value, measure->std_error);
    }
    if (!line.x.empty()) chart.lines.push_back(std::move(line));
  }
}

void add_earlier(const DrawnCampaign& of, const OverConditions& over, const std::string& name, std::size_t panel,
                 Chart& chart) {
  if (of.comparison == nullptr) return;
  ChartLine line{
      .name = of.earlier_name(), .stroke = dots(Colour::red, Symbol::cross, 9), .bars = true, .panel = panel};
  std::vector<bool> met(of.groups().size(), false);
  for (const ComparedValue& v : of.comparison->values.values) {
    if (v.earlier.name != name || met[v.group]) continue;
    met[v.group] = true;
    line.add(over.x_of(v.group), v.earlier.value, v.earlier.std_error);
  }
  if (!line.x.empty()) chart.lines.push_back(std::move(line));
}

}  // namespace tribofit
