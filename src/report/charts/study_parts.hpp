#pragma once

#include <span>
#include <string>
#include <vector>

#include "styles.hpp"
#include "tribofit/report/study.hpp"
#include "tribofit/study/block_motion.hpp"

namespace tribofit {

/// The parts that the reports of all studies have in common.

/// Title, facts and warnings. kind: "speed", "phase", ...; lead: what a reader must know.
Report study_report(const StudiedMachine& of, const std::string& kind, const std::string& title, std::string lead,
                    const ReportOptions& options);

/// Every number of the machine with its standard error, and how to run the study again: ends a report.
void add_machine_sections(const StudiedMachine& of, const std::string& kind, const ReportOptions& options,
                          Report& report);

/// "frequency [Hz]" as an axis.
ChartAxis axis_of(const MeasureInfo& measure);

/// Three cycles of the record that the machine was identified from; empty where there are none.
BlockMotion measured_motion(const StudiedMachine& of);

/// `values` in a unit.
std::vector<double> in_unit(std::span<const double> values, double unit);

}  // namespace tribofit
