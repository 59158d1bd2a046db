#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tribofit/report/report.hpp"

namespace tribofit {

/// `identify` with these words and inputs, as a shell reads them.
std::string command_line(const std::vector<std::string>& words, const std::vector<std::string>& inputs);

/// `identify` with the user's own options, `more` behind them, and the trace. options.arguments begins with the verb
/// where there is one.
std::string command_line(const ReportOptions& options, const std::vector<std::string>& more, const std::string& path);

/// `verb` and the user's own options; those named in `flags` are left out, and those in `valued` with their values.
std::vector<std::string> words_of(std::vector<std::string> verb, const std::vector<std::string>& arguments,
                                  const std::vector<std::string>& flags = {},
                                  const std::vector<std::string>& valued = {});

/// The page and the workbench for the same trace: `arguments` without verb and outputs as that command takes them.
/// report: the file of the page; empty: it is written already. verb: "diagnose", or empty for identify itself.
std::vector<Suggestion> ways_to_look(const std::string& verb, const std::vector<std::string>& arguments,
                                     const std::string& path, bool report_written);

/// `words` with `more` behind them.
std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more);

bool has_option(const std::vector<std::string>& arguments, const std::string& name);

/// "NAME-csv" in the folder where one works: where the CSV files of a trace may go.
std::string csv_folder_for(const std::string& path);

/// A command on lines no longer than `width`, as a shell reads them: indented, and broken between words with a
/// backslash.
std::string folded_command(const std::string& command, std::size_t width);

}  // namespace tribofit
