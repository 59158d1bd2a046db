#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tribofit/output/whole_file.hpp"

namespace tribofit {

/// Files of one folder that appear together: all are on the disc before the first gets its name.
class WholeFolder {
 public:
  explicit WholeFolder(std::string path) : path_(std::move(path)) {
    made_ = ::mkdir(path_.c_str(), 0777) == 0;
    if (!made_ && errno != EEXIST) fail(std::strerror(errno));
    struct stat status {};
    if (::stat(path_.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) fail("it is a file, not a folder");
  }
  /// Leaves no folder behind that was made for nothing.
  ~WholeFolder() {
    files_.clear();
    if (made_) ::rmdir(path_.c_str());  // does nothing once files have their names
  }
  WholeFolder(const WholeFolder&) = delete;
  WholeFolder& operator=(const WholeFolder&) = delete;

  WholeFile& add(const std::string& name) {
    return *files_.emplace_back(std::make_unique<WholeFile>(path_ + "/" + name));
  }
  /// Everything is on the disc when this returns, under temporary names.
  void finish() {
    for (const auto& file : files_) file->finish();
  }
  void commit() {
    finish();
    for (const auto& file : files_) file->commit();
  }

 private:
  [[noreturn]] void fail(const std::string& reason) {
    throw WriteError(path_, "the folder cannot be written: " + reason, "name a folder you may write to");
  }

  std::string path_;
  bool made_ = false;
  std::vector<std::unique_ptr<WholeFile>> files_;
};

}  // namespace tribofit
