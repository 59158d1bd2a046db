#include "diagnosis_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/conclusions.hpp"
#include "numbers.hpp"

namespace tribofit {
namespace {

/// "runout (A = 0.048 +/- 0.001): the disc runs out of true, ..." without an end; the first parameter says how strong
/// the effect is. Of a group: "runout or drift, which these data cannot distinguish".
std::string found_clause(const DiagnosedTraces& result, const Rung& rung) {
  const std::string name = spelled(result, rung.added), statement = info_of(result, rung.added).statement;
  std::string text = name;
  if (!rung.equivalent.empty()) {
    text = fmt::format("{} or {}, which these data cannot distinguish; the best fit has {}", name,
                       enumerated(rung.equivalent, "or"), name);
  }
  const EffectFinding* finding = finding_of(result.diagnosis, rung.added);
  if (finding != nullptr && !finding->parameters.empty() && !result.traces.empty()) {
    const FitParameter& p = finding->parameters.front();
    text += fmt::format(" ({} = {})", p.parameter.name, value_text(p, result.traces.front().motion));
  }
  return statement.empty() ? text : text + ": " + statement;
}

std::string found_sentence(const DiagnosedTraces& result, const std::vector<Rung>& found) {
  if (found.empty()) return "The model is incomplete.";
  if (found.size() == 1) return "The effect found is " + found_clause(result, found.front()) + ".";
  std::string text = fmt::format("{} effects were found:", found.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    text += fmt::format(" ({}) {}.", k + 1, found_clause(result, found[k]));
  }
  return text;
}

double last_error(const Diagnosis& d) {
  return d.ladder.empty() ? std::nan("") : d.ladder.back().held_out_rmse;
}

/// How the error stands to the noise floor, after a comma: "at the noise floor (0.0030)".
std::string floor_clause(const Diagnosis& d, const std::string& floor) {
  switch (against_floor(last_error(d), d.floor_rmse)) {
    case FloorComparison::unknown:
      return "and no noise floor is known";
    case FloorComparison::below:
      if (d.floor_is_sampling) return "less than what the sampling leaves unknown (" + floor + ")";
      return "less than the noise floor of " + floor + ", so the noise floor is overestimated here";
    case FloorComparison::at:
      // Where something remains that is not noise, its error may still be as small as the noise.
      if (d.verdict == Verdict::unexplained) return "and the noise floor is " + floor;
      return "at the noise floor (" + floor + ")";
    case FloorComparison::above:
      break;
  }
  return fmt::format("still {} times the noise floor of {}", significant(last_error(d) / d.floor_rmse, 2), floor);
}

/// "the held-out error falls from 0.0088 to 0.0030"; where it stays, what else shows effects that were found before
/// any fit.
std::string fall(const Diagnosis& d, const std::string& first, const std::string& last, const std::string& floor) {
  if (d.ladder.size() < 2) return fmt::format("the held-out error is {}, {}", last, floor);
  if (first != last) {
    const bool falls = last_error(d) < d.ladder.front().held_out_rmse;
    return fmt::format("the held-out error {} from {} to {}, {}", falls ? "falls" : "rises", first, last, floor);
  }
  std::string text = fmt::format("the held-out error stays at {}, {}", first, floor);
  for (const Rung& rung : found_effects(d)) {
    const EffectFinding* finding = finding_of(d, rung.added);
    if (finding == nullptr || std::isfinite(finding->held_out_rmse)) continue;
    text += fmt::format("; {} rests on other evidence: {}", rung.added, finding->reason);
  }
  return text;
}

/// " Over them mu_k is between 0.11 and 0.32."
std::string ranges(const DiagnosedTraces& result) {
  std::vector<std::string> parts;
  const Motion& motion = result.traces.front().motion;
  for (const FitParameter& p : result.fits[result.best].parameters) {
    if (!p.range) continue;
    if (!std::isfinite(p.range->upper - p.range->lower)) {
      parts.push_back(full_name(p) + " is not determined");
      continue;
    }
    const auto level = [&](double value) { return significant(shown(p, value), 3); };
    parts.push_back(fmt::format("{} is between {} and {}{}", full_name(p), level(p.range->lower), level(p.range->upper),
                                unit_behind(shown_unit(p, motion))));
  }
  return parts.empty() ? "" : fmt::format(" Over them {}.", enumerated(parts));
}

/// " The exponential and fractional laws do as well on these data."
std::string rivals(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  std::vector<std::string> names;
  for (const Law& law : d.rival_laws) names.emplace_back(to_string(law));
  if (names.empty()) return "";
  return fmt::format(" The {} {} as well on these data.{}", enumerated(names),
                     names.size() == 1 ? "law does" : "laws do", ranges(result));
}

/// What stands in the way of any diagnosis.
std::string obstacle(const DiagnosedTraces& result) {
  if (!result.diagnosis.messages.empty()) return result.diagnosis.messages.front();
  for (const Identification& trace : result.traces) {
    if (!trace.analysed && !trace.warnings.empty()) return trace.warnings.back();
  }
  return "too few cycles to hold any out";
}

std::vector<std::string> keys_of(const Diagnosis& d, EffectStatus status) {
  std::vector<std::string> keys;
  for (const EffectFinding& e : d.effects) {
    if (e.status == status) keys.push_back(e.key);
  }
  return keys;
}

/// What is said of a verdict, with names for what depends on the result.
const char* sentences_on(const Diagnosis& d, bool found, bool possible) {
  switch (d.verdict) {
    case Verdict::sufficient:
      return "The {law} is enough: its held-out error is {error}, {floor}.{rivals} These data show no further "
             "effect{untestable}.";
    case Verdict::effect_found:
      return "{found} With {them} {fall}.{rivals}";
    case Verdict::unexplained:
      if (d.runs_differ) return found ? "{found} {difference}." : "{difference}.";
      if (possible) {
        return found ? "{found} What remains looks like {possible}, but these data do not prove it: {fall}."
                     : "No effect is proven. What remains looks like {possible}, but these data do not prove it: "
                       "{fall}.";
      }
      return found ? "{found} More remains: {fall}. No effect explains the rest. {rest}{rivals}"
                   : "No effect of the catalogue explains what remains: the held-out error of the {law} is {error}, "
                     "{floor}. {rest}{rivals}";
    case Verdict::unconfirmed:
      return found ? "{found} A run not used in the fit does not confirm it."
                   : "The {law} is enough for the data it was fitted to: its held-out error is {error}, {floor}. A run "
                     "not used in the fit contradicts it.";
    case Verdict::unfinished:
      return found ? "The time was over before every effect was tried. So far: {found} {fall}."
                   : "The time was over before every effect was tried. So far nothing is added to the {law}: its "
                     "held-out error is {error}, {floor}.";
    case Verdict::not_enough_data:
      break;
  }
  return "No diagnosis can be made from these data: {obstacle}.";
}

std::string command(const std::vector<std::string>& words, const ReportOptions& options,
                    const DiagnosedTraces& result) {
  std::vector<std::string> inputs = options.inputs;
  if (inputs.empty()) {
    for (const Identification& trace : result.traces) inputs.push_back(trace.path);
  }
  return command_line(words, inputs);
}

/// The user's own options for `identify`, then the law and the effects of the final model and `more`.
std::string final_model_command(const DiagnosedTraces& result, const ReportOptions& options,
                                const std::vector<std::string>& more = {}) {
  // Options that only `diagnose` knows go, and effects that the command names itself.
  std::vector<std::string> dropped = {"--confirm=", "--time-limit=", "--effect=", "--formula="}, words;
  if (!result.fits.empty()) {
    const FrictionModel& model = result.fits[result.best].model;
    const std::vector<std::string> names = model.effect_names();
    const std::vector<Law> fitted = IdentifyOptions().laws;  // without --law
    if (std::find(fitted.begin(), fitted.end(), model.law()) == fitted.end() &&
        !has_option(options.arguments, "--law")) {
      words = {"--law", std::string(to_string(model.law()))};
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (std::holds_alternative<Formula>(model.effects()[k])) {
        std::erase(dropped, "--formula=");  // it stays as the user wrote it
      } else {
        words.insert(words.end(), {"--effect", names[k]});
      }
    }
  }
  return command(joined(joined(words_of({}, options.arguments, dropped), words), more), options, result);
}

}  // namespace

std::string level_unit(const DiagnosedTraces& result) {
  return result.traces.empty() ? "" : unit_behind(friction_unit(result.traces.front().motion));
}

std::string law_text(const Diagnosis& diagnosis) {
  const std::string law = std::string(to_string(diagnosis.law)) + " law";
  return diagnosis.from_the_start.empty() ? law : law + " with " + enumerated(diagnosis.from_the_start);
}

std::string where_sentence(const std::vector<Share>& shares) {
  const Share* top = largest_share(shares);
  if (top == nullptr) return "The error above the noise floor varies with no single variable.";
  return fmt::format("{} of the error above the noise floor varies with {}.",
                     is_most(*top) ? "Most" : "The largest part", describe(top->variable).phrase);
}

std::string diagnosis_verdict(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  const auto level = [&](double value) { return significant(value, 3) + level_unit(result); };
  const std::vector<Rung> found = found_effects(d);
  const std::vector<std::string> possible = keys_of(d, EffectStatus::possible);
  const bool untestable = !keys_of(d, EffectStatus::untestable).empty();
  const std::string error = level(last_error(d)), floor = floor_clause(d, level(d.floor_rmse));
  const std::string first = d.ladder.empty() ? error : level(d.ladder.front().held_out_rmse);
  return fmt::format(fmt::runtime(sentences_on(d, !found.empty(), !possible.empty())), fmt::arg("law", law_text(d)),
                     fmt::arg("error", error), fmt::arg("floor", floor), fmt::arg("rivals", rivals(result)),
                     fmt::arg("untestable", untestable ? "; the effects that they cannot show are listed below" : ""),
                     fmt::arg("found", found_sentence(result, found)),
                     fmt::arg("them", found.size() > 1 ? "them" : "it"), fmt::arg("fall", fall(d, first, error, floor)),
                     fmt::arg("difference", d.messages.empty() ? "" : capitalised(d.messages.front())),
                     fmt::arg("possible", fmt::format("{}", fmt::join(possible, " or "))),
                     fmt::arg("rest", where_sentence(d.remaining.empty() ? d.where : d.remaining)),
                     fmt::arg("obstacle", obstacle(result)));
}

EffectInfo info_of(const DiagnosedTraces& result, std::string_view key) {
  std::vector<Effect> known;
  for (const Fit& fit : result.fits) known.insert(known.end(), fit.model.effects().begin(), fit.model.effects().end());
  const auto catalogue = effect_catalogue();
  known.insert(known.end(), catalogue.begin(), catalogue.end());
  for (const Effect& effect : known) {
    if (const EffectInfo info = describe(effect); info.key == key) return info;
  }
  return {};
}

std::string spelled(const DiagnosedTraces& result, const std::string& key) {
  const std::string name = info_of(result, key).spelled();
  return name.empty() ? key : name;
}

std::string equivalence_sentence(const Diagnosis& diagnosis) {
  std::vector<std::string> sentences;
  for (const Rung& rung : found_effects(diagnosis)) {
    if (rung.equivalent.empty()) continue;
    sentences.push_back(enumerated(joined({rung.added}, rung.equivalent)) + " fit these data equally well.");
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::string confirmation_sentence(const Confirmation& c, const DiagnosedTraces& result) {
  if (!std::isfinite(c.final_rmse)) {
    return c.path + ": not tried: this run cannot be analysed (run identify on it to see why)";
  }
  const auto level = [&](double value) { return significant(value, 3) + level_unit(result); };
  if (result.diagnosis.ladder.size() >= 2) {
    return fmt::format("{}: with every parameter frozen the error goes from {} to {} ({}): {}", c.path,
                       significant(c.base_rmse, 3), level(c.final_rmse), p_value_text(c.p_value),
                       is_confirmed(c) ? "confirmed" : "not confirmed");
  }
  const std::string error = c.path + ": the error of the law is " + level(c.final_rmse);
  const double ratio = c.final_rmse / c.floor_rmse;
  if (!std::isfinite(ratio)) return error;
  return fmt::format("{}, {} times the noise floor of that run ({}): {}", error, significant(ratio, 2),
                     level(c.floor_rmse), contradicts_law(c) ? "not confirmed" : "confirmed");
}

std::string diagnose_command(const DiagnosedTraces& result, const ReportOptions& options) {
  return command(words_of({"diagnose"}, options.arguments), options, result);
}

Suggestion next_after_diagnosis(const DiagnosedTraces& result, const ReportOptions& options) {
  const Verdict verdict = result.diagnosis.verdict;
  const std::string& formula = result.diagnosis.formula;
  const bool one = result.traces.size() == 1, too_little = verdict == Verdict::not_enough_data;
  const bool added = !result.fits.empty() && !result.fits[result.best].model.effects().empty();
  const std::vector<std::string> csv = {"--csv", one ? csv_folder_for(result.traces.front().path) : "diagnosis-csv"};
  const auto model = [&](const std::vector<std::string>& more) { return final_model_command(result, options, more); };
  return first_of({{verdict == Verdict::unfinished, "to search to the end",
                    command(words_of({"diagnose"}, options.arguments, {"--time-limit="}), options, result)},
                   {one && verdict == Verdict::unexplained && !formula.empty(),
                    "to fit the law with a formula for what remains", model({"--formula", formula})},
                   {one && too_little, "to fit the law as far as these data go", model({})},
                   {one && added && verdict != Verdict::sufficient, "to fit the law with the effects found", model({})},
                   {one && verdict == Verdict::sufficient && !options.csv_written,
                    "to plot the curve, the residuals and the cycles", model(csv)},
                   {!options.csv_written && !too_little, "to plot the samples beside the final model",
                    command(joined(words_of({"diagnose"}, options.arguments), csv), options, result)},
                   {true, "to see the effects that a trace can show", "identify effects"}});
}

}  // namespace tribofit
