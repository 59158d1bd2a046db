#include "input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/text_of_file.hpp"

namespace tribofit {

namespace {

/// A regular file, opened for reading; a pipe without a writer is not waited for.
class Descriptor {
 public:
  explicit Descriptor(const std::string& path) : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

}  // namespace

InputFile::InputFile(const std::string& path, char ends_lines, const std::string& advice)
    : path_(path), ends_lines_(ends_lines) {
  Descriptor file(path);
  struct stat status {};
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0) {
    throw InputError(std::string("cannot be opened: ") + std::strerror(errno),
                     "check the path and the permission to read", {path, 0, ""});
  }
  if (S_ISDIR(status.st_mode)) {
    throw InputError("is a folder" + std::string(advice.empty() ? ", not a trace" : ""),
                     advice.empty() ? "name one CSV file of it" : advice, {path, 0, ""});
  }
  if (!S_ISREG(status.st_mode)) {
    throw InputError("is not a regular file", advice.empty() ? "write the trace to a file first" : advice,
                     {path, 0, ""});
  }
  descriptor_ = file.release();
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string text_of_file(const std::string& path, std::uint64_t most, const std::string& advice) {
  const InputFile file(path, '\n', advice);
  if (file.size() > most) {
    throw InputError("has " + std::to_string(file.size()) + " bytes, where up to " + std::to_string(most) + " are read",
                     advice, {path, 0, ""});
  }
  std::string text(static_cast<std::size_t>(file.size()), '\0');
  text.resize(file.read(0, text));
  return text;
}

std::size_t InputFile::read(std::uint64_t offset, std::span<char> buffer) const {
  std::size_t done = 0;
  while (done < buffer.size()) {
    const ssize_t count =
        ::pread(descriptor_, buffer.data() + done, buffer.size() - done, static_cast<off_t>(offset + done));
    if (count == 0) break;
    if (count < 0) {
      if (errno == EINTR) continue;
      throw InputError(std::string("cannot be read: ") + std::strerror(errno), "copy the file again from its source",
                       {path_, 0, ""});
    }
    done += static_cast<std::size_t>(count);
  }
  if (ends_lines_ != '\n') std::replace(buffer.begin(), buffer.begin() + std::ptrdiff_t(done), ends_lines_, '\n');
  return done;
}

std::uint64_t InputFile::line_start(std::uint64_t offset, std::uint64_t end) const {
  if (offset == 0 || offset >= end) return std::min(offset, end);
  std::array<char, 4096> buffer;
  for (std::uint64_t at = offset - 1; at < end; at += buffer.size()) {
    const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(buffer.size(), end - at));
    const std::size_t count = read(at, std::span(buffer).first(wanted));
    if (const void* found = std::memchr(buffer.data(), '\n', count)) {
      return at + static_cast<std::uint64_t>(static_cast<const char*>(found) - buffer.data()) + 1;
    }
    if (at + count > offset + kLongestLine) refuse_long_line(0);
  }
  return end;
}

void InputFile::refuse_long_line(std::size_t line) const {
  throw InputError("a line is longer than 1 MB",
                   "a trace has one row of numbers per line; check that this is a CSV file", {path_, line, ""});
}

}  // namespace tribofit
