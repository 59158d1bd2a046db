#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fit_parts.hpp"
#include "record_parts.hpp"
#include "report/charts/trace_charts.hpp"

namespace tribofit {

/// Parts that several kinds of report have.

TerminalOptions terminal_like(const ReportOptions& options);
/// The name of a file without its folder, as text that is valid UTF-8.
std::string file_name(const std::string& path);

/// A report that says what it is; kind: "diagnosis", made: "Diagnosis".
Report titled_report(const std::string& kind, const std::string& title, const std::string& made, std::string lead);

/// Length, conditions and stick-slip of one trace.
Facts facts_of(const Identification& trace);

/// The best fit, then others that are wanted beside it; at most `most`.
std::vector<DrawnModel> drawn_models(std::span<const Fit> fits, std::size_t best, std::size_t most,
                                     const std::function<bool(const Fit&)>& wanted);
/// Laws that are drawn over speed: of the models beside the samples, then of others, each name once.
std::vector<DrawnModel> drawn_curves(const std::vector<DrawnModel>& models, std::span<const Fit> others);

/// Charts of one trace in the sections that a report has once.
struct TraceSections {
  ReportSection trace{"trace", "Model and measurement", {}}, law{"law", "Friction law", {}},
      errors{"errors", "Errors", {}}, cycles{"cycles", "Cycles and spectrum", {}};
  void add_trace(const DrawnTrace& drawn);
};

/// What was run: the command and what made the report; `more` is said behind that.
ReportSection run_section(const std::string& command, const std::string& more = "");
/// The same with the inputs and their checksums, how they were read, what to do next.
ReportSection run_section(const std::string& command, std::span<const Identification> traces, const Suggestion& next);

}  // namespace tribofit
