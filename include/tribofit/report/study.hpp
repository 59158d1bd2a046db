#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/study/identified.hpp"
#include "tribofit/study/map.hpp"
#include "tribofit/study/response.hpp"
#include "tribofit/study/sweep.hpp"

namespace tribofit {

/// Said first where law and rig stand for more than they were identified from: a law that leaves `ratio` times the
/// noise floor describes another machine. subject: "the twin does"; command: the diagnosis of the record.
std::string other_machine_warning(std::string_view subject, const Fit& fit, double ratio, const std::string& command);

/// {"tool", "study": {"kind", "machine", "parameters", ...}}; units are in the names. What is not known is null.
std::string study_json(const StudiedMachine& studied, const SpeedStudy& study, const JsonOptions& options = {});
std::string study_json(const StudiedMachine& studied, const std::vector<Portrait>& study,
                       const JsonOptions& options = {});
std::string study_json(const StudiedMachine& studied, const Response& study, const JsonOptions& options = {});
std::string study_json(const StudiedMachine& studied, const std::vector<Sensitivity>& study,
                       const JsonOptions& options = {});
std::string map_json(const StudiedMachine& studied, const MapRequest& request, const MapRows& rows,
                     const JsonOptions& options = {});

/// Reports of studies in mm, mm/s, N/mm, ms, rpm; options.arguments stand behind the kind. Speed: each measure over
/// speed, up and down, with the critical speeds and their 95 % ranges, and the growth rate. Phase: portraits, the
/// motion over time and the block in motion, beside the record where the machine comes from one; of many speeds eight
/// are drawn, all are listed. Response: A(omega) and the spectra. Sensitivity: each measure over each number of the
/// machine, and the elasticities by size. Map: each measure in colours; of many cells the largest of each block is
/// drawn; a terminal shows one measure.
Report report_of(const StudiedMachine& studied, const SpeedStudy& study, const ReportOptions& options = {});
Report report_of(const StudiedMachine& studied, const std::vector<Portrait>& study, const ReportOptions& options = {});
Report report_of(const StudiedMachine& studied, const Response& study, const ReportOptions& options = {});
Report report_of(const StudiedMachine& studied, const std::vector<Sensitivity>& study,
                 const ReportOptions& options = {});
Report report_of(const StudiedMachine& studied, const MapRequest& request, const MapRows& rows,
                 const MeasureInfo& measure, const ReportOptions& options = {});

/// Tables of a study in a folder, made where it is not there: speed.csv; phase_1.csv ... with the start and cycle_1.csv
/// ... with one settled cycle; response.csv and harmonics.csv; sensitivity.csv and elasticities.csv. All or none.
void write_study(const std::string& folder, const SpeedStudy& study);
void write_study(const std::string& folder, const std::vector<Portrait>& study);
void write_study(const std::string& folder, const Response& study);
void write_study(const std::string& folder, const std::vector<Sensitivity>& study);

}  // namespace tribofit
