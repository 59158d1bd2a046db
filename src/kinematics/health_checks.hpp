#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "high_pass.hpp"
#include "plateau.hpp"
#include "reductions.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// Runs of identical samples at either end of a channel's range: a converter or an amplifier at its limit.
/// To be called on the channels as recorded.
HealthItem check_clipping(const Trace& trace, const Chunks& friction, const Chunks& velocity,
                          const Instruments& instruments);

/// Gaps in time and samples that stand alone far from both neighbours.
HealthItem check_drop_outs(const Trace& trace, const Chunks& friction, const Chunks& velocity);

/// What became of the high-pass search. `declared` is the declared corner, if any.
HealthItem check_sagging(const HighPassEstimate& estimate, std::optional<double> declared, bool undone, bool sticks);

/// Frequency up to which friction and velocity rise above their floor, and whether they are filtered above it.
HealthItem check_bandwidth(std::span<const double> friction, std::span<const double> velocity, double step);

/// Time between re-stick in the velocity and the jump of friction there, averaged over slips. `rests` are in blocks of
/// `factor` samples of `relative_velocity`.
HealthItem check_channel_delay(const Motion& motion, const Rests& rests, std::size_t factor);

HealthItem check_revolutions(const Motion& motion);

/// Plateau level over the disc angle: amplitude of its first two harmonics.
HealthItem check_speed_ripple(const Motion& motion, const Rests& rests, std::size_t factor);

HealthItem check_run_up(const Motion& motion, bool trim, std::size_t found);

/// Plateau of v_b against the stated omega r.
HealthItem check_plateau_speed(const Motion& motion, double plateau, bool speed_was_stated, bool radius_known);

}  // namespace tribofit::kinematics
