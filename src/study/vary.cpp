#include "tribofit/study/vary.hpp"
#include "tribofit/ingest/units.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"

namespace tribofit {

namespace {

/// A parameter of the model as studies call it: mu_s, alpha, viscous.sigma.
std::string called(const FrictionModel::Slot& slot) {
  return slot.effect.empty() ? slot.parameter.name : slot.effect + "." + slot.parameter.name;
}

template <class Known>
[[noreturn]] void refuse(std::string_view what, std::string_view name, const Known& known) {
  std::vector<std::string> names;
  std::string list;
  for (const auto& entry : known) {
    names.push_back(entry.name);
    list += (list.empty() ? "" : ", ") + entry.name;
  }
  const std::string near = likely_name(name, names);
  throw InputError("there is no " + std::string(what) + " '" + std::string(name) + "'",
                   (near.empty() ? "" : "did you mean '" + near + "'? ") + ("there are: " + list));
}

}  // namespace

std::vector<Variable> variables_of(const Machine& machine) {
  std::vector<Variable> out = {
      {"stiffness", "N/mm", 1e3, Quantity::stiffness, "k of the spring"},
      {"mass", "kg", 1, Quantity::mass, "all that moves with the block"},
      {"damping", "N s/mm", 1e3, Quantity::damping, "c of the block on its spring"},
      {"damping-ratio", "1", 1, Quantity::dimensionless, "c / (2 sqrt(k m)), varied by the damping"},
      {"load", "N", 1, Quantity::force, "normal force"},
      {"radius", "mm", 1e-3, Quantity::length, "friction radius, varied at constant speed of the disc"},
      {"speed", "rpm", kRpm, Quantity::angular_velocity, "of the disc"},
      {"velocity", "mm/s", 1e-3, Quantity::velocity, "omega r of the disc under the block, varied by the speed"}};
  for (const FrictionModel::Slot& slot : machine.model.parameters()) {
    const Parameter& q = slot.parameter;
    const std::optional<Unit> unit = find_unit(q.unit);
    out.push_back({called(slot), q.unit, q.si, unit ? unit->quantity : Quantity::dimensionless,
                   slot.effect.empty() ? "of the friction law" : "of the effect " + slot.effect});
  }
  if (describe(machine.model.law()).two_levels) {
    out.push_back({"ratio", "1", 1, Quantity::dimensionless, "mu_k/mu_s, varied by mu_k"});
  }
  return out;
}

Variable variable_named(const Machine& machine, std::string_view name) {
  const std::vector<Variable> known = variables_of(machine);
  const auto found = std::find_if(known.begin(), known.end(), [&](const Variable& v) { return v.name == name; });
  if (found == known.end()) refuse("parameter", name, known);
  return *found;
}

double value_of(const Machine& machine, std::string_view name) {
  const Rig& rig = machine.rig;
  if (name == "stiffness") return rig.stiffness;
  if (name == "mass") return rig.mass;
  if (name == "damping") return rig.damping;
  if (name == "damping-ratio") return rig.damping_ratio();
  if (name == "load") return machine.load;
  if (name == "radius") return machine.radius;
  if (name == "speed") return machine.speed;
  if (name == "velocity") return machine.disc_velocity();
  const bool two_levels = describe(machine.model.law()).two_levels;
  if (name == "ratio" && two_levels) return machine.parameters[1] / machine.parameters[0];
  for (std::size_t k = 0; k < machine.parameters.size(); ++k) {
    if (called(machine.model.parameters()[k]) == name) return machine.parameters[k];
  }
  refuse("parameter", name, variables_of(machine));
}

Machine with_value(Machine machine, std::string_view name, double value) {
  Rig& rig = machine.rig;
  if (name == "stiffness") {
    rig.stiffness = value;
  } else if (name == "mass") {
    rig.mass = value;
  } else if (name == "damping") {
    rig.damping = value;
  } else if (name == "damping-ratio") {
    rig = rig_with_damping_ratio(rig.mass, rig.stiffness, value);
  } else if (name == "load") {
    machine.load = value;
  } else if (name == "radius") {
    machine.radius = value;
  } else if (name == "speed") {
    machine.speed = value;
  } else if (name == "velocity") {
    machine.speed = value / machine.radius;
  } else if (name == "ratio" && describe(machine.model.law()).two_levels) {
    machine.parameters[1] = value * machine.parameters[0];
  } else {
    for (std::size_t k = 0; k < machine.parameters.size(); ++k) {
      if (called(machine.model.parameters()[k]) != name) continue;
      machine.parameters[k] = value;
      return machine;
    }
    refuse("parameter", name, variables_of(machine));
  }
  return machine;
}

namespace {

/// The number by which a variable is varied, where that is another one.
std::string_view set_by(std::string_view name) {
  if (name == "velocity") return "speed";
  if (name == "damping-ratio") return "damping";
  if (name == "ratio") return "mu_k";
  return name;
}

}  // namespace

Machine with_values(Machine machine, std::string_view first, double first_value, std::string_view second,
                    double second_value) {
  if (set_by(first) == set_by(second)) {
    throw InputError("'" + std::string(first) + "' and '" + std::string(second) + "' set the same number",
                     "name two different ones");
  }
  if (set_by(first) != first) {
    return with_value(with_value(std::move(machine), second, second_value), first, first_value);
  }
  return with_value(with_value(std::move(machine), first, first_value), second, second_value);
}

const std::vector<MeasureInfo>& measures() {
  static const std::vector<MeasureInfo> all = {
      {"frequency", "Hz", 1, &Settled::frequency, "frequency_hz", "Hz", "response frequency: cycles a second"},
      {"stick-time", "s", 1, &Settled::stick_time, "stick_time_s", "stick s",
       "time in stick in each cycle (the stick period of [C])"},
      {"peak-to-peak", "mm", 1e-3, &Settled::peak_to_peak, "peak_to_peak_mm", "peak-peak mm",
       "of the displacement of the block"},
      {"energy", "mJ", 1e-3, &Settled::energy, "energy_mJ", "energy mJ", "before break-away, k (x2 - x1)^2/2 [C]"},
      {"peak-speed", "mm/s", 1e-3, &Settled::peak_speed, "peak_speed_mm_s", "peak mm/s", "largest relative velocity"}};
  return all;
}

const MeasureInfo& measure_named(std::string_view name) {
  const auto found =
      std::find_if(measures().begin(), measures().end(), [&](const MeasureInfo& m) { return m.name == name; });
  if (found == measures().end()) refuse("measure", name, measures());
  return *found;
}

}  // namespace tribofit
