#include "campaign_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "report/numbers.hpp"
#include "report/study_sentences.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kShownGroups = 6;

struct NumericCondition {
  Condition Conditions::*which;
  const char* quantity;
  const char* unit;
  double si;
};
constexpr std::array kNumeric = {NumericCondition{&Conditions::radius, "friction radius", "mm", kMillimetre},
                                 NumericCondition{&Conditions::speed, "speed", "rpm", kRpm},
                                 NumericCondition{&Conditions::load, "load", "N", 1}};

/// Values of a condition that differ by more than what a reading off a plateau does.
std::size_t count_of_values(std::span<const PooledGroup> groups, Condition Conditions::*which) {
  constexpr double kSame = 0.02;
  std::vector<double> values;
  for (const PooledGroup& group : groups) {
    const double value = (group.conditions.*which).value;
    if (!std::isfinite(value)) return 0;
    values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  std::size_t count = values.empty() ? 0 : 1;
  for (std::size_t k = 1; k < values.size(); ++k)
    count += static_cast<std::size_t>(values[k] > (1 + kSame) * values[k - 1]);
  return count;
}

/// The conditions of a group without one; nor those that were read off the record.
std::string without(const PooledGroup& group, Condition Conditions::*which) {
  Conditions rest = group.conditions;
  rest.*which = {};
  if (rest.speed.source == "plateau") rest.speed = {};
  const bool any = rest.radius.known() || rest.speed.known() || rest.load.known() || !group.others.empty();
  return any ? conditions_text(rest, group.others) : "";
}

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

OverConditions::OverConditions(std::span<const PooledGroup> groups) {
  std::size_t most = 1;
  const NumericCondition* chosen = nullptr;
  for (const NumericCondition& condition : kNumeric) {
    const std::size_t count = count_of_values(groups, condition.which);
    if (count > most) most = count, chosen = &condition;
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    x_.push_back(chosen != nullptr ? (groups[g].conditions.*(chosen->which)).value / chosen->si
                                   : static_cast<double>(g));
    const std::string name = chosen != nullptr ? without(groups[g], chosen->which) : "";
    auto found = std::find_if(series_.begin(), series_.end(), [&](const Series& s) { return s.name == name; });
    if (found == series_.end()) found = series_.insert(series_.end(), {name, {}, {}});
    found->groups.push_back(g);
  }
  for (Series& one : series_) {
    std::stable_sort(one.groups.begin(), one.groups.end(), [&](std::size_t a, std::size_t b) { return x_[a] < x_[b]; });
    for (const std::size_t g : one.groups) one.x.push_back(x_[g]);
  }
  if (chosen != nullptr) {
    axis_ = {.quantity = chosen->quantity, .unit = chosen->unit};
    return;
  }
  axis_ = {.quantity = "conditions"};
  for (const PooledGroup& group : groups) axis_.names.push_back(conditions_text(group.conditions, group.others));
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
