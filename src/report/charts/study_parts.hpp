#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

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

/// Table of the measures of motions, a row each; first: what stands before.
ReportTable measures_table(std::string caption, std::vector<std::string> header,
                           const std::vector<std::vector<std::string>>& first,
                           const std::vector<const Settled*>& settled);

/// "frequency [Hz]" as an axis.
ChartAxis axis_of(const MeasureInfo& measure);

/// Three cycles of the record that the machine was identified from; empty where there are none.
BlockMotion measured_motion(const StudiedMachine& of);

/// `values` in a unit.
std::vector<double> in_unit(std::span<const double> values, double unit);

/// Motions in the plane of displacement and velocity, or over time, keep these samples: the extremes of each channel in
/// each of about `bins` stretches, three quarters of which lie in the slips, where things happen fast.
std::vector<std::size_t> kept_samples(std::initializer_list<std::span<const double>> channels,
                                      std::span<const std::uint8_t> sticks, std::size_t bins);
std::vector<double> picked(std::span<const double> values, std::span<const std::size_t> samples, double unit);

/// A block that is drawn in motion.
Animation::Block animated(const std::string& name, std::span<const double> time, std::span<const double> displacement,
                          std::span<const double> friction, std::span<const std::uint8_t> sticks);

}  // namespace tribofit
