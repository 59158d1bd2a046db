#include "diagnosis_sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "numbers.hpp"

namespace tribofit {
namespace {

std::string variable_text(const std::string& variable) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 8> names = {
      {{"velocity", "the sliding speed"},
       {"branch", "the branch, speeding up or slowing down"},
       {"time", "time"},
       {"angle", "the disc angle"},
       {"stick-time", "the stick time before a slip"},
       {"load", "the normal load"},
       {"frequency", "a narrow band of frequency"},
       {"stick", "creep in stick"}}};
  const auto at = std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.first == variable; });
  return at == names.end() ? variable : std::string(at->second);
}

bool is_force(const DiagnosedTraces& result) {
  return !result.traces.empty() && result.traces.front().motion.friction_kind == FrictionKind::force;
}

/// The first parameter of an effect, the one that says how strong it is: "A = 0.048 +/- 0.001".
std::string strength(const DiagnosedTraces& result, const EffectFinding& finding) {
  if (finding.parameters.empty() || result.traces.empty()) return "";
  const FitParameter& p = finding.parameters.front();
  const std::string unit = shown_unit(p, result.traces.front().motion);
  return fmt::format("{} = {}{}", p.parameter.name, with_error(shown(p, p.value), shown(p, p.std_error)),
                     unit == "1" ? "" : " " + unit);
}

/// As the command line takes it.
std::string spelled(const DiagnosedTraces& result, const std::string& key) {
  const std::string name = info_of(result, key).spelled();
  return name.empty() ? key : name;
}

/// "runout (A = 0.048 +/- 0.001), which means that ..." without an end.
std::string named_effect(const DiagnosedTraces& result, const Rung& rung) {
  std::string text = spelled(result, rung.added);
  const EffectFinding* finding = finding_of(result.diagnosis, rung.added);
  const std::string size = finding == nullptr ? "" : strength(result, *finding);
  if (!size.empty()) text += " (" + size + ")";
  const std::string statement = info_of(result, rung.added).statement;
  return statement.empty() ? text : text + ": " + statement;
}

/// "one of these, which cannot be told apart here: ..." for a group, else the effect.
std::string missing_clause(const DiagnosedTraces& result, const Rung& rung) {
  if (rung.equivalent.empty()) return named_effect(result, rung);
  return fmt::format("{} or {}, which these data cannot tell apart. The best fit has {}", spelled(result, rung.added),
                     enumerated(rung.equivalent, "or"), named_effect(result, rung));
}

std::string missing_sentence(const DiagnosedTraces& result) {
  const std::vector<Rung> missing = missing_effects(result.diagnosis);
  if (missing.empty()) return "Something is missing.";
  if (missing.size() == 1) return "What is missing is " + missing_clause(result, missing.front()) + ".";
  std::string text = fmt::format("{} effects are missing.", missing.size());
  for (std::size_t k = 0; k < missing.size(); ++k) {
    text += fmt::format(" ({}) {}.", k + 1, missing_clause(result, missing[k]));
  }
  return text;
}

class Sentences {
 public:
  explicit Sentences(const DiagnosedTraces& result) : result_(result), d_(result.diagnosis) {}

  std::string verdict() const {
    switch (d_.verdict) {
      case Verdict::sufficient:
        return sufficient();
      case Verdict::effect_found:
        return fmt::format("{} With {} {}.", missing_sentence(result_), missing_effects(d_).size() > 1 ? "them" : "it",
                           fall());
      case Verdict::unexplained:
        return unexplained();
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

  std::string level(double value) const { return significant(value, 3) + (is_force(result_) ? " N" : ""); }
  double last() const { return d_.ladder.empty() ? std::nan("") : d_.ladder.back().held_out_rmse; }
  std::string law() const { return law_text(d_); }

  /// How the error stands to the floor: "at the floor of 0.0030, which is noise and scatter".
  std::string against_floor() const {
    const double ratio = last() / d_.floor_rmse;
    if (!std::isfinite(ratio)) return "and no floor is known";
    if (ratio < 1 / kNoise) {
      return fmt::format("less than the floor of {}, so the floor is overestimated here", level(d_.floor_rmse));
    }
    if (ratio <= kNoise) return fmt::format("at the floor of noise and scatter ({})", level(d_.floor_rmse));
    return fmt::format("still {} times the floor of {}", significant(ratio, 2), level(d_.floor_rmse));
  }

  /// "the error on data it has not seen falls from 0.0088 to 0.0030, ..."
  std::string fall() const {
    if (d_.ladder.size() < 2)
      return fmt::format("the error on data not seen is {}, {}", level(last()), against_floor());
    return fmt::format("the error on data not seen falls from {} to {}, {}", level(d_.ladder.front().held_out_rmse),
                       level(last()), against_floor());
  }

  std::string sufficient() const {
    return fmt::format(
        "The {} is enough: it leaves {} on data it has not seen, {}. Nothing is missing that these "
        "data could show{}.",
        law(), level(last()), against_floor(), untestable() ? "; what they cannot show stands below" : "");
  }

  std::string unexplained() const {
    const std::string rest = where_sentence(d_.remaining.empty() ? d_.where : d_.remaining);
    if (missing_effects(d_).empty()) {
      return fmt::format(
          "Something is missing that no effect of the catalogue explains: the {} leaves {} on data "
          "it has not seen, {}. {}",
          law(), level(last()), against_floor(), rest);
    }
    return fmt::format("{} But that is not all: {}, and no effect explains the rest. {}", missing_sentence(result_),
                       fall(), rest);
  }

  bool untestable() const {
    return std::any_of(d_.effects.begin(), d_.effects.end(),
                       [](const EffectFinding& e) { return e.status == EffectStatus::untestable; });
  }

  const DiagnosedTraces& result_;
  const Diagnosis& d_;
};

/// The user's own options for a command that names its effects itself; those that only `diagnose` knows go.
std::vector<std::string> kept_options(const std::vector<std::string>& arguments, bool formulas) {
  std::vector<std::string> kept;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string& name = arguments[k];
    const bool dropped = name == "--confirm" || name == "--effect" || (name == "--formula" && !formulas);
    if (!dropped) {
      kept.push_back(name);
    } else {
      ++k;  // its value
    }
  }
  return kept;
}

std::string command(std::vector<std::string> words, const TerminalOptions& options, const DiagnosedTraces& result) {
  std::vector<std::string> inputs = options.inputs;
  if (inputs.empty()) {
    for (const Identification& trace : result.traces) inputs.push_back(trace.path);
  }
  std::string text = "identify";
  for (const std::string& word : words) text += " " + shell_quoted(word);
  for (const std::string& input : inputs) text += " " + shell_quoted(input.rfind('-', 0) == 0 ? "./" + input : input);
  return text;
}

/// `identify` with the effects of the final model.
std::vector<std::string> final_model(const DiagnosedTraces& result, const TerminalOptions& options) {
  std::vector<std::string> effects;
  bool formulas = false;
  if (!result.fits.empty()) {
    const FrictionModel& model = result.fits[result.best].model;
    const std::vector<std::string> names = model.effect_names();
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (std::holds_alternative<Formula>(model.effects()[k])) {
        formulas = true;  // as the user wrote it
      } else {
        effects.insert(effects.end(), {"--effect", names[k]});
      }
    }
  }
  std::vector<std::string> words = kept_options(options.arguments, formulas);
  words.insert(words.end(), effects.begin(), effects.end());
  return words;
}

std::vector<std::string> diagnose_again(const TerminalOptions& options) {
  std::vector<std::string> words = {"diagnose"};
  words.insert(words.end(), options.arguments.begin(), options.arguments.end());
  return words;
}

std::string csv_folder(const DiagnosedTraces& result) {
  if (result.traces.size() != 1) return "diagnosis-csv";
  return std::filesystem::path(result.traces.front().path).stem().string() + "-csv";
}

}  // namespace

std::vector<Rung> missing_effects(const Diagnosis& d) {
  std::vector<Rung> missing(d.ladder.begin() + (d.ladder.empty() ? 0 : 1), d.ladder.end());
  const std::size_t rungs = missing.size();
  const auto mentioned = [&](const std::string& key) {
    return std::any_of(missing.begin(), missing.end(), [&](const Rung& r) {
      return r.added == key || std::find(r.equivalent.begin(), r.equivalent.end(), key) != r.equivalent.end();
    });
  };
  // What the user put into the model was not found missing.
  const auto given = [&](const std::string& key) {
    return std::any_of(d.from_the_start.begin(), d.from_the_start.end(),
                       [&](const std::string& name) { return name.substr(0, name.find(':')) == key; });
  };
  for (const EffectFinding& e : d.effects) {
    if (given(e.key)) continue;
    if (e.status == EffectStatus::found && !mentioned(e.key)) missing.push_back({e.key, e.held_out_rmse, 0, 0, {}});
  }
  if (missing.size() == rungs) return missing;
  for (const EffectFinding& e : d.effects) {
    if (e.status == EffectStatus::equivalent && !mentioned(e.key)) missing.back().equivalent.push_back(e.key);
  }
  return missing;
}

std::vector<Share> worth_naming(const std::vector<Share>& shares) {
  std::vector<Share> kept;
  for (const Share& s : shares) {
    if (s.share >= kWorthNaming && !(s.p_value > kSignificant)) kept.push_back(s);
  }
  return kept;
}

std::string law_text(const Diagnosis& diagnosis) {
  const std::string law = std::string(to_string(diagnosis.law)) + " law";
  return diagnosis.from_the_start.empty() ? law : law + " with " + enumerated(diagnosis.from_the_start);
}

std::string where_sentence(const std::vector<Share>& shares) {
  const std::vector<Share> kept = worth_naming(shares);
  if (kept.empty()) return "The error above the floor goes with no single variable.";
  const Share& top =
      *std::max_element(kept.begin(), kept.end(), [](const Share& a, const Share& b) { return a.share < b.share; });
  constexpr double kMost = 0.5;
  return fmt::format("{} of the error above the floor goes with {}.", top.share >= kMost ? "Most" : "The largest part",
                     variable_text(top.variable));
}

std::string diagnosis_verdict(const DiagnosedTraces& result) {
  return Sentences(result).verdict();
}

const EffectFinding* finding_of(const Diagnosis& diagnosis, std::string_view key) {
  const auto at = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                               [&](const EffectFinding& e) { return e.key == key; });
  return at == diagnosis.effects.end() ? nullptr : &*at;
}

EffectInfo info_of(const DiagnosedTraces& result, std::string_view key) {
  for (const Fit& fit : result.fits) {
    for (const Effect& effect : fit.model.effects()) {
      EffectInfo info = describe(effect);
      if (info.key == key) return info;
    }
  }
  for (const Effect& effect : effect_catalogue()) {
    EffectInfo info = describe(effect);
    if (info.key == key) return info;
  }
  return {};
}

std::string enumerated(const std::vector<std::string>& names, std::string_view last) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) text += k + 1 == names.size() ? fmt::format(" {} ", last) : ", ";
    text += names[k];
  }
  return text;
}

std::string diagnose_command(const DiagnosedTraces& result, const TerminalOptions& options) {
  return command(diagnose_again(options), options, result);
}

std::string formula_command(const DiagnosedTraces& result, const TerminalOptions& options) {
  if (result.diagnosis.formula.empty()) return "";
  std::vector<std::string> words = final_model(result, options);
  words.insert(words.end(), {"--formula", result.diagnosis.formula});
  return command(std::move(words), options, result);
}

Suggestion next_after_diagnosis(const DiagnosedTraces& result, const TerminalOptions& options) {
  const Verdict verdict = result.diagnosis.verdict;
  const bool one = result.traces.size() == 1;
  if (verdict == Verdict::unexplained && one && !result.diagnosis.formula.empty()) {
    return {"to fit the law with a formula for what remains", formula_command(result, options)};
  }
  const bool added = !result.fits.empty() && !result.fits[result.best].model.effects().empty();
  if (one && verdict == Verdict::not_enough_data) {
    return {"to fit the law as far as these data go", command(final_model(result, options), options, result)};
  }
  if (one && added && verdict != Verdict::sufficient) {
    return {"to fit the law with what was missing", command(final_model(result, options), options, result)};
  }
  if (one && verdict == Verdict::sufficient && !options.csv_written) {
    std::vector<std::string> words = final_model(result, options);
    words.insert(words.end(), {"--csv", csv_folder(result)});
    return {"to plot the curve, the residuals and the cycles", command(std::move(words), options, result)};
  }
  if (!options.csv_written && verdict != Verdict::not_enough_data) {
    std::vector<std::string> words = diagnose_again(options);
    words.insert(words.end(), {"--csv", csv_folder(result)});
    return {"to plot the samples beside the final model", command(std::move(words), options, result)};
  }
  return {"to see which effects can be told from a trace", "identify effects"};
}

}  // namespace tribofit
