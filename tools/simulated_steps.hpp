#pragma once

#include <functional>
#include <string>

#include "command.hpp"
#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/output/whole_file.hpp"

namespace tribofit {

/// What is asked of every simulated record; texts as typed.
struct RecordRequest {
  std::string duration = "20s", rate = "20kHz", noise_mu = "0", noise_colour = "0", speed_steps, out;
  std::string seed_text = "1";
  bool quiet = false;
};

/// What is asked of a record of velocity steps or holds alone.
struct StepsRequest {
  std::string kind, values, drift = "0/s", reference_speed;
  StateEvolution evolution = StateEvolution::ageing;
};

void add_steps_options(const Command& verb, StepsRequest& request);

/// Writes the record and the truth beside it.
void simulate_steps(const RecordRequest& record, const StepsRequest& request, const std::string& truth_path);

/// Writes both files whole, or neither. work: called once they can be written; writes the record and gives
/// the truth.
void write_record(const std::string& path, const std::string& truth_path,
                  const std::function<std::string(WholeFile& record)>& work);

}  // namespace tribofit
