#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tribofit {

/// Where in the input something is wrong. Empty or zero means "does not apply".
struct InputLocation {
  std::string file;
  std::size_t line = 0;   ///< 1-based line of the file
  std::string column;     ///< name of the column as the file gives it
  std::size_t value = 0;  ///< 1-based value of the column, where the file has no lines
};

/// The one exception of the library: the input cannot be used.
///
/// what() reads "FILE:LINE: column NAME: PROBLEM; ADVICE", or "FILE: column NAME, value 12: ..." without lines. A fit
/// that fails is not an exception but a result with a reason (see fit/fit.hpp).
class InputError : public std::runtime_error {
 public:
  /// problem: what is wrong, as a sentence without a full stop; advice: what the user can do.
  InputError(std::string problem, std::string advice, InputLocation where = {});

  const std::string& problem() const noexcept { return problem_; }
  const std::string& advice() const noexcept { return advice_; }
  const InputLocation& where() const noexcept { return where_; }

 private:
  std::string problem_, advice_;
  InputLocation where_;
};

/// What may be stated beside a trace, as a message asks for it: "radius 15mm", "columns time=NAME". The keys are
/// columns, kind, load, radius, rate, speed and units (ReadOptions).
std::string setting(std::string_view key, std::string_view value = {});

/// Sets how people state what has this key ("--radius"), for all messages: once, before anything is read. Empty: by the
/// key itself.
void name_settings(std::string (*name)(std::string_view key));

}  // namespace tribofit
