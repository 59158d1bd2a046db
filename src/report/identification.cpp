#include <fmt/format.h>

#include <array>
#include <cmath>

#include "fit/assessment.hpp"
#include "numbers.hpp"
#include "rate_state.hpp"
#include "report/charts/styles.hpp"
#include "report_parts.hpp"
#include "tribofit/kinematics/health.hpp"

namespace tribofit {
namespace {

std::string verdict_on(const Identification& r, const Fit& fit) {
  const auto level = [&](double value) { return significant(value, 3) + (friction_unit(r.motion) == "N" ? " N" : ""); };
  const bool bare = fit.model.effects().empty();
  const std::string name = (bare ? "The " : "The law ") + fit.model.name() + (bare ? " law" : "");
  const std::string held_out = level(fit.error.held_out_rmse), floor = level(fit.floor.rmse);
  const std::string typical = percent(fit.error.mean_relative);
  std::string remains = "its held-out error is " + held_out;
  const double ratio = over_floor(fit);
  if (is_far_above_floor(fit)) {
    remains += ", far above the noise floor of " + floor;
  } else if (std::isfinite(ratio)) {
    remains += fmt::format(", {} times the noise floor of {}", significant(ratio, 2), floor);
  }
  switch (quality_of(fit)) {
    case FitQuality::floor_too_high:
      return fmt::format(
          "{} has a held-out error of {}, less than the noise floor of {}: the noise floor is overestimated here, so "
          "the data do not show whether an effect remains.",
          name, held_out, floor);
    case FitQuality::not_transferable:
      return fmt::format(
          "{} does not carry over to held-out cycles: its error there is {}, and {} on the cycles it was fitted to. Do "
          "not rely on its values.",
          name, held_out, level(fit.error.rmse));
    case FitQuality::at_floor:
      return fmt::format(
          "{} describes this trace as well as its noise allows: the held-out error is {}, the noise floor {}.", name,
          held_out, floor);
    case FitQuality::close:
      return fmt::format("{} is close (typically {} off), but {}: a small effect may remain.", name, typical, remains);
    case FitQuality::outline:
      return fmt::format("{} describes only the general shape (typical error {}): {}. An effect is not modelled.", name,
                         typical, remains);
    case FitQuality::poor:
    case FitQuality::unusable:
      break;
  }
  return fmt::format("{} does not describe this trace (typically {} off): {}. Do not rely on its values.", name,
                     typical, remains);
}

/// Parameters that these data do not fix, as a sentence; empty where all are fixed.
std::string undetermined(const Fit& fit) {
  std::vector<std::string> names;
  for (const FitParameter& p : fit.parameters) {
    if (!is_fixed(p)) names.push_back((p.effect.empty() ? "" : p.effect + " ") + p.parameter.name);
  }
  return names.empty() ? "" : fmt::format(" Not determined by these data: {}.", fmt::join(names, ", "));
}

/// Checks of the data that bear on the values and are not in order.
std::string open_problems(const Identification& r) {
  std::vector<std::string> names;
  for (const HealthItem& item : r.motion.health) {
    if (item.status != HealthItem::Status::ok && health_check::bears_on_values(item.check)) names.push_back(item.check);
  }
  return names.empty()
             ? ""
             : fmt::format(" The values hold only if what Health says of {} is resolved.", fmt::join(names, ", "));
}

/// No fit that could be relied on.
bool is_unusable(const Identification& r) {
  return r.fits.empty() || quality_of(r.fits[r.best]) == FitQuality::unusable;
}

/// Of what the motion shows, in the order of RecordKind.
constexpr std::array<const char*, 8> kHeadings = {
    "Stick-slip", "Sliding",        "Points",         "Stick-slip",
    "Motion",     "Friction alone", "Velocity steps", "Slide, hold, slide"};

std::string render_driven(const Identification& result, const TerminalOptions& options) {
  TerminalText text(options);
  add_record(result, text);
  ReportSection section;
  if (result.rate_state) add_rate_state(*result.rate_state, result.motion, section);
  text.items(section.items);
  text.result(result.warnings, verdict(result), next_command(result, options));
  return text.take();
}

Report report_of_driven(const Identification& result, const ReportOptions& options) {
  Report report = titled_report("friction law", file_name(result.path), "Rate and state", verdict(result));
  report.warnings = result.warnings;
  report.facts = facts_of(result);
  ReportSection response{"trace", "Model and measurement", {}}, law{"law", "Rate and state", {}};
  if (result.rate_state) {
    response.add(rate_state_charts(*result.rate_state));
    add_rate_state(*result.rate_state, result.motion, law);
  }
  report.add({response, law,
              run_section(command_line(options, {}, result.path), {&result, 1}, next_command(result, options))});
  return report;
}

}  // namespace

std::string verdict(const Identification& result) {
  if (result.rate_state) return verdict_on(*result.rate_state);
  if (!result.analysed) return "No law was fitted; what the trace does show stands above.";
  if (is_unusable(result)) return "No fit can be trusted here; the notes at the fits say why.";
  const Fit& best = result.fits[result.best];
  return verdict_on(result, best) + undetermined(best) + open_problems(result);
}

Suggestion next_command(const Identification& result, const ReportOptions& options) {
  const auto same_with = [&](const std::vector<std::string>& more) { return command_line(options, more, result.path); };
  const std::vector<std::string> csv = {"--csv", csv_folder_for(result.path)};
  if (result.rate_state && result.rate_state->fitted()) {
    if (!options.csv_written) return {"to plot the response and to go on with the values of each step", same_with(csv)};
    return {"to see the response on a page of charts", same_with({"--report", "steps.html"})};
  }
  if (result.force_statistics) return {"to see what else the file holds", command_line({"columns"}, {result.path})};
  if (!result.analysed || is_unusable(result)) {
    if (result.motion.trimmed > 0 && !has_option(options.arguments, "--no-trim")) {
      return {"to see whether the run-up that was left out shows more", same_with({"--no-trim"})};
    }
    if (!options.csv_written) return {"to look at the trace sample by sample", same_with(csv)};
    return {"to see which options there are", "identify --help"};
  }
  if (is_above_floor(result.fits[result.best])) {
    return {"to see where the law fails and which effect explains it",
            diagnose_command(options.arguments, result.path)};
  }
  if (!options.csv_written) return {"to plot the curve, the residuals and the cycles", same_with(csv)};
  if (!has_option(options.arguments, "--profile")) {
    return {"to check the intervals by profile likelihood", same_with({"--profile"})};
  }
  return {"to see which effects can be added", "identify effects"};
}

std::string render_terminal(const Identification& result, const TerminalOptions& options) {
  if (is_driven_in_steps(result.motion.kind)) return render_driven(result, options);
  TerminalText text(options);
  add_record(result, text);
  text.heading(style_of(kind_of_record(result.motion, result.segmentation), kHeadings));
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
  if (result.analysed && !is_unusable(result)) {
    text.look(ways_to_look("", options.arguments, result.path, options.report_written));
  }
  return text.take();
}

Report report_of(const Identification& result, const ReportOptions& options) {
  if (is_driven_in_steps(result.motion.kind)) return report_of_driven(result, options);
  constexpr std::size_t kDrawnModels = 3;
  Report report = titled_report("friction law", file_name(result.path), "Friction law", verdict(result));
  report.warnings = result.warnings;
  report.facts = facts_of(result);
  const Facts best = model_facts("best law", result.fits, result.best, result.motion);
  report.facts.insert(report.facts.begin(), best.begin(), best.end());
  const auto beside = [&](const Fit& fit) { return fit.protocol == result.fits[result.best].protocol; };
  const std::vector<const Fit*> models = drawn_models(result.fits, result.best, kDrawnModels, beside);
  const std::vector<const Fit*> curves = drawn_curves(models, result.fits);
  TraceSections sections;
  const DrawnTrace drawn(result, models, curves, "t1", 1, 0, options.threads);
  sections.add_models(drawn);
  if (!options.leave_out_cycles) sections.add_cycles(drawn);
  sections.trace.add(health_table({&result, 1}));
  add_fits(result.fits, result.best, result.motion, options.instruments_declared, Fits::all, sections.law);
  add_comparisons(result.fits, result.best, result.motion, sections.law);
  if (!result.fits.empty()) sections.law.add(profile_charts(result.fits[result.best], result.motion, "best"));
  sections.add_sources();
  report.add({sections.trace, sections.law, sections.errors, sections.cycles,
              run_section(command_line(options, {}, result.path), {&result, 1}, next_command(result, options))});
  return report;
}

ReportSection cycles_section(const Identification& result) {
  const std::vector<const Fit*> none;
  TraceSections sections;
  sections.add_cycles(DrawnTrace(result, none, none, "t1"));
  return sections.cycles;
}

}  // namespace tribofit
