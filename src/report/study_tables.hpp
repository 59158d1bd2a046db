#pragma once

#include <string>
#include <vector>

#include "tribofit/report/study.hpp"

namespace tribofit {

/// The tables of studies, for a terminal and a page alike.

/// The measures of the machine at its own speed, with their 95 % ranges.
ReportTable own_table(const StudiedMachine& of, const SpeedStudy& study);

/// The measures over speed at `most` speeds, evenly; a second row where a motion that begins in sliding differs.
ReportTable speed_table(const SpeedStudy& study, std::size_t most);

ReportTable portraits_table(const std::vector<Portrait>& study);
ReportTable harmonics_table(const Response& study);
ReportTable elasticity_table(const std::vector<Sensitivity>& study);

/// "frequency, stick time and so on": a column a measure.
void add_measure_columns(ReportTable& table);

}  // namespace tribofit
