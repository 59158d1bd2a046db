#pragma once

#include <map>
#include <string>
#include <vector>

#include "command.hpp"
#include "tribofit/oscillator/machine.hpp"

/// A machine as typed; empty means: from the published test of the nearest radius.
struct MachineRequest {
  std::string radius = "15mm", speed, load, law;      // law: the first of the list
  std::map<std::string, std::string> law_parameters;  // by name
  std::string mass, stiffness, damping, damping_ratio;
  std::vector<std::string> effects, formulas;
};

/// Options of the rig and of its friction.
void add_machine_options(const Command& verb, MachineRequest& request);
/// The same without radius, speed and load.
void add_machine_numbers(const Command& verb, MachineRequest& request);

/// The machine in SI, and the radius [m] of the published test that what was not typed comes from.
struct RequestedMachine {
  tribofit::Machine machine;
  double preset_radius = 0;
};
/// Throws tribofit::InputError, or UsageError for unknown names.
RequestedMachine machine_from(const MachineRequest& request);

/// An identified machine with the parameters of its law and the rig that were typed in place of its own.
tribofit::Machine with_typed(tribofit::Machine machine, const MachineRequest& request);

/// Whether a speed is typed with a unit of linear speed ("0.5mm/s").
bool is_linear_speed(const std::string& text);

/// A speed of the disc [rad/s] from a rotational speed or, at the friction radius [m], from omega r ("4rpm",
/// "0.5mm/s").
double disc_speed_from(const std::string& text, double radius, const std::string& option);
