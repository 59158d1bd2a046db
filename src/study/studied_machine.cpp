#include "tribofit/study/studied_machine.hpp"

#include <array>
#include <cmath>

#include "tribofit/fit/identification.hpp"
#include "tribofit/study/block_motion.hpp"
#include "tribofit/study/critical_speed.hpp"

namespace tribofit {

double std_error_of(const StudiedMachine& studied, std::string_view variable) {
  const auto from = [](const std::vector<double>& covariance, std::size_t k) {
    const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(covariance.size()))));
    const bool known = k < n && covariance[k * n + k] > 0;
    return known ? std::sqrt(covariance[k * n + k]) : std::nan("");
  };
  constexpr std::array<std::string_view, 3> kRig = {"mass", "damping", "stiffness"};
  for (std::size_t k = 0; k < kRig.size(); ++k) {
    if (variable == kRig[k]) return from(studied.covariance.rig, k);
  }
  const auto& slots = studied.machine.model.parameters();
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const std::string name = (slots[k].effect.empty() ? "" : slots[k].effect + ".") + slots[k].parameter.name;
    if (variable == name) return from(studied.covariance.friction, k);
  }
  return std::nan("");
}

BlockMotion measured_motion(const StudiedMachine& studied, double disc_velocity) {
  if (!studied.record || !is_same_speed(disc_velocity, studied.machine.disc_velocity())) return {};
  return block_motion(studied.record->motion, studied.record->segmentation,
                      studied.machine.load / studied.machine.rig.stiffness);
}

const Estimate* measured_value(const StudiedMachine& studied, const MeasureInfo& measure) {
  if (!studied.record) return nullptr;
  const Segmentation& s = studied.record->segmentation;
  const Estimate* value = measure.name == "frequency"    ? &s.frequency
                          : measure.name == "stick-time" ? &s.stick_time
                          : measure.name == "peak-speed" ? &s.amplitude
                                                         : nullptr;
  return value != nullptr && std::isfinite(value->value) ? value : nullptr;
}

}  // namespace tribofit
