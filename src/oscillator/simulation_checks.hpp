#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribofit/oscillator/simulate.hpp"

namespace tribofit {

/// "mu_s = 0.5, mu_k = 0.3, alpha = 0.05 s/mm", from values in the units of the parameters.
std::string list_of(const std::vector<Parameter>& parameters, const std::function<double(std::size_t)>& value);

/// Throws InputError unless `good`.
void require(bool good, const std::string& problem, const std::string& advice);
void require_not_negative(double x, const char* unit, const char* what, const char* advice);

/// Each throws InputError for what cannot be, and says what to do.
void check_rig_and_drive(const Rig& rig, const Drive& drive);
void check_record(double duration, double rate, double settle, const std::optional<BlockStart>& start);

/// Throws InputError for a rig, drive, model or option that cannot be, and says what to do.
void check_simulation(const Rig& rig, const Drive& drive, const FrictionModel& model, std::span<const double> p,
                      const SimulationOptions& options);

}  // namespace tribofit
