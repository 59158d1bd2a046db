#pragma once

#include <string>
#include <vector>

#include "tribofit/study/twin.hpp"
#include "tribofit/report/terminal.hpp"
#include "verdict.hpp"

namespace tribofit {

/// What is said of a twin on a terminal and on a page alike.

/// The numbers of a law with their errors: "exponential: mu_s 0.5090 +/- 0.0012, ...".
std::string law_sentence(const Fit& fit, const Motion& motion);
std::string rig_sentence(const RigFit& rig);

/// The bare law by its name, the one with effects by what is added.
std::string column_name(const Twin& twin, std::size_t column);

/// Measured and simulated measures, their differences in standard errors, and the root mean square of these: a header,
/// then the rows.
std::vector<std::vector<std::string>> twin_cells(const Twin& twin);

/// How the differences are made.
std::string twin_note(const Twin& twin);

/// Whether the twin moves as the record does, and where it does not.
std::string twin_verdict(const TwinIdentification& result);

/// options.arguments: without the verb.
Suggestion next_after_twin(const TwinIdentification& result, const TerminalOptions& options);

}  // namespace tribofit
