#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

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
};

/// Markers first: what looks for frozen stretches does not see them, nor what looks for spikes either of these.
/// `beside`: another channel of the machine; where it moves at the same time, a lone sample is a slip of few samples.
ChannelFaults find_channel_faults(std::span<const double> channel, std::span<const double> beside);

/// Stretches that a velocity enters and leaves within a sample, to go on where it was, while friction stays: a laser
/// without a reflection (speckle, dust on the target).
std::vector<SampleSpan> find_excursions(std::span<const double> velocity, std::span<const double> friction);

/// Puts straight lines between good neighbours in the place of spans; at an end the good neighbour's value.
void bridge(const std::vector<SampleSpan>& spans, std::vector<double>& channel);

/// Whether the channel has noise above its steps: it turns again and again.
bool turns_often(std::span<const double> channel);

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
std::array<PileUp, 2> find_pile_ups(std::span<const double> channel);

/// The same of means over some dozen samples, where noise as wide as that of the channel hides the crowd; only what
/// stays at the limit for some of them in a row.
std::array<PileUp, 2> find_smoothed_pile_ups(std::span<const double> channel);

/// The largest change from one sample to the next, where changes crowd at it over many samples in a row: an amplifier
/// that follows no faster. 0: none. Of a record without ramps.
double find_slew_limit(std::span<const double> channel);

}  // namespace tribofit::kinematics
