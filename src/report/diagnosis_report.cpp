#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "diagnosis/conclusions.hpp"
#include "diagnosis_sentences.hpp"
#include "numbers.hpp"
#include "report/charts/styles.hpp"
#include "report_parts.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kDrawnTraces = 8;

/// A chart of held-out errors beside the noise floor.
Chart errors_chart(const DiagnosedTraces& result, const char* id, const char* title, const char* note) {
  const std::string unit = result.traces.empty() ? "1" : friction_unit(result.traces.front().motion);
  return {.id = id,
          .title = title,
          .note = note,
          .panels = {{.axis = {.quantity = "held-out error", .unit = unit, .from_zero = true}}},
          .marks = {{result.diagnosis.floor_rmse, false, Dash::dashed, "noise floor"}}};
}

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

/// Error of the law and of the final model that goes with each variable, and the whole of it, on one scale.
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
  ChartAxis& names = chart.panels[0].axis;
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

/// Of what was fitted, in the order of EffectStatus.
constexpr std::array<Stroke, 5> kStatusStrokes = {
    dots(Colour::red, Symbol::circle, 10), dots(Colour::purple, Symbol::diamond, 10),
    dots(Colour::blue, Symbol::triangle_up, 9), dots(Colour::green, Symbol::square, 9),
    dots(Colour::grey, Symbol::triangle_down, 9)};

enum class Order { status, error };
/// By their status, then by their held-out error; or by that error alone.
std::vector<const EffectFinding*> sorted_findings(const Diagnosis& d, Order by) {
  std::vector<const EffectFinding*> order;
  for (const EffectFinding& finding : d.effects) order.push_back(&finding);
  const auto error = [](const EffectFinding* f) { return std::isfinite(f->held_out_rmse) ? f->held_out_rmse : 1e300; };
  std::stable_sort(order.begin(), order.end(), [&](const EffectFinding* a, const EffectFinding* b) {
    return by == Order::status && a->status != b->status ? a->status < b->status : error(a) < error(b);
  });
  return order;
}

/// Held-out error with each candidate.
Chart candidates_chart(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  Chart chart = errors_chart(result, "candidates", "Each candidate: held-out error with it",
                             "Sorted by the error. Each was judged last at a rung of its own, so errors of different "
                             "statuses need not compare: what is superseded helps alone but not beside what was added, "
                             "even where its error here is lower. Bars are one standard error, from cycle to cycle.");
  chart.panels[0].axis.digits = 6;
  for (std::size_t k = 0; k < kStatusStrokes.size(); ++k) {
    chart.line(std::string(status_text(static_cast<EffectStatus>(k))), kStatusStrokes[k]).bars = true;
  }
  for (const EffectFinding* finding : sorted_findings(d, Order::error)) {
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

ReportTable effects_table(const Diagnosis& d, const Motion& motion) {
  ReportTable table("What became of each effect");
  table.text({"effect", "status"}).numbers({"held-out error", "error taken away", "p"}).text({"parameters", "why"});
  table.folded = true;
  for (const EffectFinding* f : sorted_findings(d, Order::status)) {
    std::string parameters;
    if (f->status == EffectStatus::found || f->status == EffectStatus::equivalent) {
      for (const FitParameter& p : f->parameters) {
        parameters += (parameters.empty() ? "" : "; ") + p.parameter.name + " = " + value_text(p, motion);
      }
    }
    table.rows.push_back({f->key, std::string(status_text(f->status)), significant(f->held_out_rmse, 3),
                          percent(f->error_reduction), f->p_value < 1e-4 ? "< 0.0001" : significant(f->p_value, 2),
                          parameters, f->reason});
  }
  return table;
}

ReportSection diagnosis_section(const DiagnosedTraces& result, const Motion& motion) {
  const Diagnosis& d = result.diagnosis;
  ReportSection section{"diagnosis", "Effects found", {}};
  section.add(ladder_chart(result));
  section.add(where_chart(result));
  section.heading("Next experiment");
  section.plain(d.next_experiment.empty() ? "None is needed." : d.next_experiment);
  if (!d.formula.empty()) {
    section.heading("A closed form of what remains, for --formula");
    section.command(d.formula);
  }
  for (std::size_t k = d.runs_differ ? 1 : 0; k < d.messages.size(); ++k) section.plain(d.messages[k]);
  if (!d.confirmations.empty()) section.heading("On runs not used in the fit");
  for (const Confirmation& c : d.confirmations) {
    section.item(confirmation_sentence(c, result));
  }
  section.add(candidates_chart(result));
  section.add(effects_table(d, motion));
  return section;
}

}  // namespace

Report report_of(const DiagnosedTraces& result, const ReportOptions& options) {
  const Motion none;
  const Motion& motion = result.traces.empty() ? none : result.traces.front().motion;
  const std::size_t count = result.traces.size(), drawn = std::min(count, kDrawnTraces);
  const std::string title =
      count == 1 ? file_name(result.traces.front().path) : fmt::format("{} traces together", count);
  Report report = titled_report("diagnosis", title, "Diagnosis", diagnosis_verdict(result));
  for (const Identification& trace : result.traces) {
    report.warnings.insert(report.warnings.end(), trace.warnings.begin(), trace.warnings.end());
  }
  report.facts = model_facts("final model", result.fits, result.best, motion);
  if (count == 1) {
    const Facts record = facts_of(result.traces.front());
    report.facts.insert(report.facts.end(), record.begin(), record.end());
  }
  const auto bare = [&](const Fit& fit) { return fit.model.law() == result.diagnosis.law; };
  const std::vector<const Fit*> models = drawn_models(result.fits, result.best, 2, bare);
  const std::vector<const Fit*> curves = drawn_curves(models, result.rungs);
  TraceSections sections;
  for (std::size_t k = 0; k < drawn; ++k) {
    const Identification& trace = result.traces[k];
    if (drawn > 1) {
      for (ReportSection* s : {&sections.trace, &sections.law, &sections.errors, &sections.cycles}) {
        s->heading(trace.path);
      }
    }
    sections.add_trace(DrawnTrace(trace, models, curves, fmt::format("t{}", k + 1), 1 / static_cast<double>(drawn), k));
  }
  if (count > drawn) {
    sections.trace.plain(fmt::format("The first {} of {} traces are drawn.", drawn, count));
  }
  if (count > 0) sections.trace.add(health_table(result.traces));
  add_fits(result.fits, result.best, motion, options.instruments_declared, Fits::all, sections.law);
  if (!result.fits.empty()) sections.law.add(profile_charts(result.fits[result.best], motion, "best"));
  sections.add_sources();
  report.add({diagnosis_section(result, motion), sections.trace, sections.law, sections.errors, sections.cycles,
              run_section(diagnose_command(result, options), result.traces, next_after_diagnosis(result, options))});
  return report;
}

}  // namespace tribofit
