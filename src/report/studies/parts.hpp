#pragma once

#include <string>
#include <vector>

#include "output/csv_table.hpp"
#include "report/charts/styles.hpp"
#include "report/json_parts.hpp"
#include "report/numbers.hpp"
#include "report/report_parts.hpp"
#include "statistics/thinning.hpp"
#include "tribofit/report/study.hpp"

namespace tribofit {

/// What all studies have in common; each of them is one file beside this one, with all that is said, drawn and written
/// of it.

/// The report of a study: warnings, facts and numbers of the machine with their standard errors, the sections of the
/// study, how to run it again, what to do next. kind: "speed", "phase", ...; lead: what a reader must know; seen: more
/// warnings, empty ones among them.
Report study_report(const StudiedMachine& studied, const char* kind, std::string lead,
                    std::vector<ReportSection> sections, const ReportOptions& options,
                    const std::vector<std::string>& seen = {});

/// Its JSON: {"tool", "study": {"kind", "machine", members of `body`}}.
std::string study_text(const StudiedMachine& studied, const char* kind, const Json& body, const JsonOptions& options);

/// The regime and the measures of a motion, under the names of the columns in CSV; way: "up" makes them "regime_up",
/// "up_frequency_hz", ...
Json settled_json(const Settled& settled, const std::string& way = "");
/// The same, and why a motion did not settle.
Json explained_json(const Settled& settled);

/// A table of motions: their speed, columns of these names, the regime and the measures.
ReportTable settled_table(const char* caption, const std::vector<const char*>& more = {});
/// A row of it, behind what `row` holds.
std::vector<std::string> row_of(std::vector<std::string> row, const Settled& settled);

/// "6.283 mm/s (4.000 rpm)".
std::string velocity_text(double velocity, const Machine& machine);
/// A measure in the unit of the files: one less thing to mistake.
std::string measure_text(const Settled& settled, const MeasureInfo& measure);
/// Why a motion did not settle; empty where it did.
std::string seen_sentence(const Settled& settled);

}  // namespace tribofit
