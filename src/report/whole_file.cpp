#include "tribofit/report/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kBufferSize = 1 << 18;

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
    case ENOENT:
      return "make the folder first";
    case EISDIR:
      return "name a file, not a folder";
    default:
      return "name another place";
  }
}

}  // namespace

WholeFile::WholeFile(std::string path) : path_(std::move(path)), target_(path_) {
  if (path_.empty()) throw InputError("the name of an output file is empty", "name a file");
  struct stat status {};
  const bool exists = ::stat(path_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  if (exists && ::access(path_.c_str(), W_OK) != 0) fail(errno);
  std::error_code ignored;  // a link that leads nowhere is replaced
  if (exists) target_ = std::filesystem::canonical(path_, ignored).string();
  if (target_.empty()) target_ = path_;
  const std::filesystem::path final_path(target_);
  const std::string hidden = "." + final_path.filename().string() + "." + std::to_string(::getpid()) + ".part";
  temporary_ = (final_path.parent_path() / hidden).string();
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC,
                       exists ? status.st_mode & 07777U : 0666U);
  if (descriptor_ < 0) {
    const int error = errno;
    temporary_.clear();
    fail(error);
  }
}

WholeFile::~WholeFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void WholeFile::fail(int error) {
  throw InputError(std::string("cannot be written: ") + std::strerror(error), advice_for(error), {path_, 0, ""});
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
  if (!temporary_.empty() && ::fsync(descriptor_) != 0) fail(errno);
  const int status = ::close(descriptor_);
  const int error = errno;
  descriptor_ = -1;
  if (status != 0) fail(error);
}

void WholeFile::commit() {
  finish();
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  temporary_.clear();
}

void write_whole(const std::string& path, std::string_view content) {
  WholeFile file(path);
  file.write(content);
  file.commit();
}

}  // namespace tribofit
