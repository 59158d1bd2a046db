#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace tribofit {

/// A file opened for reading at any offset, by any number of threads. Copies share the one opening.
class InputFile {
 public:
  /// Throws InputError for a missing or unreadable file and for anything but a regular one (a folder, a pipe).
  /// `advice`: what to name instead, where the file is no trace.
  explicit InputFile(const std::string& path, const std::string& advice = "");

  /// The same file with a byte that is read as a line feed (a CR, in files of lines that end in CR alone).
  InputFile with_line_end(char byte) const;

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// Fills `buffer` from `offset`; fewer bytes than asked for only at the end of the file.
  std::size_t read(std::uint64_t offset, std::span<char> buffer) const;
  /// Up to `most` bytes from `offset`; fewer only at the end of the file.
  std::string read_text(std::uint64_t offset, std::uint64_t most) const;

 private:
  std::string path_;
  std::shared_ptr<const int> descriptor_;
  std::uint64_t size_ = 0;
  char line_end_ = '\n';
};

/// Memory of this process [bytes], that which is not in use among it; 0 where nothing says how much.
std::uint64_t used_memory();

/// Throws InputError where so many rows of so many columns would take more memory than there is: the system would swap,
/// or end the process, before they are read.
void refuse_beyond_memory(double rows, std::size_t columns, const std::string& path);

}  // namespace tribofit
