#pragma once

#include <optional>
#include <string>

#include "tribofit/ingest/trace.hpp"

namespace tribofit {

/// A declared value with its standard uncertainty, in SI.
struct Declared {
  double value = 0;
  double uncertainty = 0;
};

/// What the user knows about the instruments (`--instruments lab.json`). Absent means: not declared.
/// What is declared is corrected (kinematics/motion.hpp) and its uncertainty carried into the systematic part of
/// the result (fit/), not guessed again.
struct Instruments {
  struct Vibrometer {
    std::optional<Declared> range;      ///< full scale [m/s]
    std::optional<Declared> gain;       ///< reading over true velocity (cosine of the laser angle) [1]
    std::optional<Declared> high_pass;  ///< first-order corner [Hz]
    std::optional<Declared> low_pass;   ///< first-order corner [Hz]
    std::optional<Declared> delay;      ///< reading later than the motion [s]
    int sign = +1;                      ///< -1: the vibrometer points the other way
  } vibrometer;
  struct ForceSensor {
    std::optional<Declared> bandwidth;  ///< second-order corner [Hz]
    /// A corner that the sensor's is not below [Hz], as a tap shows it: nothing is corrected, lower ones are ruled out.
    std::optional<Declared> bandwidth_at_least;
    std::optional<Declared> zero;        ///< reading at no force: of mu [1], or of Ft [N] (see zero_is_force)
    bool zero_is_force = false;          ///< the zero was declared in N
    std::optional<Declared> crosstalk;   ///< part of Fn that shows in Ft [1]
    std::optional<Declared> mass_below;  ///< mass hanging below the sensor [kg]
    std::optional<Declared> gain;        ///< reading over true friction [1]
    bool load_measured = false;          ///< mu is Ft/Fn measured, not Ft over the nominal load
  } force_sensor;
  struct Rig {
    std::optional<Declared> stiffness;       ///< pull test [N/m]
    std::optional<Declared> ping_frequency;  ///< [Hz]
    std::optional<Declared> pad_radius;      ///< [m]
    std::optional<Declared> radius;          ///< friction radius [m]; its uncertainty is systematic
    std::optional<Declared> speed;           ///< disc speed [rad/s]
    std::optional<Declared> load;            ///< nominal load [N]
  } rig;
};

/// force_sensor.crosstalk of the file.
inline constexpr const char* kCrosstalkKey = "crosstalk";

/// Reads an instruments file (JSON; values as "0.5 Hz", ["0.5 Hz", "0.05 Hz"], or
/// {"value": "0.5 Hz", "uncertainty": "0.05 Hz"}). Throws InputError naming the key for unknown keys (nearest known
/// one offered), wrong units, values that cannot be.
Instruments read_instruments(const std::string& path);

/// The declared zero of the force sensor in the unit of the friction channel: a zero in N over the load [N] where
/// friction is a coefficient. Nothing when none is declared. Throws InputError where a load is needed and not known.
std::optional<Declared> zero_of_friction(const Instruments::ForceSensor& sensor, FrictionKind kind,
                                         const Condition& load);

}  // namespace tribofit
