#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "../folder.hpp"

/// Runs the real command in a folder of its own, as a user would from a shell.

struct Outcome {
  int status = -1;  ///< exit status; 128 + signal when it crashed
  std::string out, err;
};

using tribofit::contents;

class Workshop : public tribofit::Folder {
 public:
  /// A shell line; `identify` in it is the command under test.
  Outcome shell(const std::string& line) const {
    const std::filesystem::path out = logs_ / "out", err = logs_ / "err";
    const std::string setup = "identify() { '" TRIBOFIT_IDENTIFY "' \"$@\"; }\ncd '" + path() + "'\n";
    std::ofstream(logs_ / "sh") << setup << line << "\n";
    const int raw = std::system(
        ("sh '" + (logs_ / "sh").string() + "' >'" + out.string() + "' 2>'" + err.string() + "' </dev/null").c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw), contents(out), contents(err)};
  }
  Outcome identify(const std::string& arguments) const { return shell("identify " + arguments); }

 private:
  Folder logs_;  ///< beside it, so that it holds nothing but what the command wrote
};

inline nlohmann::json json_in(const std::filesystem::path& path) {
  return nlohmann::json::parse(contents(path));
}

/// The parameter of that name of a fit or an effect; null where there is none.
inline nlohmann::json parameter(const nlohmann::json& fit, const std::string& name) {
  for (const auto& one : fit.at("parameters")) {
    if (one.at("name") == name) return one;
  }
  return nullptr;
}

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
