#pragma once

#include <span>

#include "tribofit/oscillator/simulate.hpp"

namespace tribofit {

/// Throws InputError for a rig, drive, model or option that cannot be, and says what to do.
void check_simulation(const Rig& rig, const Drive& drive, const FrictionModel& model, std::span<const double> p,
                      const SimulationOptions& options);

}  // namespace tribofit
