#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

/// Writes to standard output. A closed pipe is not an error; a full
/// disc throws tribofit::InputError.
void print(const std::string& text);

/// Whether colours are wanted: standard output is a terminal that can, and NO_COLOR is not set.
bool wants_colour();

/// Whether signs beyond ASCII (bars, plus-minus) can be shown: the locale's encoding is UTF-8 and the terminal not
/// dumb.
bool wants_unicode();

/// Columns to write: COLUMNS where it is set, else those of the terminal, else 80.
std::size_t terminal_width();

/// "45 s left", "3 min left", "1.5 h left".
std::string time_left(double seconds);

/// One line to standard error, only where a person watches.
void progress(const std::string& text);

/// One line on standard error that is rewritten as work goes on, only where a person watches; gone when it is done.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  /// What is being done and the part done, 0 to 1: a bar, and the time left from a second on.
  void show(std::string_view what, double part);
  /// Takes the line away; the destructor does, too.
  void end();

 private:
  bool watched_, shown_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now(), next_{};
};

/// Letters of a text in UTF-8.
std::size_t letters_in(std::string_view text);

/// Columns of prose: those of the terminal, but 80 to 120.
std::size_t prose_width();

/// A sentence broken to that width; lines after the first have `indent` blanks.
std::string folded(const std::string& sentence, std::size_t indent = 0);

/// "identify: error: TEXT" to standard error.
void print_error(const std::string& text);
