#include "report/pictures/thin.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace tribofit {
namespace {

double distance_from(const Point& p, const Point& a, const Point& b) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const double t = square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

/// Of neighbours within one column of the paper the first, the lowest, the highest and the last: noise of many samples
/// a column looks the same, and the search below need not look at all of them.
std::vector<std::size_t> by_columns(const std::vector<Point>& points, double column) {
  std::vector<std::size_t> kept;
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin, low = begin, high = begin;
    const double at = std::floor(points[begin].x / column);
    for (; end < points.size() && std::floor(points[end].x / column) == at; ++end) {
      if (points[end].y < points[low].y) low = end;
      if (points[end].y > points[high].y) high = end;
    }
    for (const std::size_t k : std::set<std::size_t>{begin, low, high, end - 1}) kept.push_back(k);
    begin = end;
  }
  return kept;
}

}  // namespace

/// Douglas and Peucker 1973, with a stack of its own.
std::vector<std::size_t> thinned_line(const std::vector<Point>& points, double tolerance) {
  const std::vector<std::size_t> candidates = by_columns(points, tolerance);
  if (candidates.size() < 3) return candidates;
  std::vector<bool> keep(candidates.size(), false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> spans{{0, candidates.size() - 1}};
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    std::size_t farthest = first;
    double most = tolerance;
    for (std::size_t k = first + 1; k < last; ++k) {
      const double d = distance_from(points[candidates[k]], points[candidates[first]], points[candidates[last]]);
      if (d > most) {
        most = d;
        farthest = k;
      }
    }
    if (farthest == first) continue;
    keep[farthest] = true;
    spans.emplace_back(first, farthest);
    spans.emplace_back(farthest, last);
  }
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (keep[k]) out.push_back(candidates[k]);
  }
  return out;
}

std::vector<std::size_t> thinned_points(const std::vector<Point>& points, double cell) {
  std::set<std::pair<double, double>> taken;
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (taken.emplace(std::floor(points[k].x / cell), std::floor(points[k].y / cell)).second) out.push_back(k);
  }
  return out;
}

}  // namespace tribofit
