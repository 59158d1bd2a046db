#pragma once

#include <string>
#include <vector>

#include "channel_samples.hpp"
#include "tribofit/ingest/trace.hpp"

namespace tribofit::kinematics {

/// A slider that a spring draws, of which only the pull F was recorded, is a block on a spring over a disc that runs at
/// the drive's speed V, seen from the driven end: v_b = (dF/dt)/k, v_r = V - v_b, and in stick v_b = V. The pull is
/// friction read by a sensor above the mass, so that friction = F + m a_b with a_b = (d^2F/dt^2)/k where the mass is
/// known, and `sensor-inertia` finds it where it is not.

/// Turns a trace of the pull of a spring into such a block, with the errors of its velocity and friction. Lone samples
/// of the pull are replaced; derivatives are taken over a twelfth of the natural period to either side (of the mass
/// where it is known, else as the fastest fall of the pull shows it). Throws InputError where stiffness, or a load that
/// the pull is given over, is not known.
void make_block_of_spring(Trace& trace, std::vector<std::string>& notes);

/// The lower quartile of standard errors, which is that of windows without a corner; 0 where none are known.
double usual_error(const std::vector<double>& errors);

/// Samples whose velocity (of a motion alone: whose friction, too) is far less well known than most, beside the corners
/// of break-away and re-stick, with those whose acceleration they spoil.
std::vector<SampleSpan> unsure_samples(const Trace& trace);

}  // namespace tribofit::kinematics
