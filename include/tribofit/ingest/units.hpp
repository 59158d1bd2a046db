#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <string_view>

namespace tribofit {

/// Kinds of quantity that users state and files hold.
enum class Quantity {
  dimensionless,
  time,                        // s
  length,                      // m
  velocity,                    // m/s
  angular_velocity,            // rad/s
  acceleration,                // m/s^2
  force,                       // N
  torque,                      // N m
  mass,                        // kg
  stiffness,                   // N/m
  damping,                     // N s/m
  frequency,                   // Hz
  angle,                       // rad
  temperature,                 // degC
  voltage,                     // V
  inverse_velocity,            // s/m (decay factors, viscous coefficient)
  inverse_square_of_velocity,  // s^2/m^2 (drag)
  inverse_length,              // 1/m
  inverse_time,                // 1/s
  inverse_temperature,         // 1/K
  pressure,                    // Pa
};

/// SI values of the units people read and write.
inline constexpr double kMillimetre = 1e-3, kMicrometre = 1e-6, kMillisecond = 1e-3;
inline constexpr double kRpm = 2 * std::numbers::pi / 60;

/// A unit: SI value = factor * number + offset.
struct Unit {
  Quantity quantity = Quantity::dimensionless;
  double factor = 1;
  double offset = 0;  ///< only for temperatures
};

/// The unit named by `text` ("mm/s", "rpm", "kN", "°C", "µm", "s/mm", "%", "1/min"), or nothing when unknown.
/// Case matters only where SI needs it (mN, MN); spaces, "·", "*", "^", "²" are understood.
std::optional<Unit> find_unit(std::string_view text);

/// As above, for a value that must be of `quantity`; nothing when the unit is unknown or of another quantity.
/// Knows that "1/min" on a drive is a rotational speed (rpm) and not a rate.
std::optional<Unit> find_unit(std::string_view text, Quantity quantity);

/// The known unit spelled most like `text`, for messages; empty when none is near.
std::string suggest_unit(std::string_view text);

/// A number with a unit ("15mm", "0.015 m", "4 rpm", "0.419rad/s", "20kHz"), in SI.
/// A bare number is taken in SI except where `bare_unit` names another.
/// Throws InputError (name is what the user calls the option) for a text that is not a number, an unknown unit (nearest
/// known one offered), a unit of another quantity, inf and nan.
double parse_quantity(std::string_view text, Quantity quantity, std::string_view name, std::string_view bare_unit = {});

/// A frequency with so many digits: "20 kHz", "118.3 Hz"; "-" for NaN.
std::string frequency_text(double hertz, int digits = 4);

/// "length", "angular velocity", ... for messages.
std::string_view to_string(Quantity quantity);

/// How a value of this quantity is written on the command line ("15mm or 0.015m"), for messages.
std::string_view example_of(Quantity quantity);

}  // namespace tribofit
