#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "tribofit/report/report.hpp"

namespace tribofit {

/// `identify` with these words and inputs, as a shell reads them.
std::string command_line(const std::vector<std::string>& words, const std::vector<std::string>& inputs);

/// `verb` and the user's own options but for those `dropped`: flags, and "--protocol=" with its value.
std::vector<std::string> words_of(std::vector<std::string> verb, const std::vector<std::string>& arguments,
                                  const std::vector<std::string>& dropped = {});

/// Adds the page and the workbench for the same trace to what can be done next, as far as they are not made yet. verb:
/// "diagnose", or empty for identify itself.
void add_ways_to_look(const std::string& verb, const std::string& path, const ReportOptions& options, Report& report);

/// What to do next where that is the case.
struct NextStep {
  bool is_next;
  std::string reason, command;
};
/// The first that is.
Suggestion first_of(std::initializer_list<NextStep> steps);

/// `words` with `more` behind them.
std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more);

bool has_option(const std::vector<std::string>& arguments, const std::string& name);

/// "NAME-csv" in the folder where one works: where the CSV files of a trace may go.
std::string csv_folder_for(const std::string& path);

/// A command on lines no longer than `width`, as a shell reads them: indented, and broken between words with a
/// backslash.
std::string folded_command(const std::string& command, std::size_t width);

}  // namespace tribofit
