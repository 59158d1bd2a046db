#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "report/charts/trace_charts.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/report/terminal.hpp"
#include "verdict.hpp"

namespace tribofit {

/// Parts that several kinds of report have.

TerminalOptions terminal_like(const ReportOptions& options);
/// The name of a file without its folder, as text that is valid UTF-8.
std::string file_name(const std::string& path);
std::string curve_name(const Fit& fit);
bool has_parameters(const Fit& fit);

ReportText plain_text(std::string text);
ReportText soft_text(std::string text);
ReportText heading_text(std::string text);

/// Adds charts to a section.
void add(std::vector<Chart> charts, ReportSection& section);

/// Length, conditions and stick-slip of one trace.
std::vector<std::pair<std::string, std::string>> facts_of(const Identification& trace);
/// Checks, the worst first; with the trace each belongs to where there are several.
ReportTable health_table(std::span<const Identification> traces);
/// Every fit with its parameters, errors, correlations and notes.
void add_parameters(std::span<const Fit> fits, std::size_t best, const Motion& motion, const ReportOptions& options,
                    ReportSection& section);

/// Charts of one trace in the sections that a report has once.
struct TraceSections {
  ReportSection trace{"trace", "Model and measurement", {}}, law{"law", "Friction law", {}},
      errors{"errors", "Errors", {}}, cycles{"cycles", "Cycles and spectrum", {}};
  void add_trace(const DrawnTrace& drawn);
};

/// What was run: the command, the inputs with their checksums, how they were read, what to do next.
ReportSection run_section(const std::string& command, std::span<const Identification> traces, const Suggestion& next);

/// Those of the sections that hold anything.
void append_filled(std::vector<ReportSection> sections, Report& report);

/// "Friction law by tribofit 0.1.0".
std::string made_by(const std::string& what);

}  // namespace tribofit
