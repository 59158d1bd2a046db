#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "channel_samples.hpp"
#include "plateau_search.hpp"
#include "tribofit/ingest/instruments.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// Where the velocity rests in stick, as recorded.
struct Resting {
  std::optional<LevelRange> plateau;  ///< one level, or those of a disc whose speed varies [m/s]
  bool sticks = false;                ///< v_b of a block that sticks and slips: nothing else holds it at a limit
};

/// Samples that are missing though the clock does not show it: between two samples the velocity changes by more than
/// its innovations reach and than before and after, where no real motion jumps.
struct LostSamples {
  std::size_t jumps = 0;
  double fraction = 0;  ///< of the intervals in which the velocity changes fast enough to show it
  /// Too many for blows on the rig. plateaus: of stick.
  bool are_significant(std::size_t plateaus) const;
};

/// What the recorder did to the channels of a trace, and which samples are not used for it.
class RecordedSamples {
 public:
  /// Bridges outliers and held stretches of the trace, and looks for the ends of its channels.
  RecordedSamples(Trace& trace, int threads);

  /// Samples whose velocity is hardly known, or is smeared by a correction; they keep their values.
  void add_unsure(const std::vector<SampleSpan>& spans) { mark(spans, SampleFault::velocity); }
  /// A stretch in which the motion is not known.
  void add_unknown(const SampleSpan& span) { mark({span}, SampleFault::any); }
  /// A machine that stands still before, after or while it stick-slips. `plateau`: where v_b rests in stick [m/s].
  void add_standstill(const PlateauSearch& search, double plateau, const Trace& trace);
  /// Jumps from rest, or to it, are the rig's own where most sticks have one. Cost: one pass.
  void find_lost(const Trace& trace, const PlateauSearch& search, const Disc& disc);

  /// A converter or an amplifier at its limit; its samples are marked. What rests there is no clipping, nor is a lowest
  /// friction that is above zero.
  HealthItem check_clipping(const Trace& trace, const Instruments& instruments, const Resting& resting);
  /// Gaps in time, samples that are left out, lost, and stretches in which both channels stand still.
  HealthItem check_drop_outs(const Trace& trace, std::size_t plateaus) const;
  /// Steps of the converters. noise: of the velocity in stick [m/s].
  HealthItem check_resolution(FrictionKind kind, double noise) const;

  bool any() const { return !faults_.empty(); }
  const LostSamples& lost() const { return lost_; }
  /// Whether values are repeated at uneven places, as behind a running median.
  bool friction_repeats() const { return friction_repeats_; }
  bool velocity_repeats() const { return velocity_repeats_; }
  double velocity_step() const { return velocity_.step; }  ///< of its converter [m/s]
  bool velocity_is_slew_limited() const { return velocity_slew_ > 0; }
  /// Whether slips are cut off at an end of the velocity's range, which is no compression.
  bool clips_slips(const Plateaus& plateaus) const;
  std::vector<std::uint8_t> take() { return std::move(faults_); }  ///< as Motion::faults, of the trace's samples

 private:
  void leave_out(std::vector<double>& channel, ChannelSamples& found, const char* name, std::uint8_t kind);
  void mark(const std::vector<SampleSpan>& spans, std::uint8_t kinds);

  std::size_t size_, left_out_ = 0;
  ChannelSamples friction_, velocity_;            ///< as recorded; their samples are not read after construction
  double friction_slew_ = 0, velocity_slew_ = 0;  ///< in a sample
  Extremes friction_range_, velocity_range_;
  bool friction_repeats_ = false, velocity_repeats_ = false;
  SampleSpan still_;  ///< longest stretch in which neither channel changed
  LostSamples lost_;
  std::vector<std::uint8_t> faults_;
  std::vector<std::string> sentences_;  ///< what was found and left out
};

}  // namespace tribofit::kinematics
