#pragma once

#include <numbers>

#include "tribofit/friction/effect.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit {

/// What channels do to their readings. Each shows where a block that sticks and slips is held by its spring: it goes
/// nowhere, and comes to rest at once. There kinematics/ finds them and undoes them before any law is fitted. In a
/// friction model they have no term.

/// The vibrometer reads v0 at rest.
struct VelocityOffset {
  static constexpr std::string_view key = "velocity-offset";
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the zero of the vibrometer is off, so that every velocity is read too high or too low",
            .equation = "v_meas = v_b + v0",
            .source = "a block on a spring goes nowhere: the mean of v_meas is v0",
            .experiment = "record with the disc at rest: what the vibrometer then reads is its zero",
            .parameters = {{.name = "v0",
                            .description = "reading of the vibrometer at rest",
                            .unit = "mm/s",
                            .si = 1e-3,
                            .lower = -100,
                            .upper = 100,
                            .neutral = 0}},
            .needs = {.plateau = true},
            .excitation = {.stated_plateau = true},
            .group = EffectGroup::measurement,
            .sketch = {.view = SketchView::plateau, .values = {0.5}}};
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    if (!motion.velocity_zero.any()) return {};
    return {.values = {{motion.velocity_zero.value, motion.velocity_zero.std_error}},
            .reason =
                "the block has no net displacement, but its mean velocity is not zero, and the plateau of stick is off "
                "by as much; it was corrected before the law was fitted"};
  }

  static double velocity_zero(const double* p) { return p[0]; }
};

/// The velocity channel is a first-order low-pass.
struct VelocityBandwidth {
  static constexpr std::string_view key = "velocity-bandwidth";
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the vibrometer or its amplifier follows the velocity late, as an RC filter does",
            .equation = "tau dv_meas/dt + v_meas = v_b, tau = 1/(2 pi f_c)",
            .source = "first-order low-pass, textbook; undone by v_b = v_meas + tau dv_meas/dt",
            .experiment = "tap the block with the filter of the amplifier open and closed: the edges show what it does",
            .parameters = {{.name = "f_c",
                            .description = "corner frequency of the low-pass",
                            .unit = "Hz",
                            .lower = 20,
                            .upper = 5000,
                            .start = 500,
                            .neutral = 5000,
                            .bound_scaling = BoundScaling::against_slip_time}},
            .group = EffectGroup::measurement,
            .sketch = {.view = SketchView::loop, .values = {200}}};
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    const Estimate& tau = motion.velocity_low_pass;
    if (!tau.any()) return {};
    const double corner = 1 / (2 * std::numbers::pi * tau.value);
    return {.values = {{corner, corner * tau.std_error / tau.value}},
            .reason = "v_r decays at re-stick; it was corrected before the law was fitted"};
  }

  static double velocity_low_pass(const double* p) { return p[0]; }
};

/// The gain of the vibrometer falls towards the end of its range.
struct VelocityCompression {
  static constexpr std::string_view key = "velocity-compression";
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the gain of the vibrometer falls (or rises) towards its limit, so slips are read too slow",
            .equation = "v_meas = v_b (1 - c (v_b/v_max)^2), v_max the largest |v_b|",
            .source = "third-order term of an odd characteristic, textbook; c from no net displacement of the block",
            .experiment = "record the same slips in the next larger range of the vibrometer",
            .parameters = {{.name = "c",
                            .description = "part of the gain that is lost at the fastest",
                            .lower = -0.3,
                            .upper = 0.3,
                            .neutral = 0}},
            .needs = {.plateau = true},
            .excitation = {.stated_plateau = true},
            .group = EffectGroup::measurement,
            .sketch = {.view = SketchView::curve, .values = {0.2}},
            .forms = {{"by-direction", "against the disc the gain is another, at any speed"}}};
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    return found_response(motion.velocity_response, false);
  }

  /// one_sided: whether it is asked for a gain that differs by direction.
  static FoundBeforeFit found_response(const UndoneResponse& found, bool one_sided) {
    if (!found.any() || (found.response.form == StaticResponse::Form::one_sided) != one_sided) return {};
    return {.values = {{found.response.part, found.std_error}},
            .reason =
                "the plateau of stick is omega r, but the block would have a net displacement; it was corrected before "
                "the law was fitted"};
  }

  static StaticResponse velocity_response(const double* p) {
    return {.form = StaticResponse::Form::square, .part = p[0]};
  }
};

/// A form of velocity-compression: velocities against the disc are read with another gain.
struct VelocityGainByDirection {
  static constexpr std::string_view key = VelocityCompression::key;
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    EffectInfo info = VelocityCompression::info();
    info.option = "by-direction";
    info.forms.clear();
    info.statement = "the vibrometer reads velocities against the disc with another gain than those with it";
    info.equation = "v_meas = v_b (1 - c) where v_b runs against the disc";
    info.source = "even part of a characteristic; c from no net displacement, the form from force balance";
    info.experiment = "let the disc turn the other way: the other half of the slips is then read wrongly";
    info.parameters[0].description = "part of the gain that is lost against the disc";
    return info;
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    return VelocityCompression::found_response(motion.velocity_response, true);
  }

  static StaticResponse velocity_response(const double* p) {
    return {.form = StaticResponse::Form::one_sided, .part = p[0]};
  }
};

/// The gain of the friction channel falls towards the end of its range.
struct FrictionCompression {
  static constexpr std::string_view key = "friction-compression";
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the gain of the force sensor or its amplifier falls towards its limit",
            .equation = "reading = mu (1 - c (mu/mu_max)^2), or (1 - c mu/mu_max), mu_max the largest",
            .source =
                "characteristic of an amplifier, textbook; in rigid stick friction is the force of the spring, "
                "k x, a straight line over the displacement of the block",
            .experiment = "load the sensor with weights: its reading then rises in a straight line, or does not",
            .parameters = {{.name = "c",
                            .description = "part of the gain that is lost at the largest friction",
                            .lower = 0,
                            .upper = 0.5,
                            .neutral = 0}},
            .needs = {.plateau = true},
            .group = EffectGroup::measurement,
            .sketch = {.view = SketchView::curve, .values = {0.2}}};
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    const UndoneResponse& found = motion.friction_response;
    if (!found.any()) return {};
    return {.values = {{found.response.part, found.std_error}},
            .reason =
                "in stick friction rises ever slower over the displacement of the block, the same in every cycle; "
                "it was corrected before the law was fitted"};
  }

  static StaticResponse friction_response(const double* p) {
    return {.form = StaticResponse::Form::square, .part = p[0]};
  }
};

/// The channels have clocks of their own, and the velocity runs ahead of friction (positive) or falls behind.
struct ClockDrift {
  static constexpr std::string_view key = "clock-drift";
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the two channels were sampled by clocks that run apart, so one falls behind the other",
            .equation = "v_meas(t) = v_b(t + d t), t from the first sample of friction's clock",
            .source = "quartz clocks differ by up to 100 in a million",
            .experiment = "put one signal on both instruments: the delay between them then grows with time",
            .parameters = {{.name = "d",
                            .description = "time by which the velocity runs ahead of friction, over time",
                            .lower = -0.01,
                            .upper = 0.01,
                            .neutral = 0}},
            .group = EffectGroup::measurement,
            .sketch = {.view = SketchView::time, .values = {2e-4}}};
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    if (!motion.clock_drift.any()) return {};
    return {.values = {{motion.clock_drift.value, motion.clock_drift.std_error}},
            .reason =
                "friction jumps ever later (or earlier) than the velocity comes to rest; it was corrected before "
                "the law was fitted"};
  }

  static double clock_drift(const double* p) { return p[0]; }
};

}  // namespace tribofit
