#include "change_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "tribofit/statistics/change_point.hpp"

namespace tribofit {

namespace {

/// Squares of every slip at p, whitened as the residuals are.
std::vector<double> squares_at(const ModelResiduals& residuals, const std::vector<double>& p) {
  const std::size_t slips = residuals.slips().size();
  const std::size_t rows = slips > 0 ? residuals.count() / slips : 0;
  std::vector<double> rest(residuals.count()), out(slips);
  if (!residuals.evaluate(p.data(), rest.data(), nullptr)) return {};
  for (std::size_t i = 0; i < rest.size(); ++i) out[i / rows] += rest[i] * rest[i];
  return out;
}

double sum_at(const ModelResiduals& residuals, std::vector<double>& p, std::size_t index, double value) {
  p[index] = value;
  const std::vector<double> squares = squares_at(residuals, p);
  if (squares.empty()) return std::numeric_limits<double>::infinity();
  return std::accumulate(squares.begin(), squares.end(), 0.0);
}

/// Slips in order of time, and what all of them leave when the change comes just before each, or after the last.
struct Scan {
  std::vector<double> begin, end;  ///< of each slip [s]
  std::vector<double> squares;     ///< one more than slips
};

Scan scan_of(const ChangePoint& point, const ModelResiduals& residuals, const Observations& observations,
             std::vector<double> p) {
  constexpr double kFar = 1e6;  // [s], far from any record
  Scan out;
  p[point.time] = kFar;
  const std::vector<double> before = squares_at(residuals, p);
  p[point.time] = -kFar;
  const std::vector<double> after = squares_at(residuals, p);
  if (before.empty() || after.empty()) return out;
  const auto& slips = observations.slips;
  std::vector<std::size_t> order(slips.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return observations.time[slips[a].begin] < observations.time[slips[b].begin];
  });
  std::vector<double> sorted_before, sorted_after;
  for (const std::size_t k : order) {
    out.begin.push_back(observations.time[slips[k].begin]);
    out.end.push_back(observations.time[slips[k].end - 1]);
    sorted_before.push_back(before[k]);
    sorted_after.push_back(after[k]);
  }
  out.squares = squares_by_change(sorted_before, sorted_after);
  return out;
}

}  // namespace

std::optional<ChangePoint> change_point_of(const FrictionModel& model) {
  const auto& parameters = model.parameters();
  for (std::size_t k = 1; k < parameters.size(); ++k) {
    if (parameters[k].parameter.search == ParameterSearch::moment_of_change) return ChangePoint{k, k - 1};
  }
  return std::nullopt;
}

double best_change(const ChangePoint& point, const ModelResiduals& residuals, const Observations& observations,
                   const Bounds& bounds, std::vector<double> p) {
  const double now = p[point.time], lower = bounds.lower[point.time], upper = bounds.upper[point.time];
  if (!(lower < upper)) return now;
  const Scan scan = scan_of(point, residuals, observations, p);
  if (scan.begin.size() < 2) return now;
  // Not before the first slip nor after the last: that is no change.
  const auto least = std::min_element(scan.squares.begin() + 1, scan.squares.end() - 1);
  const auto k = static_cast<std::size_t>(least - scan.squares.begin());  // before slip k
  const auto left = [&](double time) { return sum_at(residuals, p, point.time, time); };
  double best = std::clamp(0.5 * (scan.end[k - 1] + scan.begin[k]), lower, upper), best_squares = left(best);
  const auto try_time = [&](double time) {
    if (time < lower || time > upper) return;
    const double squares = left(time);
    if (!(squares < best_squares)) return;
    best = time;
    best_squares = squares;
  };
  try_time(now);
  constexpr int kParts = 8;
  double step = 0;
  for (const std::size_t slip : {k - 1, k}) {
    step = (scan.end[slip] - scan.begin[slip]) / kParts;
    for (int part = 0; part < kParts; ++part) try_time(scan.begin[slip] + (part + 0.5) * step);
  }
  for (int halving = 0; halving < 6; ++halving) {
    step /= 2;
    const double middle = best;
    try_time(middle - step);
    try_time(middle + step);
  }
  return best;
}

std::pair<double, double> interval_of_change(const ChangePoint& point, const ModelResiduals& residuals,
                                             const Observations& observations, const NormalEquations& equations,
                                             const Bounds& bounds, std::vector<double> p) {
  const double best = p[point.time];
  const auto size = static_cast<Eigen::Index>(point.size);
  double spread = 0, known = 0;
  for (std::size_t c = 0; c < equations.curvature.size(); ++c) {
    spread += std::pow(equations.gradient[c](size), 2);
    known += equations.curvature[c](size, size);
  }
  const Scan scan = scan_of(point, residuals, observations, p);
  double least = sum_at(residuals, p, point.time, best);
  for (std::size_t k = 1; k + 1 < scan.squares.size(); ++k) least = std::min(least, scan.squares[k]);
  const double limit = least + kChangePointRise95 * (known > 0 ? spread / known : 0);
  const auto inside = [&](double time) { return sum_at(residuals, p, point.time, time) < limit; };
  // Between the slip before which the change would leave too much and the next lies the wall.
  const auto wall = [&](double in, double out) {
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (in + out);
      (inside(middle) ? in : out) = middle;
    }
    return out;
  };
  // The change may come just before any slip from `first` to `last`; or else within the slip that holds the best.
  const std::size_t slips = scan.begin.size();
  std::size_t first = 0, last = slips;
  while (first < slips && scan.squares[first] >= limit) ++first;
  while (last > 0 && scan.squares[last] >= limit) --last;
  std::size_t before = 0, after = slips;  // walls: slips that begin before, or end after all that is possible
  const double earliest = first < slips ? std::min(best, scan.begin[first]) : best;
  const double latest = last > 0 ? std::max(best, scan.end[last - 1]) : best;
  while (before < slips && scan.begin[before] < earliest) ++before;
  while (after > 0 && scan.end[after - 1] > latest) --after;
  const double lower = before > 0 ? wall(earliest, scan.begin[before - 1]) : bounds.lower[point.time];
  const double upper = after < slips ? wall(latest, scan.end[after]) : bounds.upper[point.time];
  return {lower, upper};
}

}  // namespace tribofit
