#include <fmt/format.h>

#include <array>
#include <cmath>

#include "fit/assessment.hpp"
#include "numbers.hpp"
#include "rate_state.hpp"
#include "report/charts/styles.hpp"
#include "report_parts.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/report/terminal.hpp"

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

/// The charts of the trace in their sections.
void draw(const Identification& result, const ReportOptions& options, TraceSections& sections) {
  constexpr std::size_t kDrawnModels = 3;
  const auto beside = [&](const Fit& fit) { return fit.protocol == result.fits[result.best].protocol; };
  const std::vector<const Fit*> models = drawn_models(result.fits, result.best, kDrawnModels, beside);
  const std::vector<const Fit*> curves = drawn_curves(models, result.fits);
  const DrawnTrace drawn(result, models, curves, "t1", 1, 0, options.threads);
  sections.add_models(drawn);
  if (options.cycles == nullptr) sections.add_cycles(drawn);
  if (options.cycles != nullptr) sections.cycles = *options.cycles;
}

/// What the motion shows, as the text has it; a page has the same at its head.
ReportSection motion_section(const Identification& result) {
  ReportSection section{
      "motion", style_of(kind_of_record(result.motion, result.segmentation), kHeadings), {}, Medium::terminal};
  Facts facts = stick_slip_facts(result);
  for (auto& [name, value] : facts) {
    if (name == "frequency") value += " (+/- is one standard error, here and below)";
  }
  for (const std::string& note : result.segmentation.notes) facts.emplace_back("note", note);
  section.add(ReportFacts{std::move(facts)});
  return section;
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
    if (!options.report_written)
      return {"to see the response on a page of charts", same_with({"--report", "steps.html"})};
    return {"to read what else can be said of steps and holds", "identify help kinds"};
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

Report report_of(const Identification& result, const ReportOptions& options) {
  const bool driven = is_driven_in_steps(result.motion.kind);
  Report report = titled_report("friction law", file_name(result.path), driven ? "Rate and state" : "Friction law",
                                verdict(result));
  report.warnings = result.warnings;
  report.facts = model_facts("best law", result.fits, result.best, result.motion);
  const Facts record = facts_of(result);
  report.facts.insert(report.facts.end(), record.begin(), record.end());
  report.next = {next_command(result, options)};
  if (!driven && result.analysed && !is_unusable(result)) {
    for (Suggestion& way : ways_to_look("", options.arguments, result.path, options.report_written)) {
      report.next.push_back(std::move(way));
    }
  }
  TraceSections sections;
  if (driven && result.rate_state) {
    sections.law.title = "Rate and state";
    sections.trace.add(rate_state_charts(*result.rate_state));
    add_rate_state(*result.rate_state, result.motion, sections.law);
  }
  if (!driven) {
    if (options.charts) draw(result, options, sections);
    sections.trace.add(health_table({&result, 1}), Medium::page);
    add_fits(result.fits, result.best, result.motion, options.instruments_declared, sections.law);
    add_comparisons(result.fits, result.best, result.motion, sections.law);
    if (!result.fits.empty()) sections.law.add(profile_charts(result.fits[result.best], result.motion, "best"));
    sections.add_sources();
    sections.errors.medium = Medium::page;
  }
  report.add({record_section(result), driven ? ReportSection{} : motion_section(result), sections.trace, sections.law,
              sections.errors, sections.cycles, result_section(report),
              run_section(report, command_line(options, {}, result.path), {&result, 1})});
  return report;
}

ReportSection cycles_section(const Identification& result) {
  TraceSections sections;
  sections.add_cycles(DrawnTrace(result, {}, {}, "t1"));
  return sections.cycles;
}

}  // namespace tribofit
