#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "tribofit/friction/laws/all.hpp"
#include "tribofit/oscillator/machine.hpp"

/// A machine as typed, in SI; what is not typed comes from the published test of the nearest radius.
struct MachineRequest {
  double radius = 0.015;
  std::string speed;  ///< of the disc, or at the radius
  std::optional<double> load, mass, stiffness, damping, damping_ratio;
  tribofit::Law law = tribofit::law_catalogue().front();
  bool law_is_typed = false;
  std::map<std::string, double> law_parameters;  ///< by name
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
