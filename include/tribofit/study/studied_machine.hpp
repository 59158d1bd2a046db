#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/oscillator/machine.hpp"
#include "tribofit/study/uncertainty.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit {

struct BlockMotion;
struct Estimate;
struct Identification;

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
