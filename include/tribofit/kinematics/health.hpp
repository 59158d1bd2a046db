#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace tribofit {

/// One named check of the data, made before any fit.
/// Names: clipping, drop-outs, sagging-plateau, bandwidth, channel-delay, revolutions, speed-ripple, run-up,
/// plateau-speed, resolution.
struct HealthItem {
  enum class Status { ok, warning, problem };
  std::string check;
  Status status = Status::ok;
  std::string message;  ///< one sentence with numbers and units people use (mm/s, Hz, ms)
};
/// "ok", "warning" or "problem".
std::string_view to_string(HealthItem::Status status);

}  // namespace tribofit

/// Names of the checks of the data, as reports and JSON have them (HealthItem::check). Some coincide with the key of an
/// effect that would show there; a check says what the data show, an effect is found by the diagnosis.
namespace tribofit::health_check {

inline constexpr const char* kClipping = "clipping";
inline constexpr const char* kDropOuts = "drop-outs";
inline constexpr const char* kSaggingPlateau = "sagging-plateau";
inline constexpr const char* kBandwidth = "bandwidth";
inline constexpr const char* kChannelDelay = "channel-delay";
inline constexpr const char* kRevolutions = "revolutions";
inline constexpr const char* kSpeedRipple = "speed-ripple";
inline constexpr const char* kRunUp = "run-up";
inline constexpr const char* kPlateauSpeed = "plateau-speed";
inline constexpr const char* kResolution = "resolution";
inline constexpr const char* kFrictionZero = "friction-zero";
inline constexpr const char* kCopies = "copies";  ///< of points

/// How the message of a check begins that could not be made. Its status says nothing then, and no one reads it as "ok".
inline constexpr std::string_view kNotChecked = "not checked: ";
inline std::string not_checked(std::string_view why) {
  return std::string(kNotChecked) + std::string(why);
}
constexpr bool was_made(std::string_view message) {
  return !message.starts_with(kNotChecked);
}

/// Whether the values of a fit depend on what this check says: it bears on velocity or friction themselves.
constexpr bool bears_on_values(std::string_view check) {
  constexpr std::array<std::string_view, 7> kBearing = {kPlateauSpeed, kSpeedRipple, kChannelDelay, kFrictionZero,
                                                        kClipping,     kDropOuts,    kResolution};
  return std::find(kBearing.begin(), kBearing.end(), check) != kBearing.end();
}

}  // namespace tribofit::health_check
