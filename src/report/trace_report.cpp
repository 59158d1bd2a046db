#include "numbers.hpp"
#include "parameter_cells.hpp"
#include "report_parts.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/report/report.hpp"
#include "verdict.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kDrawnModels = 3;

/// The best fit, then the others by the same protocol.
std::vector<DrawnModel> models_of(const Identification& result) {
  std::vector<DrawnModel> models;
  if (result.fits.empty()) return models;
  const Fit& best = result.fits[result.best];
  if (has_parameters(best)) models.push_back({curve_name(best), &best});
  for (const Fit& fit : result.fits) {
    if (&fit == &best || fit.protocol != best.protocol || !has_parameters(fit) || models.size() == kDrawnModels) {
      continue;
    }
    models.push_back({curve_name(fit), &fit});
  }
  return models;
}

std::vector<DrawnModel> curves_of(const Identification& result) {
  std::vector<DrawnModel> models;
  for (const Fit& fit : result.fits) {
    if (has_parameters(fit) && fit.fastest > 0) models.push_back({curve_name(fit), &fit});
  }
  return models;
}

/// The best law and its parameters: what a reader looks for first.
std::vector<std::pair<std::string, std::string>> result_facts(const Identification& result) {
  std::vector<std::pair<std::string, std::string>> facts;
  if (result.fits.empty() || !has_parameters(result.fits[result.best])) return facts;
  const Fit& best = result.fits[result.best];
  facts.emplace_back("best law", curve_name(best));
  for (const FitParameter& p : best.parameters) {
    const std::string unit = shown_unit(p, result.motion);
    facts.emplace_back(p.effect.empty() ? p.parameter.name : p.effect + "." + p.parameter.name,
                       with_error(shown(p, p.value), shown(p, p.std_error)) + (unit == "1" ? "" : " " + unit));
  }
  return facts;
}

void add_protocols(const Identification& result, ReportSection& section) {
  ReportTable table{"Published protocol beside the joint fit",
                    {"law", "parameter", "published", "joint", "difference", "unit", "remarks"},
                    {},
                    {2, 3, 4},
                    false};
  for (const ProtocolRow& row : protocol_rows(result)) {
    table.rows.push_back(row.cells);
    table.rows.back().emplace_back(row.differs ? "outside the 95 % interval" : "");
  }
  if (table.rows.empty()) return;
  section.items.emplace_back(std::move(table));
  section.items.emplace_back(
      soft_text("The published protocol takes mu_s and mu_k from the extremes of each cycle, which noise widens."));
}

}  // namespace

Report report_of(const Identification& result, const ReportOptions& options) {
  const TerminalOptions terminal = terminal_like(options);
  Report report;
  report.kind = "friction law";
  report.title = file_name(result.path);
  report.subtitle = made_by("Friction law") + "; ± is one standard error, everywhere in this report.";
  report.lead = verdict(result);
  report.warnings = result.warnings;
  report.facts = result_facts(result);
  for (auto& fact : facts_of(result)) report.facts.push_back(std::move(fact));
  const std::vector<DrawnModel> models = models_of(result), curves = curves_of(result);
  TraceSections sections;
  sections.add_trace(DrawnTrace(result, models, curves, "t1"));
  sections.trace.items.emplace_back(health_table({&result, 1}));
  if (!result.fits.empty()) {
    add_parameters(result.fits, result.best, result.motion, options, sections.law);
    add_protocols(result, sections.law);
    for (std::string& sentence : comparison_sentences(result)) {
      sections.law.items.emplace_back(plain_text(std::move(sentence) + "."));
    }
    add(profile_charts(result.fits[result.best], result.motion, "best"), sections.law);
  }
  append_filled(
      {std::move(sections.trace), std::move(sections.law), std::move(sections.errors), std::move(sections.cycles)},
      report);
  report.sections.push_back(
      run_section(command_line(terminal, "", result.path), {&result, 1}, next_command(result, terminal)));
  return report;
}

}  // namespace tribofit
