#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "cli/command.hpp"
#include "tribofit/workbench/session.hpp"

namespace workbench_test {

inline const std::string kClearLag =
    "--rate 10kHz --effect frictional-lag:tau=4ms --noise-mu 0.003 --noise-v 0.02mm/s --seed 7";
/// Not distinguishable from a filter or a delay of the reading.
inline const std::string kDoubtfulLag =
    "--rate 2kHz --effect frictional-lag:tau=0.4ms --noise-mu 0.006 --noise-v 0.1mm/s --scatter 0.004";

/// A trace in which friction follows v_r late, made by the command under test; the recorded example where a program has
/// no command (tests/sanitized).
struct Lagging {
  Workshop workshop;
  std::string path;

  explicit Lagging(const std::string& duration = "8s", const std::string& lag = kClearLag)
      : path((workshop / "lag.csv").string()) {
    if (std::string_view(TRIBOFIT_IDENTIFY).empty()) {
      std::filesystem::copy_file(TRIBOFIT_SOURCE_DIR "/data/example.csv", path);
      return;
    }
    workshop.identify("simulate --radius 15mm --speed 4rpm --duration " + duration + " --out lag.csv " + lag);
  }

  tribofit::WorkbenchOptions options() const {
    tribofit::WorkbenchOptions out;
    out.input.path = path;
    out.input.read.conditions.radius = {0.015, "command line"};
    out.arguments = {"--radius", "15mm"};
    return out;
  }
};

/// One for all tests of a program: it takes a moment.
inline const Lagging& lagging() {
  static const Lagging made;
  return made;
}

}  // namespace workbench_test
