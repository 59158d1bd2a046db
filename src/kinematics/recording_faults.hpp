#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "channel_outline.hpp"

namespace tribofit::kinematics {

/// Samples [begin, end) of a channel.
struct SampleSpan {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

/// What a recorder put in the place of a channel's values.
struct ChannelFaults {
  std::vector<SampleSpan> markers;  ///< values far beyond all others, entered and left in one sample
  std::vector<SampleSpan> spikes;   ///< lone samples far from both neighbours
  std::vector<SampleSpan> frozen;   ///< one value, again and again, of a channel that is never still (a loose plug: 0)
  std::vector<SampleSpan> excursions;  ///< stretches that a velocity enters and leaves within a sample

  bool any() const { return !(markers.empty() && spikes.empty() && frozen.empty() && excursions.empty()); }
};

/// Markers first: what looks for frozen stretches does not see them, nor what looks for spikes either of these.
/// `beside`: another channel of the machine; where it moves at the same time, a lone sample is a slip of few samples.
/// is_sliding_velocity: the channel is zero at rest.
ChannelFaults find_channel_faults(const ChannelOutline& channel, const ChannelOutline& beside,
                                  bool is_sliding_velocity);

/// Markers alone.
std::vector<SampleSpan> find_marker_values(std::span<const double> channel);

/// Stretches that a velocity enters and leaves within a sample, to go on where it was, while friction stays: a laser
/// without a reflection (speckle, dust on the target).
std::vector<SampleSpan> find_excursions(const ChannelOutline& velocity, const ChannelOutline& friction);

/// Puts straight lines between good neighbours in the place of spans; at an end the good neighbour's value.
void bridge(const std::vector<SampleSpan>& spans, std::vector<double>& channel);

/// What a sample is off the line between its neighbours.
inline double off_line(std::span<const double> x, std::size_t i) {
  return x[i] - 0.5 * (x[i - 1] + x[i + 1]);
}

}  // namespace tribofit::kinematics
