#include "input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/text_of_file.hpp"

namespace tribofit {

namespace {

std::atomic<std::size_t> opened = 0;

/// Opens a file; a pipe without a writer is not waited for.
std::shared_ptr<const int> open_to_read(const std::string& path) {
  const int number = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  return {new int(number), [](const int* opened_file) {
            if (*opened_file >= 0) ::close(*opened_file);
            delete opened_file;
          }};
}

}  // namespace

InputFile::InputFile(const std::string& path, const std::string& advice)
    : path_(path), descriptor_(open_to_read(path)) {
  struct stat status {};
  if (*descriptor_ < 0 || ::fstat(*descriptor_, &status) != 0) {
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
  size_ = static_cast<std::uint64_t>(status.st_size);
  ++opened;
}

InputFile InputFile::with_line_end(char byte) const {
  InputFile same = *this;
  same.line_end_ = byte;
  return same;
}

std::size_t files_opened() noexcept {
  return opened;
}

std::string text_of_file(const std::string& path, std::uint64_t most, const std::string& advice) {
  const InputFile file(path, advice);
  if (file.size() > most) {
    throw InputError("has " + std::to_string(file.size()) + " bytes, where up to " + std::to_string(most) + " are read",
                     advice, {path, 0, ""});
  }
  return file.read_text(0, file.size());
}

std::string InputFile::read_text(std::uint64_t offset, std::uint64_t most) const {
  std::string text(static_cast<std::size_t>(std::min(most, size_ - std::min(offset, size_))), '\0');
  text.resize(read(offset, text));
  return text;
}

std::size_t InputFile::read(std::uint64_t offset, std::span<char> buffer) const {
  std::size_t done = 0;
  while (done < buffer.size()) {
    const ssize_t count =
        ::pread(*descriptor_, buffer.data() + done, buffer.size() - done, static_cast<off_t>(offset + done));
    if (count == 0) break;
    if (count < 0) {
      if (errno == EINTR) continue;
      throw InputError(std::string("cannot be read: ") + std::strerror(errno), "copy the file again from its source",
                       {path_, 0, ""});
    }
    done += static_cast<std::size_t>(count);
  }
  if (line_end_ != '\n') std::replace(buffer.begin(), buffer.begin() + std::ptrdiff_t(done), line_end_, '\n');
  return done;
}

}  // namespace tribofit
