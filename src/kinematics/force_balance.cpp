#include "force_balance.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>

#include "limits.hpp"
#include "statistics/reductions.hpp"

namespace tribofit::kinematics {

std::vector<BlockMotion> block_motion(const TimedChannel& velocity, std::size_t half) {
  const auto& [time, v] = velocity;
  const std::size_t n = v.size();
  const double mean = mean_of(v);
  std::vector<BlockMotion> motion(n);
  double x = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) x += (0.5 * (v[i] + v[i - 1]) - mean) * (time[i] - time[i - 1]);
    const std::size_t reach = std::min({half, i, n - 1 - i});
    double sum = v[i], slope = 0, squares = 0;
    for (std::size_t k = 1; k <= reach; ++k) {
      const double beside = time[i + k] - time[i - k];
      sum += v[i + k] + v[i - k];
      slope += beside * (v[i + k] - v[i - k]);
      squares += beside * beside;
    }
    motion[i] = {x, sum / static_cast<double>(2 * reach + 1) - mean, squares > 0 ? slope / squares : 0};
  }
  double mean_x = 0;
  for (const BlockMotion& m : motion) mean_x += m[0] / static_cast<double>(n);
  for (BlockMotion& m : motion) m[0] -= mean_x;
  return motion;
}

std::size_t ForceBalance::sample_at(double t) const {
  const auto at = std::lower_bound(friction_.time.begin(), friction_.time.end(), t);
  return static_cast<std::size_t>(at - friction_.time.begin());
}

double ForceBalance::operator()(const ClockLine& clock, std::size_t begin, std::size_t end) const {
  const std::vector<double>& time = velocity_.time;
  // From the middle of the stretch, so that the sums do not cancel.
  if (end <= begin + kFewestBalanced) return 1;
  const double centre = 0.5 * (friction_.time[begin] + friction_.time[end - 1]), level = friction_.value[begin];
  constexpr std::size_t size = 6;
  std::array<std::array<double, size>, size> sums{};
  std::size_t k = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const double t = friction_.time[i] - clock.at(friction_.time[i]);
    if (t < time.front() || t >= time.back()) continue;
    if (k == 0) k = static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), t) - time.begin()) - 1;
    while (time[k + 1] <= t) ++k;
    const double part = (t - time[k]) / (time[k + 1] - time[k]);
    const BlockMotion &from = motion_[k], &to = motion_[k + 1];
    const std::array<double, size> row = {1,
                                          friction_.time[i] - centre,
                                          from[0] + part * (to[0] - from[0]),
                                          from[1] + part * (to[1] - from[1]),
                                          from[2] + part * (to[2] - from[2]),
                                          friction_.value[i] - level};
    for (std::size_t a = 0; a < size; ++a) {
      for (std::size_t b = a; b < size; ++b) sums[a][b] += row[a] * row[b];
    }
  }
  if (sums[0][0] < static_cast<double>(kFewestBalanced)) return 1;
  return part_left(sums, 2);
}

double ForceBalance::minimise(const ClockLine& clock, double reach, double step, double tolerance, std::size_t begin,
                              std::size_t end) const {
  const auto cost = [&](double beside) {
    return (*this)({clock.offset + beside, clock.drift, clock.middle}, begin, end);
  };
  double best = 0, least = std::numeric_limits<double>::infinity();
  const double steps = std::ceil(reach / step);
  for (double k = -steps; k <= steps; ++k) {
    if (const double c = cost(k * step); c < least) least = c, best = k * step;
  }
  const int bits = std::max(1, 1 - std::ilogb(tolerance / step));
  const auto cost_beside = [&](double steps_beside) { return cost(best + step * steps_beside); };
  return best + step * boost::math::tools::brent_find_minima(cost_beside, -1.0, 1.0, bits).first;
}

}  // namespace tribofit::kinematics
