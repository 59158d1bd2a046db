#pragma once

#include <numbers>
#include <vector>

#include "tribofit/friction/model.hpp"
#include "tribofit/oscillator/drive.hpp"
#include "tribofit/oscillator/rig.hpp"

namespace tribofit {

/// A rig with its friction, pressed by a constant load on a disc that turns at constant speed: m x'' + c x' + k x =
/// N mu(v_r), v_r = omega r - x' ([U] Eq 1, [C]).
struct Machine {
  Rig rig;
  FrictionModel model{ExponentialLaw{}};
  std::vector<double> parameters;  ///< SI, in the order of model.parameters()
  double load = 0;                 ///< N [N], > 0
  double radius = 0;               ///< friction radius r [m], > 0
  double speed = 0;                ///< omega [rad/s], > 0

  double disc_velocity() const { return radius * speed; }  ///< omega r [m/s]
  double natural_hertz() const { return rig.natural_frequency() / (2 * std::numbers::pi); }
  Drive drive() const { return {.speed = constant_speed(speed), .radius = radius, .mean_load = load}; }
};

}  // namespace tribofit
