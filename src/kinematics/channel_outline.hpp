#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "statistics/reductions.hpp"

namespace tribofit::kinematics {

/// What a pass over a channel as recorded shows. Most questions about it are answered by this, or need to look at few
/// of its chunks only.
struct ChannelOutline {
  ChannelOutline() = default;
  /// `samples` must outlive it. Cost: one pass, and sorting some thousand values.
  explicit ChannelOutline(std::span<const double> samples);

  std::span<const double> x;
  Chunks values;                       ///< extremes of the samples
  Chunks changes;                      ///< of x[i + 1] - x[i], in the chunk of sample i
  std::vector<std::uint16_t> repeats;  ///< changes of zero in each chunk
  std::size_t turns = 0;               ///< samples that lie above both neighbours, or below
  Extremes usual;                      ///< where all but one value in a thousand lie at each end
  double step = 0;                     ///< find_resolution()

  std::size_t size() const { return x.size(); }
  double range() const { return values.whole.high - values.whole.low; }
  /// Whether the channel has noise above its steps: it turns again and again.
  bool turns_often() const;
};

/// Of both channels of a record.
struct ChannelOutlines {
  ChannelOutline friction, velocity;
};

}  // namespace tribofit::kinematics
