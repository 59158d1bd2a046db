#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "diagnosis/conclusions.hpp"
#include "report/charts/styles.hpp"
#include "report/diagnosis_parts.hpp"
#include "report/numbers.hpp"

namespace tribofit {
namespace {

/// A chart of held-out errors beside the noise floor.
Chart errors_chart(const DiagnosedTraces& result, const char* id, const char* title, const char* note) {
  const std::string unit = result.traces.empty() ? "1" : friction_unit(result.traces.front().motion);
  return {.id = id,
          .title = title,
          .note = note,
          .panels = {{.quantity = "held-out error", .unit = unit, .from_zero = true}},
          .marks = {{result.diagnosis.floor_rmse, false, Dash::dashed, "noise floor"}}};
}

/// Of what was fitted, in the order of EffectStatus.
constexpr std::array<Stroke, 5> kStatusStrokes = {
    dots(Colour::red, Symbol::circle, 10), dots(Colour::purple, Symbol::diamond, 10),
    dots(Colour::blue, Symbol::triangle_up, 9), dots(Colour::green, Symbol::square, 9),
    dots(Colour::grey, Symbol::triangle_down, 9)};

}  // namespace

Chart ladder_chart(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  Chart chart = errors_chart(
      result, "ladder", "The ladder: held-out error, as effects are added",
      "Bars are one standard error. At the noise floor only noise and scatter from cycle to cycle are left.");
  ChartLine& line = chart.line("held-out error", {Colour::blue, Dash::solid, Symbol::circle, 2, 10});
  line.bars = true;
  for (std::size_t k = 0; k < d.ladder.size(); ++k) {
    const Rung& rung = d.ladder[k];
    const auto x = static_cast<double>(k);
    chart.x.names.push_back(rung.added.empty() ? law_text(d) : "+ " + rung.added);
    line.add(x, rung.held_out_rmse, rung.held_out_std_error);
    const double removed = k == 0 ? std::nan("") : removed_at(d, k);
    if (std::isfinite(removed)) {
      chart.labels.push_back({x, rung.held_out_rmse, share_text(removed) + " gone"});
    }
  }
  chart.marks[0].text += " " + significant(d.floor_rmse, 3);
  chart.half = true;
  return chart;
}

Chart where_chart(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  Chart chart{.id = "where",
              .title = "Where the error goes: what it varies with",
              .note = where_sentence(d.where) +
                      " Each bar is the error that a free function of the variable would take away; on top the whole "
                      "held-out error. Bars overlap where variables go together.",
              .x = {.quantity = "error", .unit = level_unit(result).empty() ? "1" : "N", .from_zero = true},
              .marks = {{d.floor_rmse, true, Dash::dashed, "noise floor"}},
              .height = 150 + 40 * static_cast<int>(std::max<std::size_t>(3, d.where.size() + 1)),
              .half = true};
  if (d.ladder.empty()) return chart;
  ChartAxis& names = chart.panels[0];
  ChartBars before{law_text(d), {}, Colour::blue, false}, after{"final model", {}, Colour::red, true};
  const Rung &first = d.ladder.front(), &last = d.ladder.back();
  for (auto share = d.where.rbegin(); share != d.where.rend(); ++share) {  // the largest on top
    names.names.emplace_back(to_string(share->variable));
    before.values.push_back(error_of_share(share->share, first.held_out_rmse, d.floor_rmse));
    const auto left = std::find_if(d.remaining.begin(), d.remaining.end(),
                                   [&](const Share& other) { return other.variable == share->variable; });
    after.values.push_back(left == d.remaining.end() ? 0
                                                     : error_of_share(left->share, last.held_out_rmse, d.floor_rmse));
  }
  names.names.emplace_back("whole error");
  before.values.push_back(first.held_out_rmse);
  after.values.push_back(last.held_out_rmse);
  chart.bars.push_back(std::move(before));
  if (d.ladder.size() > 1) chart.bars.push_back(std::move(after));
  return chart;
}

std::vector<const EffectFinding*> sorted_findings(const Diagnosis& d) {
  std::vector<const EffectFinding*> order;
  for (const EffectFinding& finding : d.effects) order.push_back(&finding);
  std::ranges::stable_sort(order, {}, [](const EffectFinding* finding) {
    return std::isfinite(finding->held_out_rmse) ? finding->held_out_rmse : 1e300;
  });
  return order;
}

Chart candidates_chart(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  Chart chart = errors_chart(result, "candidates", "Each candidate: held-out error with it",
                             "Sorted by the error. Each was judged last at a rung of its own, so errors of different "
                             "statuses need not compare: what is superseded helps alone but not beside what was added, "
                             "even where its error here is lower. Bars are one standard error, from cycle to cycle.");
  for (std::size_t k = 0; k < kStatusStrokes.size(); ++k) {
    chart.line(std::string(status_text(static_cast<EffectStatus>(k))), kStatusStrokes[k]).bars = true;
  }
  for (const EffectFinding* finding : sorted_findings(d)) {
    const auto status = static_cast<std::size_t>(finding->status);
    if (status >= kStatusStrokes.size() || !std::isfinite(finding->held_out_rmse)) continue;
    ChartLine& line = chart.lines[status];
    line.add(static_cast<double>(chart.x.names.size()), finding->held_out_rmse, finding->held_out_std_error);
    chart.x.names.push_back(finding->key);
  }
  if (!d.ladder.empty()) chart.marks.push_back({d.ladder.front().held_out_rmse, false, Dash::dotted, law_text(d)});
  chart.height = 420;
  return chart;
}

}  // namespace tribofit
