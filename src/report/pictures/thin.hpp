#pragma once

#include <cstddef>
#include <vector>

#include "report/pictures/canvas.hpp"

namespace tribofit {

/// Indices of the points to draw of a line without gaps, so that it stays within `tolerance` [mm] of all of them: what
/// is not distinguishable on paper is left out, and no peak is lost. Cost: n log n.
std::vector<std::size_t> thinned_line(const std::vector<Point>& points, double tolerance);

/// The same of points that are not joined: one of those within a square of side `cell` [mm].
std::vector<std::size_t> thinned_points(const std::vector<Point>& points, double cell);

}  // namespace tribofit
