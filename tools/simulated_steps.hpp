#pragma once

#include <cstdint>
#include <string>

#include "command.hpp"

namespace tribofit {

/// A record of velocity steps or holds as asked of `identify simulate`; texts as typed.
struct StepsRequest {
  std::string kind, values, evolution, drift = "0/s", reference_speed;
  std::string speeds, duration, rate, noise, noise_colour, out;  ///< of the options of every simulation
  std::uint64_t seed = 1;
  bool quiet = false;
};

void add_steps_options(const Command& verb, StepsRequest& request);

/// Writes the record and the truth beside it.
void simulate_steps(const StepsRequest& request, const std::string& truth_path);

}  // namespace tribofit
