#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "channel_outline.hpp"
#include "recording_faults.hpp"

namespace tribofit::kinematics {

/// Samples that gather at an end of a channel's range, closer than any turning point lets them: a converter or an
/// amplifier at its limit, with or without noise on it.
struct Saturation {
  double level = 0;           ///< middle of the dense part, in the channel's unit
  std::size_t count = 0;      ///< samples in it; 0: none
  double density = 0;         ///< over that of three such widths below it
  double from = 0, to = 0;    ///< what the dense part lies between
  bool is_quiet = false;      ///< the noise that the channel has elsewhere is not on it
  bool stops_rising = false;  ///< see find_saturation_in_stick()
  bool is_still = false;      ///< nor on the whole stretches, where what lies in the dense part was not picked for it
  std::vector<SampleSpan> spans;  ///< the stretches at the limit, with the samples between them; of a dense part that
                                  ///< noise explains, none
};

/// The stretches between two values, with the samples between them that noise took out.
std::vector<SampleSpan> spans_at_limit(std::span<const double> channel, double from, double to);

/// Lower and upper end.
std::array<Saturation, 2> find_saturation(const ChannelOutline& channel);

/// The same of means over some dozen samples, where noise as wide as that of the channel hides the dense part; only
/// what stays at the limit for some of them in a row.
std::array<Saturation, 2> find_saturation_behind_noise(std::span<const double> channel);

/// The largest change from one sample to the next, where changes gather at it over many samples in a row: an amplifier
/// that follows no faster. 0: none. Of a record without ramps.
double find_slew_limit(const ChannelOutline& channel);

/// Friction that is cut off behind noise as wide as what is cut: near the top of its range it stops rising against the
/// way of the block that its spring pulls back, which at rest is a straight line for any law, however the contact
/// creeps. count = 0 where it does not. velocity: of the block. upper: the end of the range.
Saturation find_saturation_in_stick(const ChannelOutline& friction, std::span<const double> velocity, bool upper);

}  // namespace tribofit::kinematics
