#pragma once

#include <functional>
#include <span>

#include "tribofit/fit/identification.hpp"
#include "tribofit/study/twin.hpp"

namespace tribofit {

/// Refuses a trace that does not hold both stick and slip: there are no cycles to compare.
void require_stick_slip(Identification& trace);

/// Fits the bare laws of the options, then the laws with the effects of friction among them, and identifies the rig
/// beside the best of each. `out.trace` holds these best fits afterwards, and is refused where a rig is missing.
void fit_machines(const IdentifyOptions& options, TwinIdentification& out);

/// As the public one. measured_all: called once friction and v_r of the motion are not read any more.
Twin compare_twins(const Motion& motion, const Segmentation& segmentation, std::span<const Fit> fits,
                   std::span<const RigFit> rigs, const TwinOptions& options, const std::function<void()>& measured_all);

/// Simulates each of the fits on its rig and compares; on a trace that was refused, only says why. Where something was
/// simulated, the trace no longer holds friction and v_r.
void compare_machines(const IdentifyOptions& options, TwinOptions more, TwinIdentification& out);

}  // namespace tribofit
