#include "low_pass.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// v_r about one re-stick, every `stride`-th sample.
struct Restick {
  std::vector<double> velocity;
  double fall = 0;  ///< samples in which it falls from the highest to nothing
  double at = 0;    ///< where it does, roughly [samples]
};

struct Smallest {
  double squares = std::numeric_limits<double>::infinity(), slope = 0;
};

/// A filter of one parameter: time constant of an exponential, or width of a mean.
struct Filter {
  bool is_mean = false;
  double width = 0;
  /// Standard deviation of its impulse response, which a first-order low-pass has for its time constant.
  double spread() const { return is_mean ? width / std::sqrt(12.0) : width; }
};

/// Its responses to (-u)^n, u < 0, for n = 1, 2, 3. An exponential makes of it a polynomial of w = -u before, and
/// n! t^n exp(-u/t) after.
Eigen::Vector3d responses(const Filter& filter, double u, double t) {
  if (filter.is_mean && t > 0) {
    const double a = std::max(0.5 * t - u, 0.0), b = std::max(-0.5 * t - u, 0.0);
    const double a2 = a * a, b2 = b * b;
    return {(a2 - b2) / (2 * t), (a * a2 - b * b2) / (3 * t), (a2 * a2 - b2 * b2) / (4 * t)};
  }
  const double w = std::max(-u, 0.0), e = u > 0 ? (t > 0 ? std::exp(-u / t) : 0) : 1;
  return {w + t * e, w * w + 2 * t * w + 2 * t * t * e, w * w * w + 3 * t * w * w + 6 * t * t * w + 6 * t * t * t * e};
}

/// What is left of a re-stick at `at` behind a filter [samples].
Smallest fit_at(const Restick& restick, double at, const Filter& filter) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares = 0;
  const double scale = 1 / restick.fall;
  for (std::size_t i = 0; i < restick.velocity.size(); ++i) {
    const Eigen::Vector3d basis = responses(filter, (static_cast<double>(i) - at) * scale, filter.width * scale);
    const double y = restick.velocity[i];
    normal += basis * basis.transpose();
    right += basis * y;
    squares += y * y;
  }
  const Eigen::Vector3d c = normal.ldlt().solve(right);
  return {std::max(0.0, squares - c.dot(right)), c[0] * scale};
}

/// The best place.
Smallest fit(const Restick& restick, const Filter& filter) {
  Smallest best;
  double place = restick.at;
  const double from = restick.at - 3 * std::max(filter.width, 1.0) - 2, to = restick.at + 0.3 * restick.fall + 1.5;
  for (const double by : {0.5, 0.1, 0.02}) {
    const bool is_first = by == 0.5;
    const double low = is_first ? from : place - 5 * by, high = is_first ? to : place + 5 * by;
    for (double at = std::max(low, 3.0); at <= high; at += by) {
      const Smallest here = fit_at(restick, at, filter);
      if (here.squares < best.squares) best = here, place = at;
    }
  }
  return best;
}

std::vector<Restick> resticks(std::span<const double> v, double rest, double fastest) {
  const double high = kKinkFrom * fastest, low = kKinkDown * fastest;
  std::vector<Restick> all;
  for (std::size_t i = 0; i < v.size();) {
    while (i < v.size() && std::abs(v[i] - rest) < kKinkSlip * fastest) ++i;
    if (i == v.size()) break;
    const double sign = v[i] > rest ? 1 : -1;
    const auto reads = [&](std::size_t k) { return sign * (v[k] - rest); };
    while (i < v.size() && reads(i) >= high) ++i;
    const std::size_t begin = i - 1;
    std::size_t down = begin;
    while (down < v.size() && reads(down) > low) ++down;
    i = down;
    const std::size_t fall = down - begin, end = down + 2 * fall;
    if (fall < kKinkSamples || end >= v.size()) continue;
    const std::size_t stride = std::max<std::size_t>(1, fall / kKinkMost);
    Restick restick;
    std::vector<double> after;
    for (std::size_t k = end - fall / 2; k < end; ++k) after.push_back(reads(k));
    const double level = median(std::move(after));
    for (std::size_t k = begin; k < end; k += stride) restick.velocity.push_back(reads(k) - level);
    restick.fall = static_cast<double>(fall) / static_cast<double>(stride);
    restick.at = restick.fall;
    all.push_back(std::move(restick));
  }
  return all;
}

/// Every one of which a few dozen are left.
std::vector<Restick> some_of(std::vector<Restick> all) {
  std::vector<Restick> some;
  const std::size_t stride = std::max<std::size_t>(1, all.size() / kKinkSlips);
  for (std::size_t k = 0; k < all.size(); k += stride) some.push_back(std::move(all[k]));
  return some;
}

/// How far v_r goes beyond rest after re-stick.
double beyond_rest(const std::vector<Restick>& some) {
  std::vector<double> beyond;
  for (const Restick& restick : some) {
    beyond.push_back(-*std::min_element(restick.velocity.begin(), restick.velocity.end()));
  }
  return median(std::move(beyond));
}

/// Over re-sticks.
Smallest usual(const std::vector<Restick>& some, const Filter& filter) {
  std::vector<double> squares, slopes;
  for (const Restick& restick : some) {
    const Smallest best = fit(restick, filter);
    squares.push_back(best.squares / static_cast<double>(restick.velocity.size()));
    slopes.push_back(best.slope);
  }
  return {median(std::move(squares)), median(std::move(slopes))};
}

}  // namespace

double LowPass::corner() const {
  return tau > 0 ? 1 / (2 * std::numbers::pi * tau) : 0;
}

LowPass find_low_pass(std::span<const double> velocity, double rest, double noise, double step) {
  LowPass found;
  std::vector<double> size = thinned(velocity, std::size_t{1} << 15);
  for (double& v : size) v = std::abs(v - rest);
  if (size.empty()) return found;
  const double fastest = quantile(std::move(size), 0.999);
  if (!(fastest > 0)) return found;
  const std::vector<Restick> some = some_of(resticks(velocity, rest, fastest));
  if (some.size() < kFewestPeriods) return found;
  found.slips = some.size();
  std::vector<double> falls;
  for (const Restick& restick : some) falls.push_back(restick.fall);
  const double most = median(falls);
  const Smallest sharp = usual(some, {});
  Smallest best = sharp;
  Filter filter;
  for (const bool is_mean : {false, true}) {
    for (double t = kKinkFirst; t < (is_mean ? 2 : 1) * most; t *= kKinkNext) {
      const Smallest here = usual(some, {is_mean, t});
      if (here.squares < best.squares) best = here, filter = {is_mean, t};
    }
  }
  const double tau = filter.spread(), stride = std::max(1.0, std::floor(most / static_cast<double>(kKinkMost)));
  found.tau = tau * stride * step;
  found.at_restick = tau * std::abs(best.slope) / fastest;
  found.is_filter = tau > 0 && found.at_restick > kKinkSeen && sharp.squares > kKinkExplained * best.squares &&
                    best.squares < std::pow(kKinkLeft * found.at_restick * fastest, 2) &&
                    beyond_rest(some) < std::max(kKinkBeyond * found.at_restick * fastest, kKinkNoise * noise);
  return found;
}

}  // namespace tribofit::kinematics
