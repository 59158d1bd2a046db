#include "instrument_limits.hpp"

#include <algorithm>
#include <cmath>

#include "limits.hpp"

namespace tribofit::diagnosis {

namespace {

/// The value in use is the declared one.
bool is_used(const Condition& used, const std::optional<Declared>& declared) {
  if (!declared || !used.known()) return false;
  const double allowed = std::max(1e-6 * std::abs(declared->value), 2 * declared->uncertainty);
  return std::abs(used.value - declared->value) <= allowed;
}

std::optional<Declared> declared_value(const Instruments& instruments, InstrumentValue value, FrictionKind kind,
                                       const Condition& load) {
  const auto& sensor = instruments.force_sensor;
  switch (value) {
    case InstrumentValue::none:
      break;
    case InstrumentValue::force_zero:
      return sensor.zero ? zero_of_friction(sensor, kind, load) : std::nullopt;
    case InstrumentValue::force_crosstalk:
      return sensor.crosstalk;
    case InstrumentValue::force_mass_below:
      return sensor.mass_below;
    case InstrumentValue::force_bandwidth:
      return sensor.bandwidth ? sensor.bandwidth : sensor.bandwidth_at_least;
    case InstrumentValue::vibrometer_delay:
      return instruments.vibrometer.delay;
  }
  return std::nullopt;
}

}  // namespace

std::optional<AllowedRange> allowed_beside_declared(const Instruments& instruments, InstrumentValue value,
                                                    FrictionKind kind, const Condition& load) {
  const std::optional<Declared> declared = declared_value(instruments, value, kind, load);
  if (!declared) return std::nullopt;
  if (value == InstrumentValue::force_bandwidth) {
    return AllowedRange{declared->value - limits::kDeclaredSigmas * declared->uncertainty, HUGE_VAL,
                        instruments.force_sensor.bandwidth.has_value()};
  }
  return AllowedRange{-limits::kDeclaredSigmas * declared->uncertainty,
                      limits::kDeclaredSigmas * declared->uncertainty};
}

PlateauSays plateau_says(const Instruments& instruments, const Conditions& used, double ratio) {
  PlateauSays out;
  const double off = std::abs(ratio - 1);
  const auto relative = [](const Declared& d) { return d.uncertainty / std::abs(d.value); };
  if (instruments.vibrometer.gain)
    out.not_the_gain = off > limits::kDeclaredSigmas * relative(*instruments.vibrometer.gain);
  const auto& rig = instruments.rig;
  if (is_used(used.radius, rig.radius) && is_used(used.speed, rig.speed)) {
    out.not_the_radius = off > limits::kDeclaredSigmas * std::hypot(relative(*rig.radius), relative(*rig.speed));
  }
  return out;
}

}  // namespace tribofit::diagnosis
