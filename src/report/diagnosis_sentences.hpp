#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/report/terminal.hpp"
#include "verdict.hpp"

namespace tribofit {

/// Held-out error over the floor up to which what remains is called noise.
inline constexpr double kNoise = 1.15;
/// Share of the error above the floor from which a variable is worth naming, and its p value up to which it is.
inline constexpr double kWorthNaming = 0.05, kSignificant = 0.05;

/// What is missing: the rungs above the base law, then what shows in the motion and is no rung. Effects that fit as
/// well as one of the latter stand with the last of them.
std::vector<Rung> missing_effects(const Diagnosis& diagnosis);

/// Shares worth naming, in their order.
std::vector<Share> worth_naming(const std::vector<Share>& shares);

/// "Most of the error above the floor goes with the disc angle."
std::string where_sentence(const std::vector<Share>& shares);

/// What the diagnosis comes to, as an engineer would say it.
std::string diagnosis_verdict(const DiagnosedTraces& result);

/// The effect that a finding or a rung is about; nullptr where none of that key is known here.
const EffectFinding* finding_of(const Diagnosis& diagnosis, std::string_view key);

/// What an effect of that key says about itself, in the form that a model of the result has; empty where it is unknown.
EffectInfo info_of(const DiagnosedTraces& result, std::string_view key);

/// "exponential law", or "exponential law with viscous" where the model has had effects from the start.
std::string law_text(const Diagnosis& diagnosis);

/// "a", "a and b", "a, b and c".
std::string enumerated(const std::vector<std::string>& names, std::string_view last = "and");

/// The command to type next, with the user's own options.
Suggestion next_after_diagnosis(const DiagnosedTraces& result, const TerminalOptions& options);

/// The diagnosis itself as a command, with the user's own options.
std::string diagnose_command(const DiagnosedTraces& result, const TerminalOptions& options);

/// The command that adds the formula of what remains; empty where there is none.
std::string formula_command(const DiagnosedTraces& result, const TerminalOptions& options);

}  // namespace tribofit
