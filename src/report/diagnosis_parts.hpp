#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "commands.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit {

/// What is said of a diagnosis, on a terminal and on a page alike.

/// "Most of the error above the noise floor varies with the disc angle."
std::string where_sentence(const std::vector<Share>& shares);

/// What the diagnosis comes to, as an engineer would say it.
std::string diagnosis_verdict(const DiagnosedTraces& result);

/// "exponential law", or "exponential law with viscous" where the model has had effects from the start.
std::string law_text(const Diagnosis& diagnosis);

/// What an effect of that key says about itself, in the form that a model of the result has; empty where it is unknown.
EffectInfo info_of(const DiagnosedTraces& result, std::string_view key);

/// An effect as the command line takes it.
std::string spelled(const DiagnosedTraces& result, const std::string& key);

/// Which effects fit equally well; empty where each stands alone.
std::string equivalence_sentence(const Diagnosis& diagnosis);

/// How the finding did on a run that was not used in the fit.
std::string confirmation_sentence(const Confirmation& confirmation, const DiagnosedTraces& result);

/// " N" where friction is a force.
std::string level_unit(const DiagnosedTraces& result);

/// The command to type next, with the user's own options.
Suggestion next_after_diagnosis(const DiagnosedTraces& result, const ReportOptions& options);

/// The diagnosis itself as a command, with the user's own options.
std::string diagnose_command(const DiagnosedTraces& result, const ReportOptions& options);

}  // namespace tribofit
