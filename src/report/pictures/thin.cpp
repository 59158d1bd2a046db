#include <boost/geometry/algorithms/simplify.hpp>
#include <boost/geometry/geometries/register/linestring.hpp>
#include <boost/geometry/geometries/register/point.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cmath>
#include <set>
#include <utility>

#include "report/pictures/draw.hpp"

BOOST_GEOMETRY_REGISTER_POINT_2D(tribofit::Point, double, boost::geometry::cs::cartesian, x, y)
BOOST_GEOMETRY_REGISTER_LINESTRING(tribofit::Path)

namespace tribofit {

Path thinned_line(const Path& points, double tolerance) {
  Path out;
  boost::geometry::simplify(points, out, tolerance);
  return out;
}

Path thinned_points(const Path& points, double cell) {
  std::set<std::pair<double, double>> taken;
  Path out;
  for (const Point& p : points) {
    if (taken.emplace(std::floor(p.x / cell), std::floor(p.y / cell)).second) out.push_back(p);
  }
  return out;
}

}  // namespace tribofit
