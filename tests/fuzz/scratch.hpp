#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "tribofit/ingest/input_error.hpp"

namespace tribofit::fuzz {

inline void require(bool condition) {
  if (!condition) std::abort();
}

/// A folder of this process, gone at its end.
class Scratch {
 public:
  explicit Scratch(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("tribofit-fuzz-" + name + "-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string path() const { return path_.string(); }
  std::string write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

/// Whether something was read; an InputError must say what is wrong and what to do.
template <class Read>
bool is_read(Read&& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    require(!error.problem().empty() && !error.advice().empty());
    return false;
  }
}

}  // namespace tribofit::fuzz
