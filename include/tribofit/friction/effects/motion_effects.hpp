#pragma once

#include "tribofit/friction/effects/runout.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit {

/// Effects of the motion: they change v_r, not mu, and show in the plateau of stick, where kinematics/ finds and undoes
/// them before any law is fitted. In a friction model they have no term.

inline constexpr std::string_view kShownByPlateau =
    "the plateau of stick shows it; it was corrected before the law was fitted";

/// The ratio of the plateau to the stated omega r, where it was corrected: radius and gain show in it alike.
inline FoundBeforeFit found_on_plateau(const Motion& motion) {
  if (motion.plateau_correction == PlateauCorrection::none) return {};
  return {.values = {{motion.corrected_ratio, motion.plateau_ratio_std_error}}, .reason = kShownByPlateau};
}

/// The disc does not turn at one speed: omega (1 + A cos(n theta + phase)).
struct SpeedRipple {
  static constexpr std::string_view key = "speed-ripple";
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement = "the disc speed swings with its angle (coupling, belt, gear), so omega r is not constant",
        .equation = "omega(theta) = omega (1 + A cos(n theta + phase))",
        .source = "kinematics of couplings and gears, textbook",
        .experiment = "laser on the unloaded disc",
        .parameters = {{.name = "A",
                        .description = "amplitude of the swing of the speed, relative to its mean",
                        .lower = 0,
                        .upper = 0.5,
                        .start = 0.01,
                        .neutral = 0},
                       {.name = "n", .description = "swings in a revolution", .lower = 1, .upper = 6, .start = 1},
                       {.name = "phase",
                        .description = "phase of the swing at the first sample of the record",
                        .unit = "rad",
                        .lower = -6.3,
                        .upper = 6.3,
                        .scope = ParameterScope::record,
                        .start_grid_points = 4,
                        .periodic = true}},
        .needs = {.angle = true, .plateau = true},
        .excitation = {.revolutions = 2, .stated_disc_speed = true},
        .group = EffectGroup::rig,
        .sketch = {.view = SketchView::ripple, .values = {0.08, 2, 0}},
        .pairs = {looks_like<Runout>("record four revolutions: a ripple moves the plateau of v_b, a runout friction; "
                                     "or point the laser at the unloaded disc: a ripple of the speed shows there")}};
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    const DiscRipple& ripple = motion.speed_ripple;
    if (!(ripple.amplitude > 0)) return {};
    return {.values = {{ripple.amplitude, ripple.amplitude_std_error},
                       {static_cast<double>(ripple.order), 0},
                       {ripple.phase, ripple.phase_std_error}},
            .reason = kShownByPlateau};
  }

  static SpeedSwing speed_swing(const double* p) { return {p[0], p[1], p[2]}; }
};

/// The vibrometer reads g times the velocity.
struct VelocityGain {
  static constexpr std::string_view key = "velocity-gain";
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the vibrometer reads too much or too little (angle of the laser, wrong sensitivity)",
            .equation = "v_meas = g v_b",
            .source = "cosine of the angle between beam and motion",
            .experiment = "an encoder on the disc, or tilt the laser by 10 degrees: only a wrong gain changes",
            .parameters = {{.name = "g",
                            .description = "reading of the vibrometer over the true velocity",
                            .lower = 0.4,
                            .upper = 2.5,
                            .start = 1}},
            .needs = {.plateau = true},
            .excitation = {.stated_plateau = true},
            .group = EffectGroup::measurement,
            .plateau_correction = PlateauCorrection::gain,
            .sketch = {.view = SketchView::plateau, .values = {0.92}}};
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    return found_on_plateau(motion);
  }

  static double velocity_gain(const double* p) { return p[0]; }
};

/// The true omega r is not the stated one.
struct RadiusOffset {
  static constexpr std::string_view key = "radius-offset";
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the block slides at another radius, or the disc at another speed, than stated",
            .equation = "v_r = ratio omega r - v_b",
            .source = "the plateau of v_b in rigid stick is omega r, [D] Eq 4",
            .experiment = "an encoder on the disc, or tilt the laser by 10 degrees: only a wrong gain changes",
            .parameters = {{.name = "ratio",
                            .description = "true omega r over the stated one",
                            .lower = 0.4,
                            .upper = 2.5,
                            .start = 1}},
            .needs = {.plateau = true},
            .excitation = {.stated_plateau = true},
            .group = EffectGroup::measurement,
            .plateau_correction = PlateauCorrection::radius,
            .sketch = {.view = SketchView::plateau, .values = {1.05}},
            .pairs = {looks_like<VelocityGain>(
                "point the laser at what moves at a known speed (the rim of the disc, with an encoder on it): reading "
                "over speed is the gain, for vibrometer.gain of the instruments file; what is left is the radius")}};
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    return found_on_plateau(motion);
  }

  static double true_radius(const double* p, double stated) { return p[0] * stated; }
};

/// The vibrometer does not see slow motion: dv_m/dt + 2 pi f_c v_m = dv_b/dt.
struct VelocityHighPass {
  static constexpr std::string_view key = "velocity-highpass";
  /// Distinguishes what moves the plateau of stick.
  static constexpr std::string_view stop_the_disc =
      "record at half the disc speed too: a plateau that sags for twice as long is the high-pass, a constant gap to "
      "omega r is the radius, a gap in proportion to d mu/dt is the bristle; or stop the disc: only behind a high-pass "
      "the plateau decays";

  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the vibrometer loses slow motion, so the plateau of stick sags",
            .equation = "dv_m/dt + 2 pi f_c v_m = dv_b/dt",
            .source = "first-order high-pass, textbook; undone by v_b = v_m + 2 pi f_c integral(v_m) dt",
            .experiment = "stop the disc: a decaying plateau is the high-pass",
            .parameters = {{.name = "f_c",
                            .description = "corner frequency of the high-pass",
                            .unit = "Hz",
                            .lower = 0.02,
                            .upper = 1,
                            .start = 0.1,
                            .neutral = 0.02,
                            .bound_scaling = BoundScaling::against_slip_time}},
            .needs = {.plateau = true},
            .group = EffectGroup::measurement,
            .sketch = {.view = SketchView::plateau, .values = {0.3}},
            .pairs = {looks_like<RadiusOffset>(stop_the_disc)}};
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    if (!(motion.high_pass > 0)) return {};
    return {.values = {{motion.high_pass, motion.high_pass_std_error}}, .reason = kShownByPlateau};
  }

  static double velocity_high_pass(const double* p) { return p[0]; }
};

}  // namespace tribofit
