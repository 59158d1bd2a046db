#pragma once

#include <optional>
#include <string_view>

#include "tribofit/ingest/instruments.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::diagnosis {

/// How far from nothing the first parameter of an effect of the instruments may still be, after what the instruments
/// file declares was corrected: three of the standard uncertainties declared [SI; of friction: 1 or N, as `kind` says].
/// Nothing where the file does not say. force_sensor.zero bounds sensor-offset, force_sensor.crosstalk crosstalk,
/// force_sensor.mass_below sensor-inertia, vibrometer.delay channel-delay. (A declared bandwidth is corrected to first
/// order only, and bounds nothing.)
std::optional<double> left_by_declared(const Instruments& instruments, std::string_view key, FrictionKind kind,
                                       const Condition& load);

/// What the instruments file says of a plateau that is `ratio` of the stated omega r.
struct PlateauSays {
  bool not_the_gain = false;    ///< vibrometer.gain is declared, and the gap is beyond its uncertainty
  bool not_the_radius = false;  ///< rig.radius and rig.speed are declared and used, and the gap is beyond theirs
};
PlateauSays plateau_says(const Instruments& instruments, const Conditions& used, double ratio);

}  // namespace tribofit::diagnosis
