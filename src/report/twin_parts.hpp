#pragma once

#include <string>

#include "commands.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/study/twin.hpp"

namespace tribofit {

/// What is said of a twin on a terminal and on a page alike.

/// The numbers of each law and of the rig beside it.
ReportSection twin_model(const TwinIdentification& result);

/// The bare law by its name, the one with effects by what is added.
std::string column_name(const Twin& twin, std::size_t column);

/// Measured and simulated measures, their differences in standard errors, and the root mean square of these.
ReportTable twin_table(const Twin& twin);

/// How the differences are made.
std::string twin_note(const Twin& twin);

/// Whether the twin moves as the record does, and where it does not.
std::string twin_verdict(const TwinIdentification& result);

/// Said first: a law that leaves clearly more than noise has the twin of another machine. Empty where it does not.
std::string law_warning(const TwinIdentification& result, const TerminalOptions& options);

/// options.arguments: without the verb.
Suggestion next_after_twin(const TwinIdentification& result, const TerminalOptions& options);

}  // namespace tribofit
