#pragma once

#include <limits>
#include <string>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/rig.hpp"
#include "tribofit/ingest/instruments.hpp"
#include "tribofit/oscillator/machine.hpp"
#include "tribofit/oscillator/simulate.hpp"
#include "tribofit/study/uncertainty.hpp"

namespace tribofit {

/// A machine as a trace has it: the law and the rig found in it, at its own conditions.
struct IdentifiedMachine {
  Machine machine;
  MachineCovariance covariance;
  BreakAwayScatter scatter;
  /// Held-out error of the law over the noise floor where it is clearly more: then the machine is another one. NaN
  /// where the law is at its floor, or none is known.
  double law_over_floor = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> notes;  ///< what a person should know
  std::string reason;              ///< why there is none; empty where there is one
};

/// The rig beside a law: where the fit found what sets friction late against v_b (channel-delay, force-bandwidth), the
/// balance is made with friction moved earlier by it, else with the channels as they are.
RigFit rig_beside(const Fit& fit, const Motion& motion, const Segmentation& segmentation,
                  const Instruments& instruments = {});

/// Law and rig put together. Where no normal force is known, or friction is a force, the load is 1 N and the rig is
/// that per newton. A mass below the force sensor that the fit found (sensor-inertia) is added to that of the rig,
/// which is the one above it. The disc turns at its mean speed. Scatter of break-away and its correlation from cycle to
/// cycle are those of the record.
IdentifiedMachine identified_machine(const Fit& fit, const RigFit& rig, const Motion& motion,
                                     const Segmentation& segmentation);

}  // namespace tribofit
