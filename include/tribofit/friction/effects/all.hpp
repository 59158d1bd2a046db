#pragma once

#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "tribofit/friction/effects/ageing.hpp"
#include "tribofit/friction/effects/asymmetry.hpp"
#include "tribofit/friction/effects/backlash.hpp"
#include "tribofit/friction/effects/bristle.hpp"
#include "tribofit/friction/effects/channel_delay.hpp"
#include "tribofit/friction/effects/contact_spin.hpp"
#include "tribofit/friction/effects/crosstalk.hpp"
#include "tribofit/friction/effects/disc_pattern.hpp"
#include "tribofit/friction/effects/drift.hpp"
#include "tribofit/friction/effects/force_bandwidth.hpp"
#include "tribofit/friction/effects/force_low_pass.hpp"
#include "tribofit/friction/effects/frictional_lag.hpp"
#include "tribofit/friction/effects/heating.hpp"
#include "tribofit/friction/effects/hysteresis.hpp"
#include "tribofit/friction/effects/interference.hpp"
#include "tribofit/friction/effects/load_coupling.hpp"
#include "tribofit/friction/effects/load_dependence.hpp"
#include "tribofit/friction/effects/motion_effects.hpp"
#include "tribofit/friction/effects/rate_state.hpp"
#include "tribofit/friction/effects/rate_state_healing.hpp"
#include "tribofit/friction/effects/reading_effects.hpp"
#include "tribofit/friction/effects/ringing.hpp"
#include "tribofit/friction/effects/run_in.hpp"
#include "tribofit/friction/effects/runout.hpp"
#include "tribofit/friction/effects/sensor_inertia.hpp"
#include "tribofit/friction/effects/sensor_offset.hpp"
#include "tribofit/friction/effects/step.hpp"
#include "tribofit/friction/effects/stribeck_exponent.hpp"
#include "tribofit/friction/effects/temperature_dependence.hpp"
#include "tribofit/friction/effects/viscous.hpp"
#include "tribofit/friction/effects/zero_drift.hpp"
#include "tribofit/friction/formula.hpp"

namespace tribofit {

/// The one list of effects: friction, rig, measurement, in the order in which they act; what acts in stick last of the
/// memories. The last four are not part of the catalogue: forms of others, and the user's own (see formula.hpp).
using EffectAlternatives =
    std::variant<Viscous, StribeckExponent, FrictionalLag, RateState, Bristle, ContactSpin, Ageing, Asymmetry,
                 Hysteresis, Heating, RunIn, Drift, StepChange, LoadDependence, TemperatureDependence, Runout,
                 DiscPattern, SpeedRipple, LoadCoupling, Ringing, Backlash, SensorInertia, SensorOffset, ZeroDrift,
                 Crosstalk, ForceBandwidth, ChannelDelay, RadiusOffset, VelocityGain, VelocityHighPass, VelocityOffset,
                 VelocityBandwidth, VelocityCompression, FrictionCompression, ClockDrift, Interference, ForceLowPass,
                 VelocityGainByDirection, RateStateHealing, Formula>;

/// One effect of the list. What it takes to copy, move and destroy thirty types is compiled once, in catalogue.cpp.
class Effect : public EffectAlternatives {
 public:
  using EffectAlternatives::EffectAlternatives;
  Effect(const Effect&);
  Effect(Effect&&) noexcept;
  Effect& operator=(const Effect&);
  Effect& operator=(Effect&&) noexcept;
  ~Effect();
};

/// Every effect of the catalogue, in its order.
std::span<const Effect> effect_catalogue();

/// What `effect` says about itself.
EffectInfo describe(const Effect& effect);

/// The effect of the catalogue that has a property, or that a value of the instruments declares.
const Effect& effect_with(bool EffectInfo::*property);
const Effect& effect_declared_by(InstrumentValue value);

/// It changes v_r and not mu: found and undone by kinematics/, without a term in a friction model.
bool is_kinematic(const Effect& effect);

/// Throws InputError when two of the effects are the same: one key twice, two formulas that say the same, or a formula
/// that has the name of an effect of the catalogue.
void refuse_same(std::span<const Effect> effects);

/// The effect of that name: a key, or KEY:FORM. Throws InputError that offers the nearest known name.
Effect make_effect(std::string_view name);

}  // namespace tribofit
