#pragma once

#include <optional>

#include "tribofit/friction/effect.hpp"
#include "tribofit/ingest/instruments.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::diagnosis {

/// Values of the first parameter of an effect that are still possible [SI; of friction: 1 or N].
struct AllowedRange {
  double lower = 0, upper = 0;
  bool is_uncertainty = true;  ///< of a value that was declared and corrected: what lies within needs no other name
  bool holds(double value) const { return value >= lower && value <= upper; }
};

/// What is possible beside what the instruments file declares, within three of the standard uncertainties declared;
/// nothing where the file does not say. What was declared has been corrected: no more than its uncertainty is left. A
/// filter is not slower than the declared bandwidth, nor than one that is known to be at least so.
/// value: that is about the effect; kind, load: of the record; a zero in N is taken over the load.
std::optional<AllowedRange> allowed_beside_declared(const Instruments& instruments, InstrumentValue value,
                                                    FrictionKind kind, const Condition& load);

/// What the instruments file says of a plateau that is `ratio` of the stated omega r.
struct PlateauSays {
  bool not_the_gain = false;    ///< vibrometer.gain is declared, and the gap is beyond its uncertainty
  bool not_the_radius = false;  ///< rig.radius and rig.speed are declared and used, and the gap is beyond theirs

  /// The gap is not what `correction` would correct, and may be the other.
  bool rules_out(PlateauCorrection correction) const {
    return correction == PlateauCorrection::radius ? not_the_radius && !not_the_gain : not_the_gain && !not_the_radius;
  }
};
PlateauSays plateau_says(const Instruments& instruments, const Conditions& used, double ratio);

}  // namespace tribofit::diagnosis
