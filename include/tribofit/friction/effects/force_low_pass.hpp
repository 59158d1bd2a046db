#pragma once

#include <numbers>

#include "tribofit/friction/effects/force_bandwidth.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit {

/// A form of force-bandwidth: the friction channel is a first-order low-pass. In slip that is the equation of
/// frictional-lag; at re-stick, where friction becomes the spring's at once, a lag of the contact ends and the reading
/// of a slow channel decays. There kinematics/ finds it; each law is then filtered like the channel.
struct ForceLowPass {
  static constexpr std::string_view key = ForceBandwidth::key;
  static constexpr bool kinematic_effect = true;

  static EffectInfo info() {
    EffectInfo info = ForceBandwidth::info();
    info.option = "first-order";
    info.forms.clear();
    info.pairs.clear();  // ForceBandwidth states them for both
    info.statement = "the force sensor or its amplifier follows friction late, as an RC filter does";
    info.equation = "tau dy/dt + y = mu, tau = 1/(2 pi f_0)";
    info.source = "first-order low-pass, textbook";
    info.parameters.pop_back();  // the damping ratio
    info.sketch.values.pop_back();
    return info;
  }

  static FoundBeforeFit found_before_fit(const Motion& motion, const Estimate& /*load_coupling*/) {
    const Estimate& tau = motion.friction_low_pass;
    if (!tau.any()) return {};
    const double corner = 1 / (2 * std::numbers::pi * tau.value);
    return {.values = {{corner, corner * tau.std_error / tau.value}},
            .reason = "the reading of friction decays at re-stick; each law was filtered the same way"};
  }

  static double friction_low_pass(const double* p) { return p[0]; }
};

}  // namespace tribofit
