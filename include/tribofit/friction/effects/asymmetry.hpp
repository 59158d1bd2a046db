#pragma once

#include "tribofit/friction/effects/sensor_offset.hpp"

namespace tribofit {

/// Friction differs by direction: both levels times ratio for v_r < 0.
struct Asymmetry {
  static constexpr std::string_view key = "asymmetry";
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "friction differs by direction (texture, wear debris, tilted pad)",
            .equation = "mu_s' = ratio mu_s, mu_k' = ratio mu_k where v_r < 0",
            .source = "C. Canudas de Wit, K. J. Astrom, K. Braun, IEEE J. Robot. Autom. 3 (1987) 681",
            .experiment = "reverse the disc at the same speed and load",
            .parameters = {{.name = "ratio",
                            .description = "friction at negative v_r over friction at positive v_r",
                            .lower = 0.2,
                            .upper = 5,
                            .start = 1}},
            .excitation = {.both_directions = true},
            .sketch = {.view = SketchView::directions, .values = {0.85}},
            .pairs = {
                looks_like<SensorOffset>("lift the block off the disc and read the force sensor: what it shows without "
                                         "contact is its zero, for force_sensor.zero of the instruments file")}};
  }

  template <class T>
  void adjust(const T* p, const Slip& slip, LawValues<T>& law) const {
    if (slip.direction < 0) law.scale_friction(p[0]);
  }
};

}  // namespace tribofit
