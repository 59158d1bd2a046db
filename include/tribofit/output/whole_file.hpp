#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace tribofit {

/// A file or folder cannot be written. what() reads "FILE: REASON; ADVICE".
class WriteError : public std::runtime_error {
 public:
  WriteError(const std::string& file, const std::string& reason, const std::string& advice);
};

/// A file that appears whole or not at all: written beside its final name, then renamed onto it.
///
/// What is not a regular file (a terminal, a pipe, /dev/stdout) is written directly.
/// Every function throws WriteError.
class WholeFile {
 public:
  explicit WholeFile(std::string path);
  /// Removes what was written unless commit() succeeded.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(std::string_view text);
  /// Everything is on the disc when this returns, still under the temporary name.
  void finish();
  /// Gives the file its name (finishing it first).
  void commit();

 private:
  [[noreturn]] void fail(int error);
  void open_temporary(unsigned rights);
  void flush();

  std::string path_, target_, temporary_;
  std::string buffer_;
  int descriptor_ = -1;
};

/// Removes what every WholeFile has written so far under a temporary name; for a handler of a signal that ends the
/// program (it is async-signal-safe), after which no WholeFile may be used.
void remove_unfinished_files() noexcept;

/// The same at the end of the process: a thread that begins or commits a file from now on waits for that end. For a
/// handler of a signal.
void end_writing() noexcept;

/// Removes what programs that were killed left under temporary names in a folder; files that somebody still writes
/// stay, wherever that program runs.
void remove_abandoned_files(const std::string& folder);

/// Writes `content` to `path`, whole or not at all (see WholeFile).
void write_whole(const std::string& path, std::string_view content);

}  // namespace tribofit
