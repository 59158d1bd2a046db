#include "tribofit/friction/friction_curve.hpp"

#include <algorithm>
#include <cmath>

namespace tribofit {

FrictionCurve::Line FrictionCurve::line_over(const std::function<double(double)>& basis) const {
  double w = 0, s = 0, ss = 0, y = 0, ys = 0, yy = 0;
  for (const Bin& bin : bins) {
    const double x = basis(bin.speed);
    w += bin.weight;
    s += bin.weight * x;
    ss += bin.weight * x * x;
    y += bin.weight * bin.friction;
    ys += bin.weight * bin.friction * x;
    yy += bin.weight * bin.friction * bin.friction;
  }
  Line line;
  const double determinant = w * ss - s * s;
  if (determinant > 1e-12 * w * ss) {
    line.slope = (w * ys - s * y) / determinant;
    line.constant = (y - line.slope * s) / w;
  } else if (w > 0) {
    line.constant = y / w;
  }
  if (line.constant < 0 && ss > 0) line = {0, ys / ss, 0};
  const auto [k, d, unused] = line;
  line.cost = yy - 2 * (k * y + d * ys) + k * k * w + 2 * k * d * s + d * d * ss;
  return line;
}

FrictionCurve::Fall FrictionCurve::best_fall(const std::function<double(double)>& shape) const {
  const auto [slowest, fastest_fall] = resolved_steepness(fastest);
  constexpr int kGrid = 40;
  Fall best;
  double least = 0;
  for (int k = 0; k < kGrid; ++k) {
    const double steepness = slowest * std::pow(fastest_fall / slowest, k / (kGrid - 1.0));
    const Line line = line_over([&](double v) { return shape(steepness * v); });
    if (k > 0 && !(line.cost < least)) continue;
    least = line.cost;
    best = {line.constant + line.slope, line.constant, steepness};
  }
  return best;
}

std::array<double, 2> FrictionCurve::resolved_steepness(double fastest) {
  const double v = std::max(fastest, 1e-9);
  return {0.2 / v, 40 / v};
}

}  // namespace tribofit
