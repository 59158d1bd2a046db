#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "high_pass.hpp"
#include "lost_samples.hpp"
#include "low_pass.hpp"
#include "plateau.hpp"
#include "plateau_search.hpp"
#include "recording_faults.hpp"
#include "ripple.hpp"
#include "saturation.hpp"
#include "spoilt_samples.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// Samples that lie in runs of identical values at an end of a channel's range.
struct EndRuns {
  double at = 0;          ///< the end, in the channel's unit as recorded
  bool is_far = false;    ///< no other value is further from zero
  std::size_t count = 0;  ///< samples in runs of at least three; 0 where the channel repeats at other values too
  std::vector<SampleSpan> spans;  ///< those runs
  Saturation saturation;          ///< the same with noise on it
};

/// Both ends of both channels as recorded.
struct RangeEnds {
  std::array<EndRuns, 2> friction, velocity;
  double largest_velocity = 0;                  ///< [m/s]
  double friction_slew = 0, velocity_slew = 0;  ///< largest change in a sample, where changes gather at it; 0: none
};
RangeEnds range_ends(const Trace& trace, const ChannelOutlines& channels, int threads);

/// Where the velocity rests in stick, as recorded.
struct Resting {
  std::optional<LevelRange> plateau;  ///< one level, or those of a disc whose speed varies [m/s]
  bool sticks = false;                ///< v_b of a block that sticks and slips: nothing else holds it at a limit
};

/// A converter or an amplifier at its limit. A record without noise repeats its plateau, and that is no clipping. Nor
/// is a lowest friction that is above zero. Adds the samples to those that are not used. step: sampling interval [s].
HealthItem check_clipping(const RangeEnds& ends, const Trace& trace, const Instruments& instruments,
                          const Resting& resting, double step, SpoiltSamples& spoilt);

/// Gaps in time, what was spoilt, and stretches in which both channels stand still.
/// plateaus: of stick; step: sampling interval [s].
HealthItem check_drop_outs(const Trace& trace, const SpoiltSamples& spoilt, const LostSamples& lost,
                           std::size_t plateaus, double step);

/// What became of the high-pass search. `declared` is the declared corner, if any.
HealthItem check_sagging(const HighPassEstimate& estimate, std::optional<double> declared, bool undone, bool sticks);

/// Frequency up to which friction and velocity rise above their floor, and whether they are filtered above it.
/// velocity: where it was measured; restick: what it showed where it comes to rest.
HealthItem check_bandwidth(const Motion& motion, std::span<const double> velocity, const LowPass& restick);

/// Time between re-stick in the velocity and the jump of friction there, averaged over slips. `plateaus` are in blocks
/// of `factor` samples of `relative_velocity`.
HealthItem check_channel_delay(const Motion& motion, const Plateaus& plateaus, std::size_t factor);

/// Friction brakes what slides: where it is negative though its sign is right, its zero is wrong.
HealthItem check_friction_zero(const Motion& motion);

HealthItem check_revolutions(const Motion& motion);

/// What became of the search for a ripple of the disc's speed.
HealthItem check_speed_ripple(const Motion& motion, const RippleEstimate& estimate);

/// v_r as measured against rest in stick and, on average, omega r.
HealthItem check_measured_velocity(const Motion& motion, const Plateaus& plateaus, std::size_t factor);

HealthItem check_run_up(const Motion& motion, bool trim, std::size_t found);

/// Plateau of v_b against the stated omega r, or against the recorded one.
HealthItem check_plateau_speed(const Motion& motion, double plateau, bool speed_was_stated, bool radius_known,
                               const std::optional<RecordedPlateau>& recorded);

}  // namespace tribofit::kinematics
