#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/oscillator/machine.hpp"
#include "tribofit/oscillator/simulate.hpp"
#include "tribofit/statistics/estimate.hpp"

namespace tribofit {

struct BlockMotion;
struct Fit;
struct Identification;
struct Instruments;
struct MeasureInfo;
struct Motion;
struct RigFit;
struct Segmentation;

/// What is known of the numbers of an identified machine.
struct MachineCovariance {
  std::vector<double> friction;  ///< of its parameters, row by row (Fit::covariance); empty: taken as exact
  std::vector<double> rig;       ///< of mass, damping, stiffness, row by row [SI]; empty: taken as exact
  bool empty() const { return friction.empty() && rig.empty(); }
};

/// Machines that the data would have given as well: normal draws from both covariances, which are taken to be
/// independent (friction is fitted over slip from speeds, the rig from forces over everything). Draws that cannot be
/// (a negative mass, mu_s or decay factor) are drawn again. The same seed gives the same machines.
std::vector<Machine> draws_of(const Machine& machine, const MachineCovariance& covariance, std::size_t count,
                              std::uint64_t seed = 1);

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
                  const Instruments& instruments);

/// Law and rig put together. Where no normal force is known, or friction is a force, the load is 1 N and the rig is
/// that per newton. A mass below the force sensor that the fit found (sensor-inertia) is added to that of the rig,
/// which is the one above it. The disc turns at its mean speed. Scatter of break-away and its correlation from cycle to
/// cycle are those of the record.
IdentifiedMachine identified_machine(const Fit& fit, const RigFit& rig, const Motion& motion,
                                     const Segmentation& segmentation);

/// What is studied, and where it comes from ("given values", "identified from trace.csv").
struct StudiedMachine {
  Machine machine;
  MachineCovariance covariance;
  std::string source;
  std::vector<std::string> notes;
  double sharpness = 0;  ///< of the smoothed law [s/m]; 0: the event-located law
  /// From which it was identified, to be shown beside what is simulated; null: from none.
  std::shared_ptr<const Identification> record = {};
  std::vector<std::string> warnings = {};  ///< said first: why the answers may be those of another machine
};

/// Standard error of a variable of an identified machine [SI]; NaN where none is known.
double std_error_of(const StudiedMachine& studied, std::string_view variable);

/// Three cycles of its record where that was made at this speed of the disc [m/s]; empty elsewhere.
BlockMotion measured_motion(const StudiedMachine& studied, double disc_velocity);

/// What the record says of a measure at its own speed [SI]; null where it does not.
const Estimate* measured_value(const StudiedMachine& studied, const MeasureInfo& measure);

}  // namespace tribofit
