#include "numbers.hpp"
#include "report_parts.hpp"
#include "verdict.hpp"

namespace tribofit {
namespace {

/// The best law and its parameters: what a reader looks for first.
Facts result_facts(const Identification& result) {
  Facts facts;
  if (result.fits.empty() || !has_parameters(result.fits[result.best])) return facts;
  const Fit& best = result.fits[result.best];
  facts.emplace_back("best law", curve_name(best));
  for (const FitParameter& p : best.parameters) facts.emplace_back(full_name(p), value_text(p, result.motion));
  return facts;
}

}  // namespace

std::string render_terminal(const Identification& result, const TerminalOptions& options) {
  TerminalText text(options);
  add_record(result, text);
  text.heading("Stick-slip");
  for (const auto& [name, value] : stick_slip_facts(result)) {
    text.item(name, name == "frequency" ? value + " (+/- is one standard error, here and below)" : value);
  }
  const SpectralPeak& peak = result.spectral_peak;
  if (peak.frequency > 0 && result.segmentation.kind == MotionKind::stick_slip) {
    text.item("spectrum of v_r", "peak at " + significant(peak.frequency, 4) + " Hz; a plain FFT would say " +
                                     significant(peak.bin_frequency, 4) + " Hz, in bins of " +
                                     significant(peak.bin_width, 3) + " Hz");
  }
  for (const std::string& note : result.segmentation.notes) text.item("note", note);
  ReportSection laws;
  add_fits(result.fits, result.best, result.motion, options.instruments_declared, Fits::without_compared, laws);
  add_comparisons(result.fits, result.best, result.motion, laws);
  text.items(laws.items);
  text.result(result.warnings, verdict(result), next_command(result, options));
  return text.take();
}

Report report_of(const Identification& result, const ReportOptions& options) {
  constexpr std::size_t kDrawnModels = 3;
  const TerminalOptions terminal = terminal_like(options);
  Report report = titled_report("friction law", file_name(result.path), "Friction law", verdict(result));
  report.warnings = result.warnings;
  report.facts = result_facts(result);
  for (auto& fact : facts_of(result)) report.facts.push_back(std::move(fact));
  const auto beside = [&](const Fit& fit) { return fit.protocol == result.fits[result.best].protocol; };
  const std::vector<DrawnModel> models = drawn_models(result.fits, result.best, kDrawnModels, beside);
  const std::vector<DrawnModel> curves = drawn_curves(models, result.fits);
  TraceSections sections;
  sections.add_trace(DrawnTrace(result, models, curves, "t1"));
  sections.trace.add(health_table({&result, 1}));
  add_fits(result.fits, result.best, result.motion, options.instruments_declared, Fits::all, sections.law);
  add_comparisons(result.fits, result.best, result.motion, sections.law);
  if (!result.fits.empty()) sections.law.add(profile_charts(result.fits[result.best], result.motion, "best"));
  report.add({sections.trace, sections.law, sections.errors, sections.cycles,
              run_section(command_line(terminal, {}, result.path), {&result, 1}, next_command(result, terminal))});
  return report;
}

}  // namespace tribofit
