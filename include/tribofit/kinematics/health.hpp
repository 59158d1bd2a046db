#pragma once

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
