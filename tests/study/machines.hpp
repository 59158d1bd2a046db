#pragma once

#include "tribofit/oscillator/machine.hpp"
#include "tribofit/oscillator/presets.hpp"

namespace tribofit::studies {

/// The 15 mm test of [D] with a rig of ours.
inline Machine published_machine(Law law = Law(ExponentialLaw{})) {
  const PublishedTest test = published_test(0.015, law);
  return {test.rig, FrictionModel(law), test.friction, test.load, test.radius, test.speed};
}

/// [U] Fig 2 in N, mm, s with the mass in t: m = 1 t, k = 5 N/mm, c = 0.2 N s/mm, N = 10 N, mu 0.6 and 0.1.
/// decay: c_v, which is not printed [s/m]; velocity of the disc [m/s].
inline Machine uradnicek_machine(double decay, double velocity) {
  constexpr double kRadius = 0.1;
  return {{1000, 200, 5000}, FrictionModel(ExponentialLaw{}), {0.6, 0.1, decay}, 10, kRadius, velocity / kRadius};
}

}  // namespace tribofit::studies
