#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// The strokes of a record that moves back and forth.
struct Strokes {
  std::vector<double> distance;              ///< of every sample, slid since the last reversal [m]
  std::vector<std::vector<double>> earlier;  ///< of every cycle, the strokes that it remembers [m], see StrokeMemory
  double length = 0;                         ///< median of the strokes that begin and end within the record [m]

  /// The record reverses a few times.
  bool known() const { return !distance.empty(); }
};

/// Reversals from which a record shows what depends on the distance since: one stroke each way, and one more each way
/// that agrees with it or not.
inline constexpr std::size_t kFewestReversals = 4;

/// How often sliding reverses between two cycles.
std::size_t reversals_of(const Segmentation& segmentation);

/// Why a record that reverses so seldom shows nothing of it, as a clause.
std::string too_few_reversals(std::size_t reversals);

/// Strokes from the integral of v_r (0 in stick), which turns where the cycles change their direction. A turn by less
/// than noise of v_r adds up to is none. The stroke with which the record begins is taken to be as long as the others,
/// or longer where it is. Nothing where there are fewer than kFewestReversals.
Strokes strokes_of(const Motion& motion, const Segmentation& segmentation);

}  // namespace tribofit
