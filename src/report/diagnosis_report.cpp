#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "diagnosis_sentences.hpp"
#include "numbers.hpp"
#include "report/charts/diagnosis_charts.hpp"
#include "report_parts.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kDrawnTraces = 8;

ReportTable effects_table(const Diagnosis& d, const Motion& motion) {
  ReportTable table("What became of each effect");
  table.text({"effect", "status"}).numbers({"held-out error", "error taken away", "p"}).text({"parameters", "why"});
  table.folded = true;
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
  std::vector<Chart> charts = diagnosis_charts(result);
  const auto wide = std::stable_partition(charts.begin(), charts.end(), [](const Chart& chart) { return chart.half; });
  add({std::make_move_iterator(charts.begin()), std::make_move_iterator(wide)}, section);
  section.items.emplace_back(heading_text("Next experiment"));
  section.items.emplace_back(plain_text(d.next_experiment.empty() ? "None is needed." : d.next_experiment));
  if (!d.formula.empty()) {
    section.items.emplace_back(heading_text("A closed form of what remains, for --formula"));
    section.items.emplace_back(command_text(d.formula));
  }
  for (const std::string& message : d.messages) section.items.emplace_back(plain_text(message));
  if (!d.confirmations.empty()) section.items.emplace_back(heading_text("On runs that took no part"));
  for (const Confirmation& c : d.confirmations) {
    section.items.emplace_back(item_text(confirmation_sentence(c, result)));
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
  const std::string title =
      count == 1 ? file_name(result.traces.front().path) : fmt::format("{} traces together", count);
  Report report = titled_report("diagnosis", title, "Diagnosis", diagnosis_verdict(result));
  for (const Identification& trace : result.traces) {
    report.warnings.insert(report.warnings.end(), trace.warnings.begin(), trace.warnings.end());
  }
  if (count == 1) report.facts = facts_of(result.traces.front());
  report.sections.push_back(diagnosis_section(result, motion));
  const auto bare = [&](const Fit& fit) { return fit.model.law() == result.diagnosis.law; };
  const std::vector<DrawnModel> models = drawn_models(result.fits, result.best, 2, bare);
  const std::vector<DrawnModel> curves = drawn_curves(models, result.rungs);
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
    add_fits(result.fits, result.best, motion, options.instruments_declared, Fits::all, sections.law);
    add(profile_charts(result.fits[result.best], motion, "best"), sections.law);
  }
  sections.move_into(report);
  report.sections.push_back(
      run_section(diagnose_command(result, terminal), result.traces, next_after_diagnosis(result, terminal)));
  return report;
}

}  // namespace tribofit
