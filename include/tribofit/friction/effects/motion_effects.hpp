#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Effects of the motion: they change v_r, not mu, and show in the plateau of stick, where kinematics/ finds and undoes
/// them before any law is fitted. In a friction model they have no term.

/// The disc does not turn at one speed: omega (1 + A cos(n theta + phase)).
struct SpeedRipple {
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = "speed-ripple",
            .statement = "the disc speed swings with its angle (coupling, belt, gear), so omega r is not constant",
            .equation = "omega(theta) = omega (1 + A cos(n theta + phase))",
            .source = "kinematics of couplings and gears, textbook",
            .experiment = "laser on the unloaded disc",
            .parameters = {{"A", "1", 1, 0, 0.15, 0.01, 0},
                           {"n", "1", 1, 1, 6, 1},
                           {"phase", "rad", 1, -6.3, 6.3, 0, kNoNeutralValue, false, false, 4}},
            .needs = {.angle = true, .plateau = true},
            .group = EffectGroup::rig};
  }
};

/// The true omega r is not the stated one.
struct RadiusOffset {
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = "radius-offset",
            .statement = "the block slides at another radius, or the disc at another speed, than stated",
            .equation = "v_r = ratio omega r - v_b",
            .source = "the plateau of v_b in rigid stick is omega r, [D] Eq 4",
            .experiment = "an encoder on the disc, or tilt the laser by 10 degrees: only a wrong gain changes",
            .parameters = {{"ratio", "1", 1, 0.9, 1.1, 1}},
            .needs = {.plateau = true},
            .group = EffectGroup::measurement};
  }
};

/// The vibrometer reads g times the velocity.
struct VelocityGain {
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = "velocity-gain",
            .statement = "the vibrometer reads too much or too little (angle of the laser, wrong sensitivity)",
            .equation = "v_meas = g v_b",
            .source = "cosine of the angle between beam and motion",
            .experiment = "an encoder on the disc, or tilt the laser by 10 degrees: only a wrong gain changes",
            .parameters = {{"g", "1", 1, 0.85, 1.1, 1}},
            .needs = {.plateau = true},
            .group = EffectGroup::measurement};
  }
};

/// The vibrometer does not see slow motion: dv_m/dt + 2 pi f_c v_m = dv_b/dt.
struct VelocityHighPass {
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = "velocity-highpass",
            .statement = "the vibrometer loses slow motion, so the plateau of stick sags",
            .equation = "dv_m/dt + 2 pi f_c v_m = dv_b/dt",
            .source = "first-order high-pass, textbook; undone by v_b = v_m + 2 pi f_c integral(v_m) dt",
            .experiment = "stop the disc: a decaying plateau is the high-pass",
            .parameters = {{"f_c", "Hz", 1, 0.02, 1, 0.1, 0.02}},
            .needs = {.plateau = true},
            .group = EffectGroup::measurement};
  }
};

}  // namespace tribofit
