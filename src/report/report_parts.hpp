#pragma once

#include <fmt/format.h>

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "commands.hpp"
#include "numbers.hpp"
#include "report/charts/trace_charts.hpp"

namespace tribofit {

/// What several kinds of text and page have in common.

/// "sliding (stated)", "points (no time column)", "stick-slip".
std::string kind_text(const Identification& record);
/// Cycles, frequency, amplitude, stick and slip time, branches, RMS.
Facts stick_slip_facts(const Identification& record);
/// Adds kind, size, radius, disc speed and load with where each comes from, and those facts to the head of a page.
void add_facts(const Identification& record, Report& report);
/// Checks, the worst first; with the trace each belongs to where there are several.
ReportTable health_table(std::span<const Identification> traces);
/// Name, size and reading of the trace, conditions and health: how the text of identify, rig and twin begins.
ReportSection record_section(const Identification& record);

/// Every fit with its equation, parameters, errors, correlations and notes, and what their intervals are; nothing where
/// there are no fits.
void add_fits(std::span<const Fit> fits, std::size_t best, const Motion& motion, bool instruments_declared,
              ReportSection& section);
/// Per-cycle extremes beside the joint fit and by how much they differ, then the best law against each other one.
void add_comparisons(std::span<const Fit> fits, std::size_t best, const Motion& motion, ReportSection& section);

/// A model and its parameters: what a reader looks for first. name: "best law"; nothing where there is no fit.
Facts model_facts(const char* name, std::span<const Fit> fits, std::size_t best, const Motion& motion);

/// A row a value, in the digits that its error allows; columns that say nothing are left out. name: of the first one.
ReportTable value_table(const char* name, const std::vector<ResultParameter>& values);
/// What a reader must know of a parameter: "at bound, correlated"; empty where nothing.
std::string remarks_on(std::span<const FitParameter> parameters, std::span<const Correlation> correlations,
                       std::size_t index);
/// Every parameter of a fit; systematic: instruments were declared.
ReportTable parameter_table(const Fit& fit, const Motion& motion, bool systematic);

/// The name of a file without its folder, as text that is valid UTF-8.
std::string file_name(const std::string& path);

/// A report that says what it is; kind: "diagnosis".
Report titled_report(const std::string& kind, const std::string& title, std::string lead);

/// Beside the samples the best fit, then others that are wanted, at most `most`; over speed these, then others, each
/// name once.
DrawnLaws drawn_laws(std::span<const Fit> fits, std::size_t best, std::size_t most,
                     const std::function<bool(const Fit&)>& wanted, std::span<const Fit> others);

/// Charts of one trace in the sections that a report has once.
struct TraceSections {
  ReportSection trace{"trace", "Model and measurement", {}}, law{"law", "Friction law", {}},
      errors{"errors", "Errors", {}}, cycles{"cycles", "Cycles and spectrum", {}};
  std::array<ReportSection*, 4> all() { return {&trace, &law, &errors, &cycles}; }
  void add_trace(const DrawnTrace& drawn);
  void add_models(const DrawnTrace& drawn);  ///< all of it but the cycles
  void add_cycles(const DrawnTrace& drawn);
};

/// How a text ends, but for what to do next: warnings and the lead of the report.
ReportSection result_section(const Report& report);

/// How a page ends. What was run: the command, the inputs with their checksums and how they were read, what to do next,
/// and what made the report; `more` is said behind that.
ReportSection run_section(const Report& report, const std::string& command, std::span<const Identification> traces = {},
                          const std::string& more = "");

/// A quantity of the rig, in the unit people read.
struct ShownRigValue {
  const char* name;
  RigValue value;
  double si;         ///< of one unit
  const char* unit;  ///< as a table shows it
  const char* key;   ///< as JSON names it
  std::string text() const;
};
/// Mass, damping, stiffness, natural frequency, damping ratio, stiffness by the slope of stick; per newton of the load
/// where that is not known.
std::array<ShownRigValue, 6> shown_rig(const RigFit& rig);

}  // namespace tribofit
