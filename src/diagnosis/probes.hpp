#pragma once

#include <vector>

#include "trial.hpp"
#include "tribofit/fit/residual_variable.hpp"

namespace tribofit::diagnosis {

/// A free function of one variable laid on top of a model: what it takes away of the error goes with that variable,
/// whatever the effect behind it may be.
struct Probe {
  ResidualVariable variable = ResidualVariable::velocity;
  double fall = 0;     ///< of the squares on held-out cycles
  double size = 0;     ///< see CandidateResult::size
  double p_value = 1;  ///< not corrected for the number of variables
  double period = 0;   ///< of the strongest swing over time [s], or 1/frequency of the strongest line; else 0
  std::vector<double> at, value;  ///< the function found: velocity [m/s], distance [m] or time [s], and
                                  ///< what it adds to |mu|
};

/// Every variable that these data can distinguish: velocity, branch, time, angle, stick-time, load, reversal-distance,
/// frequency.
/// trial: at the coarse level of the context.
std::vector<Probe> probe_all(const DiagnosisContext& context, const Trial& coarse, const Trial& fine,
                             std::span<const double> residual);

/// The probes that chance does not make and that are large enough to matter, largest first. shared: as in
/// DiagnosisContext.
std::vector<Probe> remaining_structure(const std::vector<Probe>& probes, double shared = 0);

}  // namespace tribofit::diagnosis
