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

/// A study of another kind as the next command. `more`: options behind the kind.
struct NextStudy {
  std::string purpose, kind;
  std::vector<std::string> more = {};
};

/// The report of a study: warnings, facts and numbers of the machine with their standard errors, the sections of the
/// study, how to run it again, what to do next. kind: "speed", "phase", ...; lead: what a reader must know.
Report study_report(const StudiedMachine& studied, const std::string& kind, const std::string& title, std::string lead,
                    std::vector<ReportSection> sections, const NextStudy& next, const ReportOptions& options);

/// Its JSON: {"tool", "study": {"kind", "machine", members of `body`}}.
std::string study_text(const StudiedMachine& studied, const char* kind, const Json& body, const JsonOptions& options);

/// The regime and the measures of a motion, under the names of the columns in CSV.
Json settled_json(const Settled& settled);
/// The same, and why a motion did not settle.
Json explained_json(const Settled& settled);
/// ",frequency_hz,stick_time_s,..." with something before each name.
std::string measure_columns(const std::string& before = "");

/// A column a measure.
void add_measure_columns(ReportTable& table);
/// The regime and the measures of a motion, behind what `row` holds.
std::vector<std::string> row_of(std::vector<std::string> row, const Settled& settled);

/// "6.283 mm/s (4.000 rpm)".
std::string velocity_text(double velocity, const Machine& machine);
/// A measure in the unit of the files: one less thing to mistake.
std::string measure_text(const Settled& settled, const MeasureInfo& measure);
/// Why a motion did not settle; empty where it did.
std::string seen_sentence(const Settled& settled);

}  // namespace tribofit
