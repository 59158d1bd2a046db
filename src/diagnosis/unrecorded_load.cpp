#include "unrecorded_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "limits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::diagnosis {
namespace {

/// Friction of every cycle at break-away and where its slip is fastest, over the usual.
struct Levels {
  std::vector<double> break_away, slip;
};

double fast_friction(const Motion& motion, const Cycle& cycle) {
  double sum = 0, count = 0;
  for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) {
    if (cycle.direction * motion.relative_velocity[i] < limits::kFastSlip * cycle.peak_velocity) continue;
    sum += cycle.direction * motion.friction[i], count += 1;
  }
  return sum / count;
}

void add_levels(const Record& record, Levels& levels) {
  std::vector<double> break_away, slip;
  for (const Cycle& cycle : record.segmentation->cycles) {
    if (!record.segmentation->is_selected(cycle) || !(cycle.stick.size() > 0) || !cycle.slip_complete) continue;
    const double fast = fast_friction(*record.motion, cycle);
    if (!std::isfinite(cycle.break_away_friction) || !std::isfinite(fast)) continue;
    break_away.push_back(cycle.break_away_friction), slip.push_back(fast);
  }
  if (break_away.size() < limits::kFewestCycles) return;
  const auto relative = [](std::vector<double>& values) {
    const double middle = median(values);
    for (double& value : values) value = value / middle - 1;
  };
  relative(break_away), relative(slip);
  levels.break_away.insert(levels.break_away.end(), break_away.begin(), break_away.end());
  levels.slip.insert(levels.slip.end(), slip.begin(), slip.end());
}

/// Root mean square of what both do together; 0: they do not.
double swing_of(const Levels& levels) {
  double squares = 0, others = 0, products = 0;
  const std::size_t n = levels.slip.size();
  for (std::size_t k = 0; k < n; ++k) {
    squares += levels.slip[k] * levels.slip[k];
    others += levels.break_away[k] * levels.break_away[k];
    products += levels.slip[k] * levels.break_away[k];
  }
  if (n == 0 || !(squares > 0) || !(others > 0)) return 0;
  const double swing = std::sqrt(squares / static_cast<double>(n)), slope = std::sqrt(others / squares);
  const bool in_proportion = products / std::sqrt(squares * others) > limits::kSwingsTogether &&
                             slope > 1 / limits::kSwingsAlike && slope < limits::kSwingsAlike;
  return in_proportion && swing > limits::kLeastSwing ? swing : 0;
}

}  // namespace

double common_swing(std::span<const Record> records) {
  const auto has_load = [](const Record& record) { return !record.motion->load.empty(); };
  if (std::any_of(records.begin(), records.end(), has_load)) return 0;
  Levels levels;
  for (const Record& record : records) add_levels(record, levels);
  return swing_of(levels);
}

void offer_load_variation(std::span<const Record> records, Diagnosis& diagnosis) {
  const auto has_load = [](const Record& record) { return !record.motion->load.empty(); };
  if (std::any_of(records.begin(), records.end(), has_load)) return;
  const std::span<const Effect> catalogue = effect_catalogue();
  for (EffectFinding& finding : diagnosis.effects) {
    const bool holds = finding.status == EffectStatus::found || finding.status == EffectStatus::equivalent;
    const auto is_change = [&](const Effect& effect) {
      const EffectInfo info = describe(effect);
      return info.key == finding.key &&
             std::any_of(info.parameters.begin(), info.parameters.end(),
                         [](const Parameter& p) { return p.search == ParameterSearch::moment_of_change; });
    };
    if (holds && std::any_of(catalogue.begin(), catalogue.end(), is_change))
      finding.reason += "; a step of the load that was not recorded does the same";
  }
  if (diagnosis.verdict != Verdict::unexplained) return;
  const double swing = common_swing(records);
  if (swing == 0) return;
  for (const Effect& effect : catalogue) {
    const EffectInfo info = describe(effect);
    const auto at = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                                 [&](const EffectFinding& finding) { return finding.key == info.key; });
    if (info.sketch.view != SketchView::load || at == diagnosis.effects.end()) continue;
    at->status = EffectStatus::possible;
    at->reason = fmt::format(
        "friction at break-away and in fast slip rises and falls together, by {:.1f} % from cycle to cycle: the load "
        "may vary; record the load",
        100 * swing);
    break;
  }
  diagnosis.next_experiment =
      "Record the normal load: friction swings in proportion at all speeds. " + diagnosis.next_experiment;
}

}  // namespace tribofit::diagnosis
