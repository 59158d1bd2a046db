#include "input_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>

#include "limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/text_of_file.hpp"
#include "tribofit/output/digits.hpp"

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

/// The number that a file of the system holds, behind this word where it says several things; "max" is none.
std::optional<double> number_in(const char* path, const std::string& name = {}) {
  std::ifstream in(path);
  std::string word;
  while (word != name && in >> word) continue;
  double value = 0;
  return in >> value ? std::optional(value) : std::nullopt;
}

/// Memory that the system has left for this process [bytes]: what it can free without swapping, within the limits of
/// the process and its control group. Infinite where nothing says how much.
double available_memory() {
  double available = std::numeric_limits<double>::infinity();
  const auto limit = [&](double most, double used) { available = std::min(available, std::max(0.0, most - used)); };
  if (const auto kilobytes = number_in("/proc/meminfo", "MemAvailable:")) limit(1024 * *kilobytes, 0);
  if (const auto of_group = number_in("/sys/fs/cgroup/memory.max"))
    limit(*of_group, number_in("/sys/fs/cgroup/memory.current").value_or(0));
  rlimit space{};
  if (::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    limit(static_cast<double>(space.rlim_cur), static_cast<double>(used_memory()));
  return available;
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

std::uint64_t used_memory() {
  return static_cast<std::uint64_t>(1024 * number_in("/proc/self/status", "VmSize:").value_or(0));
}

void refuse_beyond_memory(double rows, std::size_t columns, const std::string& path) {
  const double bytes = kMemoryOverValues * rows * static_cast<double>(columns) * sizeof(double);
  if (bytes < static_cast<double>(kMemoryNotAsked)) return;
  const double available = available_memory();
  if (bytes <= available) return;
  throw InputError(fmt::format("holds about {} million rows: they take {} GB of memory, and {} GB are free",
                               general(1e-6 * rows, 2), general(1e-9 * bytes, 3), general(1e-9 * available, 3)),
                   "cut the file into parts, keep every other row, or use a machine with more memory", {path, 0, ""});
}

}  // namespace tribofit
