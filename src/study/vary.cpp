#include "tribofit/study/vary.hpp"
#include "tribofit/ingest/units.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"

namespace tribofit {

namespace {

/// The entry of that name.
template <class Entry>
const Entry& named(std::string_view what, std::string_view name, const std::vector<Entry>& known) {
  const auto found = std::find_if(known.begin(), known.end(), [&](const Entry& entry) { return entry.name == name; });
  if (found != known.end()) return *found;
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

std::vector<Variable> variables_of_rig_and_drive() {
  using M = Machine;
  using Q = Quantity;
  return {{"stiffness", "N/mm", 1e3, Q::stiffness, "k of the spring", [](const M& m) { return m.rig.stiffness; },
           [](M& m, double k) { m.rig.stiffness = k; }},
          {"mass", "kg", 1, Q::mass, "all that moves with the block", [](const M& m) { return m.rig.mass; },
           [](M& m, double mass) { m.rig.mass = mass; }},
          {"damping", "N s/mm", 1e3, Q::damping, "c of the block on its spring",
           [](const M& m) { return m.rig.damping; }, [](M& m, double c) { m.rig.damping = c; }},
          {"damping-ratio", "1", 1, Q::dimensionless, "c / (2 sqrt(k m)), varied by the damping",
           [](const M& m) { return m.rig.damping_ratio(); },
           [](M& m, double ratio) { m.rig = rig_with_damping_ratio(m.rig.mass, m.rig.stiffness, ratio); }, "damping"},
          {"load", "N", 1, Q::force, "normal force", [](const M& m) { return m.load; },
           [](M& m, double load) { m.load = load; }},
          {"radius", "mm", kMillimetre, Q::length, "friction radius, varied at constant speed of the disc",
           [](const M& m) { return m.radius; }, [](M& m, double r) { m.radius = r; }},
          {"speed", "rpm", kRpm, Q::angular_velocity, "of the disc", [](const M& m) { return m.speed; },
           [](M& m, double omega) { m.speed = omega; }},
          {"velocity", "mm/s", kMillimetre, Q::velocity, "omega r of the disc under the block, varied by the speed",
           [](const M& m) { return m.disc_velocity(); }, [](M& m, double v) { m.speed = v / m.radius; }, "speed"}};
}

}  // namespace

std::vector<Variable> variables_of(const Machine& machine) {
  using M = Machine;
  std::vector<Variable> out = variables_of_rig_and_drive();
  for (std::size_t k = 0; k < machine.model.parameters().size(); ++k) {
    const FrictionModel::Slot& slot = machine.model.parameters()[k];
    const Parameter& q = slot.parameter;
    const std::optional<Unit> unit = find_unit(q.unit);
    out.push_back({.name = slot.full_name(),
                   .unit = q.unit,
                   .si = q.si,
                   .quantity = unit ? unit->quantity : Quantity::dimensionless,
                   .meaning = slot.effect.empty() ? "of the friction law" : "of the effect " + slot.effect,
                   .value = [k](const M& m) { return m.parameters.at(k); },
                   .set = [k](M& m, double value) { m.parameters.at(k) = value; }});
  }
  if (describe(machine.model.law()).two_levels) {
    out.push_back({.name = "ratio",
                   .meaning = "mu_k/mu_s, varied by mu_k",
                   .value = [](const M& m) { return m.parameters[1] / m.parameters[0]; },
                   .set = [](M& m, double ratio) { m.parameters[1] = ratio * m.parameters[0]; },
                   .set_by = kinetic_level_name});
  }
  return out;
}

Variable variable_named(const Machine& machine, std::string_view name) {
  return named("parameter", name, variables_of(machine));
}

double value_of(const Machine& machine, std::string_view name) {
  return variable_named(machine, name).value(machine);
}

Machine with_value(Machine machine, std::string_view name, double value) {
  variable_named(machine, name).set(machine, value);
  return machine;
}

Machine with_values(Machine machine, std::string_view first, double first_value, std::string_view second,
                    double second_value) {
  const Variable a = variable_named(machine, first), b = variable_named(machine, second);
  const auto sets = [](const Variable& v) { return v.set_by.empty() ? v.name : v.set_by; };
  if (sets(a) == sets(b)) {
    throw InputError("'" + a.name + "' and '" + b.name + "' set the same number", "name two different ones");
  }
  const bool second_first = !a.set_by.empty();
  if (second_first) b.set(machine, second_value);
  a.set(machine, first_value);
  if (!second_first) b.set(machine, second_value);
  return machine;
}

const std::vector<MeasureInfo>& measures() {
  static const std::vector<MeasureInfo> all = {
      {"frequency", "Hz", 1, &Settled::frequency, "frequency_hz", "Hz", "response frequency: cycles a second"},
      {"stick-time", "s", 1, &Settled::stick_time, "stick_time_s", "stick s",
       "time in stick in each cycle (the stick period of [C])"},
      {"peak-to-peak", "mm", 1e-3, &Settled::peak_to_peak, "peak_to_peak_mm", "p-p mm",
       "of the displacement of the block"},
      {"energy", "mJ", 1e-3, &Settled::energy, "energy_mJ", "energy mJ", "before break-away, k (x2 - x1)^2/2 [C]"},
      {"peak-speed", "mm/s", 1e-3, &Settled::peak_speed, "peak_speed_mm_s", "peak mm/s", "largest relative velocity"}};
  return all;
}

const MeasureInfo& measure_named(std::string_view name) {
  return named("measure", name, measures());
}

}  // namespace tribofit
