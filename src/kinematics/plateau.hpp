#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "statistics/reductions.hpp"

namespace tribofit::kinematics {

/// A stretch of blocks [begin, end) in which the velocity rests on a level.
struct StickPlateau {
  std::size_t begin = 0, end = 0;
  double level = 0;  ///< mean over the middle of the stretch [m/s]
  std::size_t size() const { return end - begin; }
  /// The middle of the stretch, where neither re-stick nor break-away disturbs.
  std::size_t inner_begin() const { return begin + size() / 5; }
  std::size_t inner_end() const { return end - size() / 5; }
};

/// All plateaus of a record.
struct Plateaus {
  std::vector<StickPlateau> runs;
  double level = 0;  ///< median over plateaus, weighted by their duration [m/s]
  double depth = 0;  ///< largest excursion from that level (one block in a thousand exceeds it) [m/s]
  bool empty() const { return runs.empty(); }
};

/// Where a level is looked for.
struct LevelRange {
  double low = 0, high = 0;
};

/// Finds the level on which the velocity rests most (half-sample mode) and the stretches that rest on it.
///
/// A stretch within 12 % of the largest excursion counts when it is flat: a turning point of a smooth oscillation is
/// a parabola whose middle stands out from its shoulders, a stick is not, whether it is noisy, rings or sags. Where
/// sticks are short beside the slips the band is narrowed, as far as the noise lets it.
/// reverses: of a velocity that may reverse, a stretch in which it passes from one side to the other is none.
/// Cost: n log n for at most 2^15 of the blocks, linear in the rest.
Plateaus find_plateaus(std::span<const double> velocity, std::optional<LevelRange> range = {}, bool reverses = false);

/// Standard deviation of the noise: the spread (not successive differences, which coloured noise would fool) about
/// parabolas through windows in the given stretches of samples, one value a window.
std::vector<double> spreads_about_parabolas(std::span<const double> signal, const std::vector<StickPlateau>& stretches,
                                            std::size_t factor);
/// The median of these; 0 where no stretch is long enough.
double spread_about_parabolas(std::span<const double> signal, const std::vector<StickPlateau>& stretches,
                              std::size_t factor);

}  // namespace tribofit::kinematics
