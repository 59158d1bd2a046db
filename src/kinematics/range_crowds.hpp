#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "channel_outline.hpp"
#include "recording_faults.hpp"

namespace tribofit::kinematics {

/// Samples that crowd at an end of a channel's range, closer than any turning point lets them: a converter or an
/// amplifier at its limit, with or without noise on it.
struct PileUp {
  double level = 0;               ///< middle of the crowd, in the channel's unit
  std::size_t count = 0;          ///< samples in it; 0: none
  double density = 0;             ///< over that of three such widths below it
  double from = 0, to = 0;        ///< what the crowd lies between
  bool is_quiet = false;          ///< the noise that the channel has elsewhere is not on it
  bool levels_off = false;        ///< see find_levelling()
  bool is_still = false;          ///< nor on the whole stretches, where what lies in the crowd was not picked for it
  std::vector<SampleSpan> spans;  ///< the stretches at the limit, with the samples between them; of a crowd that noise
                                  ///< explains, none
};

/// The stretches between two values, with the samples between them that noise took out.
std::vector<SampleSpan> spans_at_limit(std::span<const double> channel, double from, double to);

/// Lower and upper end.
std::array<PileUp, 2> find_pile_ups(const ChannelOutline& channel);

/// The same of means over some dozen samples, where noise as wide as that of the channel hides the crowd; only what
/// stays at the limit for some of them in a row.
std::array<PileUp, 2> find_smoothed_pile_ups(std::span<const double> channel);

/// The largest change from one sample to the next, where changes crowd at it over many samples in a row: an amplifier
/// that follows no faster. 0: none. Of a record without ramps.
double find_slew_limit(const ChannelOutline& channel);

}  // namespace tribofit::kinematics
