#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "diagnosis_sentences.hpp"
#include "numbers.hpp"
#include "report/charts/diagnosis_charts.hpp"
#include "report_parts.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kDrawnTraces = 8;

/// The final model, then the law it began with.
std::vector<DrawnModel> models_of(const DiagnosedTraces& result) {
  std::vector<DrawnModel> models;
  if (result.fits.empty()) return models;
  const Fit& best = result.fits[result.best];
  if (has_parameters(best)) models.push_back({curve_name(best), &best});
  for (const Fit& fit : result.fits) {
    if (&fit == &best || fit.model.law() != result.diagnosis.law || !has_parameters(fit) || models.size() > 1) continue;
    models.push_back({curve_name(fit), &fit});
  }
  return models;
}

/// The models beside the samples, and the rungs between them.
std::vector<DrawnModel> curves_of(const DiagnosedTraces& result, const std::vector<DrawnModel>& models) {
  std::vector<DrawnModel> curves;
  std::set<std::string> names;
  const auto draw = [&](const Fit& fit) {
    if (has_parameters(fit) && fit.fastest > 0 && names.insert(curve_name(fit)).second) {
      curves.push_back({curve_name(fit), &fit});
    }
  };
  for (const DrawnModel& model : models) draw(*model.fit);
  for (const Fit& rung : result.rungs) draw(rung);
  return curves;
}

std::string value_text(const FitParameter& p, const Motion& motion) {
  const std::string unit = shown_unit(p, motion);
  return fmt::format("{} = {}{}", p.parameter.name, with_error(shown(p, p.value), shown(p, p.std_error)),
                     unit == "1" ? "" : " " + unit);
}

ReportTable effects_table(const Diagnosis& d, const Motion& motion) {
  ReportTable table{"What became of each effect",
                    {"effect", "status", "held-out RMSE", "error taken away", "p", "parameters", "why"},
                    {},
                    {2, 3, 4},
                    true};
  std::vector<const EffectFinding*> order;
  for (const EffectFinding& finding : d.effects) order.push_back(&finding);
  const auto error = [](const EffectFinding* f) { return std::isfinite(f->held_out_rmse) ? f->held_out_rmse : 1e300; };
  std::stable_sort(order.begin(), order.end(), [&](const EffectFinding* a, const EffectFinding* b) {
    return a->status != b->status ? a->status < b->status : error(a) < error(b);
  });
  for (const EffectFinding* f : order) {
    std::string parameters;
    if (f->status == EffectStatus::found || f->status == EffectStatus::equivalent) {
      for (const FitParameter& p : f->parameters) {
        parameters += (parameters.empty() ? "" : "; ") + value_text(p, motion);
      }
    }
    table.rows.push_back({f->key, std::string(to_string(f->status)), significant(f->held_out_rmse, 3),
                          std::isfinite(f->error_reduction) ? percent(f->error_reduction) : "-",
                          f->p_value < 1e-4 ? "< 0.0001" : significant(f->p_value, 2), parameters, f->reason});
  }
  return table;
}

ReportSection diagnosis_section(const DiagnosedTraces& result, const Motion& motion) {
  const Diagnosis& d = result.diagnosis;
  ReportSection section{"diagnosis", "What is missing", {}};
  std::vector<Chart> charts = diagnosis_charts(result);
  const auto wide = std::stable_partition(charts.begin(), charts.end(), [](const Chart& chart) { return chart.half; });
  add({std::make_move_iterator(charts.begin()), std::make_move_iterator(wide)}, section);
  section.items.emplace_back(heading_text("Next experiment"));
  section.items.emplace_back(plain_text(d.next_experiment.empty() ? "None is needed." : d.next_experiment));
  if (!d.formula.empty()) {
    section.items.emplace_back(heading_text("A closed form of what remains, for --formula"));
    section.items.emplace_back(ReportText{d.formula, ReportText::Kind::command});
  }
  for (const std::string& message : d.messages) section.items.emplace_back(plain_text(message));
  if (!d.confirmations.empty()) {
    ReportTable table{"Tried on runs that took no part, parameters frozen",
                      {"run", "RMSE of the bare law", "RMSE of the final model", "p"},
                      {},
                      {1, 2, 3},
                      false};
    for (const Confirmation& c : d.confirmations) {
      table.rows.push_back(
          {c.path, significant(c.base_rmse, 3), significant(c.final_rmse, 3), significant(c.p_value, 2)});
    }
    section.items.emplace_back(std::move(table));
  }
  add({std::make_move_iterator(wide), std::make_move_iterator(charts.end())}, section);
  section.items.emplace_back(effects_table(d, motion));
  return section;
}

}  // namespace

Report report_of(const DiagnosedTraces& result, const ReportOptions& options) {
  const TerminalOptions terminal = terminal_like(options);
  const Motion none;
  const Motion& motion = result.traces.empty() ? none : result.traces.front().motion;
  const std::size_t count = result.traces.size(), drawn = std::min(count, kDrawnTraces);
  Report report;
  report.kind = "diagnosis";
  report.title = count == 1 ? file_name(result.traces.front().path) : fmt::format("{} traces together", count);
  report.subtitle = made_by("Diagnosis") + "; ± is one standard error, everywhere in this report.";
  report.lead = diagnosis_verdict(result);
  for (const Identification& trace : result.traces) {
    report.warnings.insert(report.warnings.end(), trace.warnings.begin(), trace.warnings.end());
  }
  if (count == 1) report.facts = facts_of(result.traces.front());
  report.sections.push_back(diagnosis_section(result, motion));
  const std::vector<DrawnModel> models = models_of(result), curves = curves_of(result, models);
  TraceSections sections;
  for (std::size_t k = 0; k < drawn; ++k) {
    const Identification& trace = result.traces[k];
    if (drawn > 1) {
      for (ReportSection* s : {&sections.trace, &sections.law, &sections.errors, &sections.cycles}) {
        s->items.emplace_back(heading_text(trace.path));
      }
    }
    sections.add_trace(DrawnTrace(trace, models, curves, fmt::format("t{}", k + 1), 1 / static_cast<double>(drawn)));
  }
  if (count > drawn) {
    sections.trace.items.emplace_back(plain_text(fmt::format("The first {} of {} traces are drawn.", drawn, count)));
  }
  if (count > 0) sections.trace.items.emplace_back(health_table(result.traces));
  if (!result.fits.empty()) {
    add_parameters(result.fits, result.best, motion, options, sections.law);
    add(profile_charts(result.fits[result.best], motion, "best"), sections.law);
  }
  append_filled(
      {std::move(sections.trace), std::move(sections.law), std::move(sections.errors), std::move(sections.cycles)},
      report);
  report.sections.push_back(
      run_section(diagnose_command(result, terminal), result.traces, next_after_diagnosis(result, terminal)));
  return report;
}

}  // namespace tribofit
