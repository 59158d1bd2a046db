#pragma once

#include <span>
#include <string>
#include <vector>

#include "tribofit/fit/identification.hpp"
#include "tribofit/friction/effects/all.hpp"

namespace tribofit {

/// The effects with a term in a friction model.
std::vector<Effect> friction_effects(std::span<const Effect> effects);
/// The effects of the motion, which are corrected before a law is fitted.
std::vector<Effect> kinematic_effects(std::span<const Effect> effects);

/// Motion options with the corrections that effects of the motion ask for.
MotionOptions with_corrections(MotionOptions options, std::span<const Effect> effects);

/// The options with which a record is analysed whose force sensor has a declared bandwidth: the filter stands in every
/// model, held at what was declared. To move the channel by the delay of the filter, which is else done, leaves what it
/// does to the jumps of break-away and re-stick, and that passes for a memory of the contact. Nothing changes where
/// the user has put the filter into the model, where its delay is shorter than a sample, and for records without slips
/// of their own (points, a load point driven in steps, a pull on a spring).
IdentifyOptions with_declared_filter(const IdentifyOptions& options, const Motion& motion);

/// Refuses a part of a trace without the channels that the effects need.
void require_channels(std::span<const Effect> effects, const Motion& motion, TracePart& part);

/// Refuses a trace on which one of the formulas among the effects cannot be fitted: it is not finite at its starting
/// values, or zero whatever its parameters are. Nothing is checked on a trace that has been refused already.
void require_formulas(std::span<const Effect> effects, const Motion& motion, TracePart& part);

}  // namespace tribofit
