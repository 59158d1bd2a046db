#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>

#include "fit_steps.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

namespace {

/// Sum of squares with parameter k held at `value`, the others refitted from `p` (updated).
double profiled_squares(const ModelResiduals& residuals, const Bounds& bounds, std::size_t k, double value,
                        std::vector<double>& p) {
  Bounds held = bounds;
  p[k] = held.lower[k] = held.upper[k] = value;
  constexpr SolverOptions kSearch{.max_iterations = 50, .relative_step = 1e-9, .relative_cost = 1e-9, .careful = false};
  const Solution result = minimize(residuals, p, held.lower, held.upper, kSearch);
  p = result.p;
  return 2 * result.cost;
}

/// Where the profile has risen by `rise` on the side `direction`; the bound where it does not reach that.
double interval_end(const ModelResiduals& residuals, const Bounds& bounds, const std::vector<double>& best,
                    std::size_t k, double half_width, double rise, double direction) {
  const double base = residuals.white_squares(best.data());
  const double limit = (direction < 0 ? best[k] - bounds.lower[k] : bounds.upper[k] - best[k]) / half_width;
  // u: distance from the best value in half-widths of the symmetric interval
  const auto excess = [&](double u) {
    std::vector<double> p = best;
    return profiled_squares(residuals, bounds, k, best[k] + direction * u * half_width, p) - base - rise;
  };
  double inner = 0, inner_excess = -rise;
  for (double outer = std::min(1.0, limit);; outer = std::min(1.6 * outer, limit)) {
    const double outer_excess = excess(outer);
    if (outer_excess >= 0) {
      std::uintmax_t iterations = 15;
      const auto root = boost::math::tools::toms748_solve(excess, inner, outer, inner_excess, outer_excess,
                                                          boost::math::tools::eps_tolerance<double>(10), iterations);
      return best[k] + direction * 0.5 * (root.first + root.second) * half_width;
    }
    if (outer >= limit) return best[k] + direction * limit * half_width;
    inner = outer;
    inner_excess = outer_excess;
  }
}

/// The profile on both sides of the best value, each side from the inside outwards so that every refit begins at its
/// neighbour.
std::vector<ProfilePoint> profile_about(const ModelResiduals& residuals, const Bounds& bounds,
                                        const std::vector<double>& best, std::size_t k, double half_width,
                                        double rise) {
  constexpr int kSteps = 8;  // a side
  const double base = residuals.white_squares(best.data());
  std::vector<ProfilePoint> points = {{best[k], 0}};
  for (const int side : {-1, 1}) {
    std::vector<double> p = best;
    for (int i = 1; i <= kSteps; ++i) {
      const double value = best[k] + side * 2 * half_width * i / kSteps;
      if (value < bounds.lower[k] || value > bounds.upper[k]) break;
      points.push_back({value, (profiled_squares(residuals, bounds, k, value, p) - base) / rise});
    }
  }
  std::sort(points.begin(), points.end(),
            [](const ProfilePoint& a, const ProfilePoint& b) { return a.value < b.value; });
  return points;
}

}  // namespace

void open_whole_ranges(const ModelResiduals& residuals, const Bounds& bounds, const Eigen::MatrixXd& inverse_curvature,
                       Fit& fit) {
  constexpr double kFirstStep = 1e-3;  // of the range
  const std::vector<double> best = fit.values();
  const double t = t_quantile_95(fit.degrees_of_freedom);
  for (std::size_t k = 0; k < best.size(); ++k) {
    FitParameter& p = fit.parameters[k];
    const double lower = bounds.lower[k], upper = bounds.upper[k];
    const bool whole = p.determined && lower < upper && p.lower95 <= lower && p.upper95 >= upper;
    if (!whole) continue;
    const auto i = static_cast<Eigen::Index>(k);
    const double rise = std::pow(t * p.std_error, 2) / inverse_curvature(i, i);
    p.determined = false;
    p.std_error = p.upper95 = std::numeric_limits<double>::infinity();
    p.lower95 = -p.upper95;
    if (!std::isfinite(rise) || !(rise > 0)) continue;
    const double step = kFirstStep * (upper - lower);
    p.profile_lower95 = interval_end(residuals, bounds, best, k, step, rise, -1);
    p.profile_upper95 = interval_end(residuals, bounds, best, k, step, rise, +1);
  }
}

void add_profiles(const ModelResiduals& residuals, const Bounds& bounds, const Eigen::MatrixXd& inverse_curvature,
                  Fit& fit) {
  const std::vector<double> best = fit.values();
  for (std::size_t k = 0; k < best.size(); ++k) {
    FitParameter& parameter = fit.parameters[k];
    const auto i = static_cast<Eigen::Index>(k);
    const double half_width = parameter.upper95 - parameter.value;
    if (!(inverse_curvature(i, i) > 0) || !(half_width > 0)) continue;
    const double rise = half_width * half_width / inverse_curvature(i, i);
    parameter.profile_lower95 = interval_end(residuals, bounds, best, k, half_width, rise, -1);
    parameter.profile_upper95 = interval_end(residuals, bounds, best, k, half_width, rise, +1);
    parameter.profile = profile_about(residuals, bounds, best, k, half_width, rise);
  }
}

}  // namespace tribofit
