#pragma once

namespace tribofit {

/// Friction between break-away and the first value of a slip, which lies where v_r stands out of its noise.
///
/// The spring's pull outgrows friction in proportion to the time since break-away, so v_r grows with its square, and
/// friction, a straight line in a small v_r, with it. A straight line in time would read a delay of 1 ms as 1.02 ms
/// where v_r has noise of 0.2 mm/s. level: at break-away; first: of the first value; part: of the time between them.
template <class T>
T friction_of_onset(const T& level, const T& first, const T& part) {
  return level + (first - level) * part * part;
}

/// Pieces into which the onset is cut where straight lines are followed: the square is then known to 1 % of its size.
inline constexpr int kOnsetPieces = 5;

}  // namespace tribofit
