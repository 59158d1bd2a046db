#pragma once

#include <string>

#include "tribofit/report/report.hpp"

namespace tribofit {

/// Whether this build holds the page: it is left out where npm was not found when the build was configured.
bool has_report_page();

/// A report as one HTML file that opens in any browser without a network: charts to zoom and save, tables, what was
/// run.
///
/// Less than 4 MB for any trace or diagnosis: what is drawn is reduced to the extremes of each stretch, so that no peak
/// is lost. Nothing in the file is executed but its own scripts (Content-Security-Policy), whatever names the input
/// has. Throws InputError where has_report_page() is false.
std::string report_page(const Report& report);

}  // namespace tribofit
