#pragma once

#include "report/pictures/canvas.hpp"

namespace tribofit {

/// The points to draw of a line without gaps, so that it stays within `tolerance` [mm] of all of them (Douglas and
/// Peucker 1973): what is not distinguishable on paper is left out, and no peak is lost. Cost: n log n.
Path thinned_line(const Path& points, double tolerance);

/// The same of points that are not joined: the first of those within a square of side `cell` [mm].
Path thinned_points(const Path& points, double cell);

}  // namespace tribofit
