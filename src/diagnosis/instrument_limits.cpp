#include "instrument_limits.hpp"

#include <algorithm>
#include <cmath>

namespace tribofit::diagnosis {

namespace {

constexpr double kSigmas = 3;

/// The value in use is the declared one.
bool is_used(const Condition& used, const std::optional<Declared>& declared) {
  if (!declared || !used.known()) return false;
  const double allowed = std::max(1e-6 * std::abs(declared->value), 2 * declared->uncertainty);
  return std::abs(used.value - declared->value) <= allowed;
}

}  // namespace

std::optional<AllowedRange> allowed_beside_declared(const Instruments& instruments, std::string_view key,
                                                    FrictionKind kind, const Condition& load) {
  const auto& sensor = instruments.force_sensor;
  if (key == "force-bandwidth" && sensor.bandwidth) {
    return AllowedRange{sensor.bandwidth->value - kSigmas * sensor.bandwidth->uncertainty, HUGE_VAL};
  }
  std::optional<Declared> declared;
  if (key == "sensor-offset" && sensor.zero) declared = zero_of_friction(sensor, kind, load);
  if (key == "crosstalk") declared = sensor.crosstalk;
  if (key == "sensor-inertia") declared = sensor.mass_below;
  if (key == "channel-delay") declared = instruments.vibrometer.delay;
  if (!declared) return std::nullopt;
  return AllowedRange{-kSigmas * declared->uncertainty, kSigmas * declared->uncertainty};
}

PlateauSays plateau_says(const Instruments& instruments, const Conditions& used, double ratio) {
  PlateauSays out;
  const double off = std::abs(ratio - 1);
  const auto relative = [](const Declared& d) { return d.uncertainty / std::abs(d.value); };
  if (instruments.vibrometer.gain) out.not_the_gain = off > kSigmas * relative(*instruments.vibrometer.gain);
  const auto& rig = instruments.rig;
  if (is_used(used.radius, rig.radius) && is_used(used.speed, rig.speed)) {
    out.not_the_radius = off > kSigmas * std::hypot(relative(*rig.radius), relative(*rig.speed));
  }
  return out;
}

}  // namespace tribofit::diagnosis
