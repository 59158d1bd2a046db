#pragma once

#include <span>
#include <vector>

namespace tribofit {

/// A stretch of values that lie on a line.
struct LinePiece {
  double begin = 0;       ///< time at which it begins
  double slope = 0;       ///< of the line
  bool is_level = false;  ///< it goes nowhere, or next to it beside its neighbours
  bool on_ramp = false;   ///< the slope changes steadily, from one neighbour to the other, as far as noise lets see
};

/// The lines of which values over ascending times are made, each beginning where the one before it ends.
///
/// They are split where two lines leave least, until slopes differ by less than kLeastChangeOfSlope (on a ramp by
/// less than shows) or a corner is lost in the noise; a corner is then where the lines beside
/// it meet, which is closer than a sample. Cost: linear in values, times pieces.
std::vector<LinePiece> piecewise_lines(std::span<const double> time, std::span<const double> values);

}  // namespace tribofit
