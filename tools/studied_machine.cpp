#include "studied_machine.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "options.hpp"
#include "tribofit/ingest/input_error.hpp"

using namespace tribofit;

namespace {

StudiedMachine given(const Settings& settings, MachineRequest typed) {
  if (!settings.radius.empty()) typed.radius = settings.radius;
  typed.speed = settings.speed;
  typed.load = settings.load;
  StudiedMachine out;
  out.machine = machine_from(typed).machine;
  out.source = "given values";
  return out;
}

}  // namespace

StudiedMachine studied_machine(const Settings& settings, const MachineRequest& typed) {
  if (settings.traces.empty()) return given(settings, typed);
  throw InputError("a machine cannot be identified from a trace yet", "give its numbers");
}

std::vector<std::string> shared_arguments(const CLI::App& kind) {
  static constexpr std::array<std::string_view, 11> kOwn = {"--range",     "--at",      "--points", "--cycles",
                                                            "--harmonics", "--vary",    "--factor", "--x",
                                                            "--y",         "--measure", "--threads"};
  std::vector<std::string> out;
  const std::vector<std::string> all = own_options(kind);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::find(kOwn.begin(), kOwn.end(), all[i]) != kOwn.end()) {
      ++i;  // and its value
    } else {
      out.push_back(all[i]);
    }
  }
  return out;
}
