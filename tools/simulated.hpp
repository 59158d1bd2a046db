#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "machine_options.hpp"
#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/oscillator/drive.hpp"
#include "tribofit/oscillator/sensors.hpp"
#include "tribofit/oscillator/simulate.hpp"
#include "tribofit/output/whole_file.hpp"

namespace tribofit {

/// What is asked of a simulated record.
struct SimulateRequest {
  std::string out;
  bool quiet = false;
  SimulationOptions options;  ///< without the time to settle
  Sensors sensors;
  std::string speed_steps;  ///< of the disc or of a load point

  // Of a disc alone.
  MachineRequest machine;
  std::optional<double> run_up, reversing;  ///< [s], [Hz]
  std::vector<std::string> pauses;
  std::string load_swing, temperature;

  // Of velocity steps and holds alone.
  std::string kind;
  std::map<std::string, double> rate_state;  ///< by name, SI
  StateEvolution evolution = StateEvolution::ageing;
  std::optional<double> reference_speed;  ///< [m/s]
  double drift = 0;                       ///< [1/s]
};

void add_steps_options(const Command& verb, SimulateRequest& request);

/// Writes the record of velocity steps or holds and the truth beside it.
void simulate_steps(const SimulateRequest& request, const std::string& truth_path);

/// How the disc turns, what loads the block and how warm it is. Throws InputError that says how to write it.
Drive drive_from(const SimulateRequest& request, const Machine& machine);

/// Refuses more samples than are simulated, and a record of less than two.
void check_samples(const SimulationOptions& options, double most);

/// Writes both files whole, or neither. work: called once they can be written; writes the record and gives
/// the truth.
void write_record(const std::string& path, const std::string& truth_path,
                  const std::function<std::string(WholeFile& record)>& work);

}  // namespace tribofit
