#include "tribofit/output/whole_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <random>
#include <system_error>
#include <thread>
#include <utility>

#include "tribofit/output/text.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kBufferSize = 1 << 18;

/// A temporary name in use, for the handler of a signal, which touches nothing but this memory: no lock and no memory
/// may be taken there, and that of a string may just be given back by another thread.
struct UnfinishedFile {
  enum State : int { free, changing, taken };
  std::atomic<int> state{free};
  std::array<char, 1024> name;
};
static_assert(std::atomic<int>::is_always_lock_free);

/// More files at a time than there are places, or with longer names, are written all the same, only not removed by an
/// interruption.
std::array<UnfinishedFile, 256> unfinished_files;

void enlist(const std::string& name) {
  if (name.size() >= unfinished_files.front().name.size()) return;
  for (UnfinishedFile& place : unfinished_files) {
    int expected = UnfinishedFile::free;
    if (!place.state.compare_exchange_strong(expected, UnfinishedFile::changing)) continue;
    std::memcpy(place.name.data(), name.c_str(), name.size() + 1);
    place.state.store(UnfinishedFile::taken);
    return;
  }
}

std::atomic<int> names_changing{0};
std::atomic<bool> writing_ended{false};

/// While a file gets a name: no signal interrupts that, and where writing has ended it gets none.
class NameChange {
 public:
  NameChange() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
    ++names_changing;
    if (!writing_ended) return;
    --names_changing;
    for (;;) ::pause();  // the process ends
  }
  ~NameChange() {
    --names_changing;
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NameChange(const NameChange&) = delete;
  NameChange& operator=(const NameChange&) = delete;

 private:
  sigset_t before_;
};

void strike_off(const std::string& name) {
  for (UnfinishedFile& place : unfinished_files) {
    if (place.state.load() == UnfinishedFile::taken && name == place.name.data())
      return place.state.store(UnfinishedFile::free);
  }
}

constexpr std::string_view kTemporaryEnd = ".part";

/// This machine, in letters and digits.
const std::string& own_host() {
  static const std::string host = [] {
    std::array<char, 256> name{};
    if (::gethostname(name.data(), name.size() - 1) != 0) return std::string("host");
    std::string text(name.data());
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return text.empty() ? "host" : text;
  }();
  return host;
}

/// A name beside the final one that no other process uses, on this machine or another: with host, process and a number.
std::string temporary_name(const std::string& target) {
  const std::filesystem::path path(target);
  const std::string unique =
      own_host() + "-" + std::to_string(::getpid()) + "-" + std::to_string(std::random_device{}());
  const std::string end = "." + unique + std::string(kTemporaryEnd);
  constexpr std::size_t kLongest = 255;  // bytes of a name, in every usual file system
  const std::string begin = "." + path.filename().string().substr(0, kLongest - 1 - std::min(end.size(), kLongest - 1));
  return (path.parent_path() / (begin + end)).string();
}

/// Whether a temporary file is of this machine, by its name: a lock says nothing of one that another host writes.
bool is_of_this_host(std::string_view name) {
  name.remove_suffix(kTemporaryEnd.size());
  name.remove_prefix(std::min(name.rfind('.') + 1, name.size()));
  for (int k = 0; k < 2 && !name.empty(); ++k) {  // the number and the process
    const std::size_t dash = name.rfind('-');
    name = dash == std::string_view::npos ? "" : name.substr(0, dash);
  }
  return name.empty() || name == own_host();  // an earlier version wrote no host
}

std::string advice_for(int error) {
  switch (error) {
    case ENOSPC:
    case EFBIG:
    case EDQUOT:
      return "free some space or name another disc; nothing was left behind";
    case EACCES:
    case EPERM:
    case EROFS:
      return "name a place you may write to";
    case ENXIO:
      return "name a file, or begin to read the pipe first";
    case ENOENT:
      return "make the folder first";
    case EISDIR:
      return "name a file, not a folder";
    default:
      return "name another place";
  }
}

/// A device, or a pipe: whoever reads that is waited for, but not for ever. Negative, with errno, where it cannot be.
int open_special(const std::string& path) {
  constexpr std::chrono::milliseconds kPatience(5000), kPause(20);
  const auto end = std::chrono::steady_clock::now() + kPatience;
  int descriptor = -1;
  while ((descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK)) < 0) {
    if (errno != ENXIO || std::chrono::steady_clock::now() > end) return -1;
    std::this_thread::sleep_for(kPause);
  }
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return descriptor;
}

}  // namespace

WriteError::WriteError(const std::string& file, const std::string& reason, const std::string& advice)
    : std::runtime_error(printable((file.empty() ? "" : file + ": ") + reason + "; " + advice)) {}

WholeFile::WholeFile(std::string path) : path_(std::move(path)), target_(path_) {
  if (path_.empty()) throw WriteError("", "the name of an output file is empty", "name a file");
  struct stat status {};
  const bool exists = ::stat(path_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = open_special(path_);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  if (exists && ::access(path_.c_str(), W_OK) != 0) fail(errno);
  std::error_code ignored;  // a link that leads nowhere is replaced
  if (exists) target_ = std::filesystem::canonical(path_, ignored).string();
  if (target_.empty()) target_ = path_;
  const NameChange change;
  open_temporary(exists ? status.st_mode & 07777U : 0666U);
  enlist(temporary_);
}

void WholeFile::open_temporary(unsigned rights) {
  for (;;) {
    temporary_ = temporary_name(target_);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, rights);
    if (descriptor_ < 0) {
      if (errno == EEXIST) continue;
      const int error = errno;
      temporary_.clear();
      fail(error);
    }
    // The lock, which dies with its process, says that somebody still writes here (see remove_abandoned_files). Where
    // locks do not work nothing is taken for abandoned either.
    const bool swept = ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    struct stat status {};
    if (!swept && (::fstat(descriptor_, &status) != 0 || status.st_nlink > 0)) return;
    ::close(descriptor_);  // taken for abandoned between the two calls
    ::unlink(temporary_.c_str());
  }
}

WholeFile::~WholeFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (temporary_.empty()) return;
  ::unlink(temporary_.c_str());
  strike_off(temporary_);
}

void WholeFile::fail(int error) {
  throw WriteError(path_, std::string("cannot be written: ") + std::strerror(error), advice_for(error));
}

void WholeFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBufferSize) flush();
}

void WholeFile::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t count = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(errno);
    done += static_cast<std::size_t>(count);
  }
  buffer_.clear();
}

void WholeFile::finish() {
  if (descriptor_ < 0) return;
  flush();
  // A full disc may show only now. A pipe or a terminal has nothing to synchronise.
  if (!temporary_.empty()) {  // stays open, and so locked, until it has its name
    if (::fsync(descriptor_) != 0) fail(errno);
    return;
  }
  const int status = ::close(descriptor_);
  const int error = errno;
  descriptor_ = -1;
  if (status != 0) fail(error);
}

void WholeFile::commit() {
  finish();
  if (temporary_.empty()) return;
  const NameChange change;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  strike_off(temporary_);
  temporary_.clear();
  ::close(std::exchange(descriptor_, -1));
}

void remove_unfinished_files() noexcept {
  for (const UnfinishedFile& place : unfinished_files) {
    if (place.state.load() == UnfinishedFile::taken) ::unlink(place.name.data());
  }
}

void end_writing() noexcept {
  writing_ended = true;
  constexpr timespec kPause = {0, 1000000};
  constexpr int kMostPauses = 1000;  // on a disc that does not answer
  for (int k = 0; k < kMostPauses && names_changing > 0; ++k) ::nanosleep(&kPause, nullptr);
  remove_unfinished_files();
}

void remove_abandoned_files(const std::string& folder) {
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (!name.starts_with('.') || !name.ends_with(kTemporaryEnd) || !is_of_this_host(name)) continue;
    const int descriptor = ::open(it->path().c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(it->path().c_str());
    ::close(descriptor);
  }
}

void write_whole(const std::string& path, std::string_view content) {
  WholeFile file(path);
  file.write(content);
  file.commit();
}

}  // namespace tribofit
