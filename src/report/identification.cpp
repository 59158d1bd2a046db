#include <cmath>

#include "fit/assessment.hpp"
#include "rate_state.hpp"
#include "report/charts/styles.hpp"
#include "report_parts.hpp"
#include "tribofit/fit/residual_variable.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {
namespace {

/// What is said of a fit, in the order of FitQuality, and last where a free function finds something, whatever the
/// noise floor: {0} the law, {1} its held-out error, {2} the noise floor, {3} its error on the cycles that were fitted,
/// {4} its typical relative error, {5} the held-out error beside the floor, {6} its name, {7} what the rest varies
/// with.
constexpr std::array<const char*, 8> kSentences = {
    "",
    "{0} has a held-out error of {1}, less than the noise floor of {2}: the noise floor is overestimated here, so the "
    "data do not show whether an effect remains.",
    "{0} does not carry over to held-out cycles: its error there is {1}, and {3} on the cycles it was fitted to. Do "
    "not rely on its values.",
    "{0} describes this trace as well as its noise allows: the held-out error is {1}, the noise floor {2}.",
    "{0} is close (typically {4} off), but {5}: a small effect may remain.",
    "{0} describes only the general shape (typical error {4}): {5}. An effect is not modelled.",
    "{0} does not describe this trace (typically {4} off): {5}. Do not rely on its values.",
    "An effect is not modelled: what the {6} law leaves varies with {7}, beyond chance (held-out error {1}, noise "
    "floor "
    "{2}, typical error {4})."};

std::string verdict_on(const Identification& r) {
  const Fit& fit = r.fits[r.best];
  const auto level = [&](double value) { return significant(value, 3) + unit_behind(friction_unit(r.motion)); };
  const bool bare = fit.model.effects().empty();
  const std::string name = (bare ? "The " : "The law ") + fit.model.name() + (bare ? " law" : "");
  const std::string held_out = level(fit.error.held_out_rmse), floor = level(fit.floor.rmse);
  std::string beside = "its held-out error is " + held_out;
  if (is_far_above_floor(fit)) {
    beside += ", far above the noise floor of " + floor;
  } else if (const double ratio = over_floor(fit); std::isfinite(ratio)) {
    beside += fmt::format(", {} times the noise floor of {}", significant(ratio, 2), floor);
  }
  std::vector<std::string> phrases;
  for (const ResidualVariable variable : r.remaining) phrases.emplace_back(describe(variable).phrase);
  return fmt::format(fmt::runtime(phrases.empty() ? style_of(quality_of(fit), kSentences) : kSentences.back()), name,
                     held_out, floor, level(fit.error.rmse), percent(fit.error.mean_relative), beside, fit.model.name(),
                     enumerated(phrases));
}

/// No fit that could be relied on.
bool is_unusable(const Identification& r) {
  return r.fits.empty() || quality_of(r.fits[r.best]) == FitQuality::unusable;
}

/// How good the best fit is, in one sentence an engineer would say, and what its values do not hold for.
std::string verdict(const Identification& r) {
  if (r.rate_state) return verdict_on(*r.rate_state);
  if (!r.analysed) return "No law was fitted; what the trace does show stands above.";
  if (is_unusable(r)) return "No fit can be trusted here; the notes at the fits say why.";
  const Fit& best = r.fits[r.best];
  std::string text = verdict_on(r);
  std::vector<std::string> loose, open;
  for (const FitParameter& p : best.parameters) {
    if (!is_fixed(p)) loose.push_back((p.effect.empty() ? "" : p.effect + " ") + p.parameter.name);
  }
  for (const HealthItem& item : r.motion.health) {
    if (item.status != HealthItem::Status::ok && health_check::bears_on_values(item.check)) open.push_back(item.check);
  }
  if (!loose.empty()) text += fmt::format(" Not determined by these data: {}.", fmt::join(loose, ", "));
  if (open.empty()) return text;
  return text + fmt::format(" The values hold only if what Health says of {} is resolved.", fmt::join(open, ", "));
}

/// What to do next with a trace and its fits.
Suggestion next_command(const Identification& r, const ReportOptions& options) {
  const auto with = [&](const std::vector<std::string>& more) {
    return command_line(joined(options.arguments, more), {r.path});
  };
  const bool steps = r.rate_state && r.rate_state->fitted(), usable = r.analysed && !is_unusable(r);
  const bool trimmed = r.motion.trimmed > 0 && !has_option(options.arguments, "--no-trim");
  const bool has_csv = options.csv_written;
  const std::string csv = with({"--csv", csv_folder_for(r.path)});
  return first_of(
      {{steps && !has_csv, "to plot the response and to go on with the values of each step", csv},
       {steps && !options.report_written, "to see the response on a page of charts", with({"--report", "steps.html"})},
       {steps, "to read what else can be said of steps and holds", "identify help kinds"},
       {r.force_statistics.has_value(), "to see what else the file holds", command_line({"columns"}, {r.path})},
       {!usable && trimmed, "to see whether the run-up that was left out shows more", with({"--no-trim"})},
       {!usable && !has_csv, "to look at the trace sample by sample", csv},
       {!usable, "to see which options there are", "identify --help"},
       {usable && (is_above_floor(r.fits[r.best]) || !r.remaining.empty()),
        "to see where the law fails and which effect explains it", diagnose_command(options.arguments, r.path)},
       {!has_csv, "to plot the curve, the residuals and the cycles", csv},
       {!has_option(options.arguments, "--profile"), "to check the intervals by profile likelihood",
        with({"--profile"})},
       {true, "to see which effects can be added", "identify effects"}});
}

/// The charts of the trace in their sections.
void draw(const Identification& result, const ReportOptions& options, TraceSections& sections) {
  constexpr std::size_t kDrawnModels = 3;
  const auto beside = [&](const Fit& fit) { return fit.protocol == result.fits[result.best].protocol; };
  const DrawnLaws laws = drawn_laws(result.fits, result.best, kDrawnModels, beside, result.fits);
  const DrawnTrace drawn(result, laws, "t1", 1, 0, options.threads);
  sections.add_models(drawn);
  if (options.cycles == nullptr) sections.add_cycles(drawn);
  if (options.cycles != nullptr) sections.cycles = *options.cycles;
}

/// What the motion shows, as the text has it; a page has the same at its head.
ReportSection motion_section(const Identification& result) {
  const std::string kind(to_string(kind_of_record(result.motion, result.segmentation)));
  ReportSection section{"motion", capitalised(kind), {}, Medium::terminal};
  Facts facts = stick_slip_facts(result);
  for (auto& [name, value] : facts) {
    if (name == "frequency") value += " (+/- is one standard error, here and below)";
  }
  for (const std::string& note : result.segmentation.notes) facts.emplace_back("note", note);
  section.add(ReportFacts{std::move(facts)});
  return section;
}

}  // namespace

Report report_of(const Identification& result, const ReportOptions& options) {
  const bool driven = is_driven_in_steps(result.motion.kind);
  Report report = titled_report(driven ? "rate and state" : "friction law", file_name(result.path), verdict(result));
  report.warnings = result.warnings;
  report.facts = model_facts("best law", result.fits, result.best, result.motion);
  add_facts(result, report);
  report.next = {next_command(result, options)};
  if (!driven && result.analysed && !is_unusable(result)) add_ways_to_look("", result.path, options, report);
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
    sections.errors.medium = Medium::page;
  }
  report.add({record_section(result), driven ? ReportSection{} : motion_section(result), sections.trace, sections.law,
              sections.errors, sections.cycles, result_section(report),
              run_section(report, command_line(options.arguments, {result.path}), {&result, 1})});
  return report;
}

ReportSection cycles_section(const Identification& result) {
  TraceSections sections;
  sections.add_cycles(DrawnTrace(result, {}, "t1"));
  return sections.cycles;
}

}  // namespace tribofit
