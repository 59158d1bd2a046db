#include "report/charts/diagnosis_charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "diagnosis/conclusions.hpp"
#include "report/charts/styles.hpp"
#include "report/diagnosis_sentences.hpp"
#include "report/numbers.hpp"

namespace tribofit {
namespace {

/// Axis of errors.
ChartAxis error_axis(const DiagnosedTraces& result) {
  const bool force = !result.traces.empty() && friction_unit(result.traces.front().motion) == "N";
  return {"held-out error", force ? "N" : "1"};
}

std::vector<std::string> rung_names(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const Rung& rung : d.ladder) names.push_back(rung.added.empty() ? law_text(d) : "+ " + rung.added);
  return names;
}

Chart ladder_chart(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  Chart chart;
  chart.id = "ladder";
  chart.title = "The ladder: held-out error, as effects are added";
  chart.note = "Bars are one standard error. At the noise floor only noise and scatter from cycle to cycle are left.";
  chart.x.names = rung_names(d);
  chart.panels[0].axis = error_axis(result);
  chart.panels[0].axis.from_zero = true;
  ChartLine line{"held-out error", {}, {}, {Colour::blue, Dash::solid, Symbol::circle, 2, 10}};
  line.bars = true;
  for (std::size_t k = 0; k < d.ladder.size(); ++k) {
    const Rung& rung = d.ladder[k];
    const auto x = static_cast<double>(k);
    line.add(x, rung.held_out_rmse, rung.held_out_std_error);
    const double removed = k == 0 ? std::nan("") : removed_at(d, k);
    if (std::isfinite(removed)) {
      chart.labels.push_back({x, rung.held_out_rmse, share_text(removed) + " gone"});
    }
  }
  chart.lines.push_back(std::move(line));
  chart.marks.push_back({d.floor_rmse, false, Dash::dashed, "noise floor " + significant(d.floor_rmse, 3)});
  chart.half = true;
  return chart;
}

/// Shares of the law and of the final model beside the same variables.
Chart where_chart(const Diagnosis& d) {
  Chart chart{.id = "where",
              .title = "Where the error above the noise floor goes",
              .note = where_sentence(d.where) + " Shares overlap where variables go together.",
              .x = {"share", "%", 0, 105},
              .height = 120 + 34 * static_cast<int>(std::max<std::size_t>(3, d.where.size())),
              .half = true};
  ChartAxis& names = chart.panels[0].axis;
  ChartBars before{law_text(d), {}, Colour::blue, false}, after{"final model", {}, Colour::red, true};
  for (const Share& share : d.where) {
    names.names.push_back(share.variable);
    before.values.push_back(100 * share.share);
    const auto left = std::find_if(d.remaining.begin(), d.remaining.end(),
                                   [&](const Share& other) { return other.variable == share.variable; });
    after.values.push_back(left == d.remaining.end() ? 0 : 100 * left->share);
  }
  std::reverse(names.names.begin(), names.names.end());  // the largest on top
  std::reverse(before.values.begin(), before.values.end());
  std::reverse(after.values.begin(), after.values.end());
  chart.bars.push_back(std::move(before));
  if (d.ladder.size() > 1) chart.bars.push_back(std::move(after));
  return chart;
}

struct StatusStyle {
  EffectStatus status;
  Stroke stroke;
};
constexpr std::array<StatusStyle, 5> kStatuses = {
    StatusStyle{EffectStatus::found, dots(Colour::red, Symbol::circle, 10)},
    StatusStyle{EffectStatus::equivalent, dots(Colour::purple, Symbol::diamond, 10)},
    StatusStyle{EffectStatus::possible, dots(Colour::blue, Symbol::triangle_up, 9)},
    StatusStyle{EffectStatus::superseded, dots(Colour::green, Symbol::square, 9)},
    StatusStyle{EffectStatus::unsupported, dots(Colour::grey, Symbol::triangle_down, 9)}};

/// Held-out error with each candidate.
Chart candidates_chart(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  Chart chart;
  chart.id = "candidates";
  chart.title = "Each candidate: held-out error with it";
  chart.note =
      "At the rung where it was judged last; bars are one standard error, from cycle to cycle. Dashed: the noise "
      "floor; dotted: the bare law.";
  ChartAxis error = error_axis(result);
  error.digits = 6;
  chart.panels[0].axis = error;
  chart.panels[0].axis.from_zero = true;
  for (const auto& [status, stroke] : kStatuses) {
    std::vector<const EffectFinding*> own;
    for (const EffectFinding& finding : d.effects) {
      if (finding.status == status && std::isfinite(finding.held_out_rmse)) own.push_back(&finding);
    }
    if (own.empty()) continue;
    std::stable_sort(own.begin(), own.end(), [](const EffectFinding* a, const EffectFinding* b) {
      return a->held_out_rmse < b->held_out_rmse;
    });
    ChartLine line{std::string(status_text(status)), {}, {}, stroke};
    line.bars = true;
    for (const EffectFinding* finding : own) {
      line.add(static_cast<double>(chart.x.names.size()), finding->held_out_rmse, finding->held_out_std_error);
      chart.x.names.push_back(finding->key);
    }
    chart.lines.push_back(std::move(line));
  }
  chart.marks.push_back({d.floor_rmse, false, Dash::dashed, "noise floor"});
  if (!d.ladder.empty()) chart.marks.push_back({d.ladder.front().held_out_rmse, false, Dash::dotted, law_text(d)});
  chart.height = 420;
  return chart;
}

}  // namespace

std::vector<Chart> diagnosis_charts(const DiagnosedTraces& result) {
  std::vector<Chart> charts;
  const Diagnosis& d = result.diagnosis;
  if (!d.ladder.empty()) charts.push_back(ladder_chart(result));
  if (!d.where.empty()) charts.push_back(where_chart(d));
  Chart candidates = candidates_chart(result);
  if (!candidates.lines.empty()) charts.push_back(std::move(candidates));
  return charts;
}

}  // namespace tribofit
