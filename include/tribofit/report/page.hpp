#pragma once

#include <string>
#include <vector>

namespace tribofit {

struct DiagnosedTraces;  // pipeline.hpp
struct Identification;

struct PageOptions {
  std::vector<std::string> arguments;  ///< the user's own options without traces and outputs, shown with the command
  std::vector<std::string> inputs;     ///< traces and folders as the user named them; empty: the path of the trace
  bool instruments_declared = false;   ///< an instruments file was given
};

/// Whether this build holds the page: it is left out where npm was not found when the build was configured.
bool has_report_page();

/// A result as one HTML file that opens in any browser without a network: charts to zoom and save, tables, what was
/// run. It shows three cycles of friction and velocity beside the laws, friction over v_r with both branches, the
/// parameters, relative errors ([D] Eq 5), measures of each cycle and the spectrum.
///
/// Less than 4 MB for any input: what is drawn is reduced to the extremes of each stretch, so that no peak is lost.
/// Nothing in the file is executed but its own scripts (Content-Security-Policy), whatever names the input has.
/// Throws InputError where has_report_page() is false. Cost: linear in samples, about that of write_csv_folder()
/// without the writing.
std::string report_page(const Identification& result, const PageOptions& options = {});

/// The same for a diagnosis, with the ladder of errors, where the law fails, what became of each effect, and the
/// samples beside the first and the final model. Of many traces the first eight are drawn, all are listed.
std::string report_page(const DiagnosedTraces& result, const PageOptions& options = {});

}  // namespace tribofit
