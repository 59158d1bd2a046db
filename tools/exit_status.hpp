#pragma once

#include <stdexcept>
#include <string>

/// How `identify` ends; the help states the same.
enum class ExitStatus {
  done = 0,
  failed = 1,       ///< the data were read but the analysis could not be done, or one of several traces failed
  wrong_usage = 2,  ///< the command line cannot be meant
  bad_input = 3,    ///< a file cannot be read or is invalid
};

/// The worse of two.
inline ExitStatus worse(ExitStatus a, ExitStatus b) {
  return a < b ? b : a;
}

/// The command line cannot be meant: what is wrong, in one sentence.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};
