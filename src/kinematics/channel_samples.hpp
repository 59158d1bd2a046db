#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "statistics/reductions.hpp"

namespace tribofit::kinematics {

/// Samples [begin, end) of a channel.
struct SampleSpan {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

/// An end of a channel's range at which its samples are cut off (censored): they were at least there.
struct RangeEnd {
  double level = 0;               ///< in the channel's unit
  std::size_t count = 0;          ///< samples at the limit; 0: none is cut off
  bool is_quiet = false;          ///< the noise that the channel has elsewhere is not on them
  std::vector<SampleSpan> spans;  ///< the stretches there, with what noise takes below the limit between them
};

/// A channel as recorded, and which of its samples are no readings.
///
/// One law says what is possible: its innovations follow a t distribution whose scale and degrees of freedom are those
/// of the channel, so that noise with the tails of a laser has them here too. The reach is what that exceeds once in a
/// thousand records, but at most kMostReach times what one innovation in twenty exceeds.
struct ChannelSamples {
  std::span<const double> x;
  Extremes usual;                    ///< where all but one value in a thousand lie at each end
  double step = 0;                   ///< of its converter; 0: none shows
  double reach = 0;                  ///< of its innovations; infinite where there are too few to tell
  double repeats = 0;                ///< part of the samples, but for the ends of the range, that equal the one before
  bool is_noisy = false;             ///< it turns again and again, so that there is noise above its steps
  std::vector<SampleSpan> outliers;  ///< left and entered by jumps: markers, spikes, a laser without its reflection
  std::vector<SampleSpan> held;      ///< one value for longer than a coarse converter repeats one: a plug that is loose
  std::array<RangeEnd, 2> ends;      ///< lower and upper; found by find_ends()

  ChannelSamples() = default;
  /// x must outlive it. Cost: three passes, and sorting some thousand values.
  explicit ChannelSamples(std::span<const double> x);

  double range() const { return usual.high - usual.low; }
  /// Whether a value is far beyond all others: no channel of a machine goes there within a sample.
  bool is_beyond(double value) const;
};

/// How far a sample is off the cubic through two neighbours on either side, which follows the motion. 2 <= i < size
/// - 2.
inline double innovation(std::span<const double> x, std::size_t i) {
  return std::abs(x[i] - (4 * (x[i - 1] + x[i + 1]) - (x[i - 2] + x[i + 2])) / 6);
}

/// Of some samples, spread over the channel; not of those that repeat, as an encoder does at rest.
std::vector<double> innovations_of(std::span<const double> x);

/// Fills outliers and held. `beside`: the other channel of the machine. Where that moves too, a jump there and back is
/// a slip of few samples. rests_at_zero: a velocity that reads exactly zero at rest, as an encoder does.
void find_outliers_and_held(ChannelSamples& channel, const ChannelSamples& beside, bool rests_at_zero);

/// Fills ends: samples in runs at the very end of the range, and those that gather near it without their noise. A turn
/// (a parabola, or flatter) does neither. gathers: samples that merely gather count too, as in slips.
/// bridged: stretches that were filled in, ascending, which have no noise.
void find_ends(ChannelSamples& channel, bool gathers, const std::vector<SampleSpan>& bridged);

/// The upper (or lower) end of friction behind noise as wide as what is cut off: near it friction stops rising against
/// the displacement of the block that its spring pulls back, which at rest is a straight line for any law, however the
/// contact creeps. count = 0 where it goes on. velocity: of the block.
RangeEnd find_end_in_stick(const ChannelSamples& friction, std::span<const double> velocity, bool upper);

/// The largest change from one sample to the next, where changes gather at it for many samples in a row: an amplifier
/// that follows no faster. 0: none.
double find_slew_limit(const ChannelSamples& channel);

/// Samples in a row that a channel holds by chance less than once in a thousand records, where it repeats so often.
std::size_t longest_by_chance(double repeats, std::size_t samples);

/// Puts straight lines between good neighbours in the place of spans; at an end the good neighbour's value.
void bridge(const std::vector<SampleSpan>& spans, std::vector<double>& channel);

std::size_t samples_in(const std::vector<SampleSpan>& spans);

}  // namespace tribofit::kinematics
