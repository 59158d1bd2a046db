#pragma once

#include <stdlib.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

/// Runs the real command in a folder of its own, as a user would from a shell.

struct Outcome {
  int status = -1;  ///< exit status; 128 + signal when it crashed
  std::string out, err;
};

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Workshop {
 public:
  Workshop() {
    std::string name = (std::filesystem::temp_directory_path() / "tribofit-cli-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Workshop() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
    std::filesystem::remove_all(logs(""), ignored);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  /// A shell line; `identify` in it is the command under test.
  Outcome shell(const std::string& line) const {
    const std::filesystem::path out = logs(".out"), err = logs(".err");
    const std::string setup = "identify() { '" TRIBOFIT_IDENTIFY "' \"$@\"; }\ncd '" + path_.string() + "'\n";
    std::ofstream(logs(".sh")) << setup << line << "\n";
    const int raw = std::system(
        ("sh '" + logs(".sh").string() + "' >'" + out.string() + "' 2>'" + err.string() + "' </dev/null").c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw), contents(out), contents(err)};
  }
  Outcome identify(const std::string& arguments) const { return shell("identify " + arguments); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  /// Beside the folder, so that the folder holds nothing but what the command wrote.
  std::filesystem::path logs(const std::string& suffix) const { return path_.string() + suffix; }

  std::filesystem::path path_;
};

/// A simulated trace of the published rig at 15 mm (14 cycles in 3 s at 5 kHz), made once.
inline const std::string& good_trace() {
  static const std::string text = [] {
    const Workshop shop;
    shop.identify(
        "simulate --radius 15mm --speed 4rpm --duration 3s --rate 5kHz --noise-mu 0.003 --noise-v 0.02mm/s "
        "--scatter 0.004 --out trace.csv --quiet");
    return contents(shop / "trace.csv");
  }();
  return text;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// The first command that a result offers after "Next", as a line for the shell; empty where there is none.
inline std::string next_command(const std::string& out) {
  std::istringstream in(out.substr(std::min(out.size(), out.find("\nNext"))));
  std::string command;
  for (std::string line; std::getline(in, line);) {
    if (command.empty() && line.rfind("  identify ", 0) != 0) continue;
    command += line + "\n";
    if (line.back() != '\\') break;
  }
  return command;
}
