#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/ingest/units.hpp"
#include "tribofit/oscillator/machine.hpp"
#include "tribofit/study/settled.hpp"

namespace tribofit {

/// A number of a machine that studies vary.
struct Variable {
  std::string name;  ///< stiffness, mass, damping, damping-ratio, load, radius, speed, velocity, mu_s, mu_k, ratio,
                     ///< alpha or beta, and KEY.parameter of each effect
  std::string unit = "1";  ///< as shown and written
  double si = 1;           ///< SI value of one unit
  Quantity quantity = Quantity::dimensionless;
  std::string meaning;
  std::function<double(const Machine&)> value;  ///< [SI]
  std::function<void(Machine&, double)> set;
  std::string set_by = {};  ///< the variable by which it is varied, where that is another one
};

/// All variables of a machine. `velocity` is omega r, varied by the speed; `ratio` is mu_k/mu_s, varied by mu_k;
/// `damping-ratio` is varied by the damping.
std::vector<Variable> variables_of(const Machine& machine);

/// The variable of that name. Throws InputError with the nearest known name where there is none.
Variable variable_named(const Machine& machine, std::string_view name);

/// The value of a variable [SI], and the machine with another one. They throw InputError, with the nearest known name,
/// where the machine has no variable of that name. Whether there can be such a machine is not checked.
double value_of(const Machine& machine, std::string_view name);
Machine with_value(Machine machine, std::string_view name, double value);

/// Two at once, in whichever order they stand: `velocity`, `damping-ratio` and `ratio` are set after what they are made
/// of, so that both values are those of the machine returned. Throws InputError for two that set the same number
/// (velocity and speed, damping-ratio and damping, ratio and mu_k).
Machine with_values(Machine machine, std::string_view first, double first_value, std::string_view second,
                    double second_value);

/// A measure of settled motion, as studies print it.
struct MeasureInfo {
  std::string name;  ///< frequency, stick-time, peak-to-peak, energy, peak-speed
  std::string unit;  ///< as shown and written
  double si = 1;     ///< SI value of one unit
  double Settled::*value = nullptr;
  std::string column;   ///< name with its unit, in CSV and JSON
  std::string heading;  ///< the same where there is little room
  std::string meaning;
};
/// All of them, in the order in which tables and maps have them.
const std::vector<MeasureInfo>& measures();
/// The measure of that name. Throws InputError with the nearest known name where there is none.
const MeasureInfo& measure_named(std::string_view name);

}  // namespace tribofit
