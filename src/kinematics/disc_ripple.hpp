#pragma once

#include <span>

#include "plateau_search.hpp"
#include "ripple.hpp"
#include "tribofit/ingest/trace.hpp"

namespace tribofit::kinematics {

/// The one stated speed of the whole record [rad/s], NaN where there are several or it was recorded.
double steady_speed(const Trace& trace);

/// A ripple of the disc's speed, looked for where v_b was measured against one steady speed. `stated`: that speed was
/// stated; else it was read off the plateau, and is read off again without the ripple, in `disc` and in the conditions
/// of `trace`.
RippleEstimate find_ripple(Trace& trace, const PlateauSearch& search, Disc& disc, bool stated);

/// Makes the blocks and plateaus those that a disc without the ripple would have shown.
void flatten(PlateauSearch& search, const RippleEstimate& ripple, double omega, std::span<const double> time);

/// Gives speed and angle of the disc, and omega r, the ripple.
void impose_ripple(Trace& trace, Disc& disc, const RippleEstimate& ripple, double omega);

}  // namespace tribofit::kinematics
