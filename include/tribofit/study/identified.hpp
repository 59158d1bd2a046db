#pragma once

#include <string>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/rig.hpp"
#include "tribofit/oscillator/machine.hpp"
#include "tribofit/oscillator/simulate.hpp"
#include "tribofit/study/uncertainty.hpp"

namespace tribofit {

/// A machine as a trace has it: the law and the rig found in it, at its own conditions.
struct IdentifiedMachine {
  Machine machine;
  MachineCovariance covariance;
  BreakAwayScatter scatter;
  std::vector<std::string> notes;  ///< what a person should know
  std::string reason;              ///< why there is none; empty where there is one
};

/// Law and rig put together. Where no normal force is known, or friction is a force, the load is 1 N and the rig is
/// that per newton. A mass below the force sensor that the fit found (sensor-inertia) is added to that of the rig,
/// which is the one above it; where the fit found what sets friction late (channel-delay, force-bandwidth), the rig is
/// that without the delay. The disc turns at its mean speed. Scatter of break-away and its correlation from cycle to
/// cycle are those of the record.
IdentifiedMachine identified_machine(const Fit& fit, const RigFit& rig, const Motion& motion,
                                     const Segmentation& segmentation);

}  // namespace tribofit
