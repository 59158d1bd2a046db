#include "diagnosis_sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "diagnosis/conclusions.hpp"
#include "numbers.hpp"

namespace tribofit {
namespace {

/// "runout (A = 0.048 +/- 0.001): the disc runs out of true, ..." without an end; the first parameter says how strong
/// the effect is.
std::string named_effect(const DiagnosedTraces& result, const Rung& rung) {
  std::string text = spelled(result, rung.added);
  const EffectFinding* finding = finding_of(result.diagnosis, rung.added);
  if (finding != nullptr && !finding->parameters.empty() && !result.traces.empty()) {
    const FitParameter& p = finding->parameters.front();
    text += fmt::format(" ({} = {})", p.parameter.name, value_text(p, result.traces.front().motion));
  }
  const std::string statement = info_of(result, rung.added).statement;
  return statement.empty() ? text : text + ": " + statement;
}

/// The effect, or "runout or drift, which these data cannot distinguish" for a group.
std::string found_clause(const DiagnosedTraces& result, const Rung& rung) {
  if (rung.equivalent.empty()) return named_effect(result, rung);
  return fmt::format("{} or {}, which these data cannot distinguish; the best fit has {}", spelled(result, rung.added),
                     enumerated(rung.equivalent, "or"), named_effect(result, rung));
}

std::string found_sentence(const DiagnosedTraces& result) {
  const std::vector<Rung> found = found_effects(result.diagnosis);
  if (found.empty()) return "The model is incomplete.";
  if (found.size() == 1) return "The effect found is " + found_clause(result, found.front()) + ".";
  std::string text = fmt::format("{} effects were found:", found.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    text += fmt::format(" ({}) {}.", k + 1, found_clause(result, found[k]));
  }
  return text;
}

class Sentences {
 public:
  explicit Sentences(const DiagnosedTraces& result) : result_(result), d_(result.diagnosis) {}

  std::string verdict() const {
    switch (d_.verdict) {
      case Verdict::sufficient:
        return fmt::format(
            "The {} is enough: its held-out error is {}, {}.{} These data show no further effect{}.", law_text(d_),
            level(last()), floor_clause(), rivals(),
            keys_of(EffectStatus::untestable).empty() ? "" : "; the effects that they cannot show are listed below");
      case Verdict::effect_found:
        return fmt::format("{} With {} {}.{}", found_sentence(result_), found_effects(d_).size() > 1 ? "them" : "it",
                           fall(), rivals());
      case Verdict::unexplained:
        return unexplained();
      case Verdict::unconfirmed:
        return unconfirmed();
      case Verdict::unfinished:
        return unfinished();
      case Verdict::not_enough_data:
        break;
    }
    return "No diagnosis can be made from these data: " + obstacle() + ".";
  }

 private:
  /// What stands in the way of any diagnosis.
  std::string obstacle() const {
    if (!d_.messages.empty()) return d_.messages.front();
    for (const Identification& trace : result_.traces) {
      if (!trace.analysed && !trace.warnings.empty()) return trace.warnings.back();
    }
    return "too few cycles to hold any out";
  }

  std::string level(double value) const { return significant(value, 3) + level_unit(result_); }
  double last() const { return d_.ladder.empty() ? std::nan("") : d_.ladder.back().held_out_rmse; }
  std::vector<std::string> keys_of(EffectStatus status) const {
    std::vector<std::string> keys;
    for (const EffectFinding& e : d_.effects) {
      if (e.status == status) keys.push_back(e.key);
    }
    return keys;
  }

  /// How the error stands to the noise floor, after a comma: "at the noise floor (0.0030)".
  std::string floor_clause() const {
    const std::string floor = level(d_.floor_rmse);
    switch (against_floor(last(), d_.floor_rmse)) {
      case FloorComparison::unknown:
        return "and no noise floor is known";
      case FloorComparison::below:
        if (d_.floor_is_sampling) return fmt::format("less than what the sampling leaves unknown ({})", floor);
        return fmt::format("less than the noise floor of {}, so the noise floor is overestimated here", floor);
      case FloorComparison::at:
        // Where something remains that is not noise, its error may still be as small as the noise.
        if (d_.verdict == Verdict::unexplained) return fmt::format("and the noise floor is {}", floor);
        return fmt::format("at the noise floor ({})", floor);
      case FloorComparison::above:
        break;
    }
    return fmt::format("still {} times the noise floor of {}", significant(last() / d_.floor_rmse, 2), floor);
  }

  /// "the held-out error falls from 0.0088 to 0.0030, ..."
  std::string fall() const {
    if (d_.ladder.size() < 2) return fmt::format("the held-out error is {}, {}", level(last()), floor_clause());
    const std::string first = level(d_.ladder.front().held_out_rmse);
    if (first != level(last())) {
      return fmt::format("the held-out error {} from {} to {}, {}",
                         last() < d_.ladder.front().held_out_rmse ? "falls" : "rises", first, level(last()),
                         floor_clause());
    }
    return fmt::format("the held-out error stays at {}, {}{}", first, floor_clause(), evidence_before_fit());
  }

  /// " The exponential and fractional laws do as well on these data."
  std::string rivals() const {
    if (d_.rival_laws.empty()) return "";
    std::vector<std::string> names;
    for (const Law& law : d_.rival_laws) names.emplace_back(to_string(law));
    const bool one = names.size() == 1;
    return fmt::format(" The {} {} as well on these data.", enumerated(names), one ? "law does" : "laws do");
  }

  /// What shows effects that were found before any fit, where the held-out error does not.
  std::string evidence_before_fit() const {
    std::string text;
    for (const Rung& rung : found_effects(d_)) {
      const EffectFinding* finding = finding_of(d_, rung.added);
      if (finding == nullptr || std::isfinite(finding->held_out_rmse)) continue;
      text += fmt::format("; {} rests on other evidence: {}", rung.added, finding->reason);
    }
    return text;
  }

  std::string unconfirmed() const {
    if (!found_effects(d_).empty())
      return fmt::format("{} A run not used in the fit does not confirm it.", found_sentence(result_));
    return fmt::format(
        "The {} is enough for the data it was fitted to: its held-out error is {}, {}. A run not used in the fit "
        "contradicts it.",
        law_text(d_), level(last()), floor_clause());
  }

  std::string unfinished() const {
    const std::string why = "The time was over before every effect was tried.";
    if (!found_effects(d_).empty()) return fmt::format("{} So far: {} {}.", why, found_sentence(result_), fall());
    return fmt::format("{} So far nothing is added to the {}: its held-out error is {}, {}.", why, law_text(d_),
                       level(last()), floor_clause());
  }

  std::string unexplained() const {
    if (d_.runs_differ) {
      const std::string found = found_effects(d_).empty() ? "" : found_sentence(result_) + " ";
      return found + capitalised(d_.messages.front()) + ".";
    }
    const std::string rest = where_sentence(d_.remaining.empty() ? d_.where : d_.remaining);
    if (const std::vector<std::string> keys = keys_of(EffectStatus::possible); !keys.empty()) {
      return fmt::format("{} What remains looks like {}, but these data do not prove it: {}.",
                         found_effects(d_).empty() ? "No effect is proven." : found_sentence(result_),
                         fmt::join(keys, " or "), fall());
    }
    if (found_effects(d_).empty()) {
      return fmt::format("No effect of the catalogue explains what remains: the held-out error of the {} is {}, {}. {}",
                         law_text(d_), level(last()), floor_clause(), rest);
    }
    return fmt::format("{} More remains: {}. No effect explains the rest. {}", found_sentence(result_), fall(), rest);
  }

  const DiagnosedTraces& result_;
  const Diagnosis& d_;
};

std::string command(const std::vector<std::string>& words, const ReportOptions& options,
                    const DiagnosedTraces& result) {
  std::vector<std::string> inputs = options.inputs;
  if (inputs.empty()) {
    for (const Identification& trace : result.traces) inputs.push_back(trace.path);
  }
  return command_line(words, inputs);
}

/// The law found is none of those that `identify` fits without --law.
bool must_name_law(const Law& law, const ReportOptions& options) {
  const std::vector<Law> fitted = IdentifyOptions().laws;
  return std::find(fitted.begin(), fitted.end(), law) == fitted.end() && !has_option(options.arguments, "--law");
}

/// The user's own options for `identify`, then the law and the effects of the final model and `more`.
std::string final_model_command(const DiagnosedTraces& result, const ReportOptions& options,
                                const std::vector<std::string>& more = {}) {
  // Options that only `diagnose` knows go, and effects that the command names itself.
  std::vector<std::string> dropped = {"--confirm", "--time-limit", "--effect", "--formula"}, words;
  if (!result.fits.empty()) {
    const FrictionModel& model = result.fits[result.best].model;
    const std::vector<std::string> names = model.effect_names();
    if (must_name_law(model.law(), options)) words.insert(words.end(), {"--law", std::string(to_string(model.law()))});
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (std::holds_alternative<Formula>(model.effects()[k])) {
        std::erase(dropped, "--formula");  // it stays as the user wrote it
      } else {
        words.insert(words.end(), {"--effect", names[k]});
      }
    }
  }
  return command(joined(joined(words_of({}, options.arguments, {}, dropped), words), more), options, result);
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
  return Sentences(result).verdict();
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
    std::vector<std::string> group = rung.equivalent;
    group.insert(group.begin(), rung.added);
    sentences.push_back(enumerated(group) + " fit these data equally well.");
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::string confirmation_sentence(const Confirmation& c, const DiagnosedTraces& result) {
  if (!std::isfinite(c.final_rmse)) {
    return c.path + ": not tried: this run cannot be analysed (run identify on it to see why)";
  }
  const std::string unit = level_unit(result);
  if (result.diagnosis.ladder.size() < 2) {
    const std::string error =
        fmt::format("{}: the error of the law is {}{}", c.path, significant(c.final_rmse, 3), unit);
    const double ratio = c.final_rmse / c.floor_rmse;
    if (!std::isfinite(ratio)) return error;
    return fmt::format("{}, {} times the noise floor of that run ({}{}): {}", error, significant(ratio, 2),
                       significant(c.floor_rmse, 3), unit, contradicts_law(c) ? "not confirmed" : "confirmed");
  }
  return fmt::format("{}: with every parameter frozen the error goes from {} to {}{} ({}): {}", c.path,
                     significant(c.base_rmse, 3), significant(c.final_rmse, 3), unit, p_value_text(c.p_value),
                     is_confirmed(c) ? "confirmed" : "not confirmed");
}

std::string diagnose_command(const DiagnosedTraces& result, const ReportOptions& options) {
  return command(words_of({"diagnose"}, options.arguments), options, result);
}

Suggestion next_after_diagnosis(const DiagnosedTraces& result, const ReportOptions& options) {
  const Verdict verdict = result.diagnosis.verdict;
  const bool one = result.traces.size() == 1;
  const std::vector<std::string> csv = {"--csv", one ? csv_folder_for(result.traces.front().path) : "diagnosis-csv"};
  if (verdict == Verdict::unfinished) {
    return {"to search to the end",
            command(words_of({"diagnose"}, options.arguments, {}, {"--time-limit"}), options, result)};
  }
  if (one) {
    const bool added = !result.fits.empty() && !result.fits[result.best].model.effects().empty();
    if (verdict == Verdict::unexplained && !result.diagnosis.formula.empty()) {
      return {"to fit the law with a formula for what remains",
              final_model_command(result, options, {"--formula", result.diagnosis.formula})};
    }
    if (verdict == Verdict::not_enough_data) {
      return {"to fit the law as far as these data go", final_model_command(result, options)};
    }
    if (added && verdict != Verdict::sufficient) {
      return {"to fit the law with the effects found", final_model_command(result, options)};
    }
    if (verdict == Verdict::sufficient && !options.csv_written) {
      return {"to plot the curve, the residuals and the cycles", final_model_command(result, options, csv)};
    }
  }
  if (!options.csv_written && verdict != Verdict::not_enough_data) {
    return {"to plot the samples beside the final model",
            command(joined(words_of({"diagnose"}, options.arguments), csv), options, result)};
  }
  return {"to see the effects that a trace can show", "identify effects"};
}

}  // namespace tribofit
