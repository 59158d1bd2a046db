#include "low_pass.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "limits.hpp"
#include "resticks.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::kinematics {
namespace {

struct Smallest {
  double squares = std::numeric_limits<double>::infinity(), slope = 0;
  double at = 0;  ///< [samples]
};

enum class Response { first_order, second_order, mean };

/// A filter of one parameter: time constant of a first order, 1/(2 pi f) of a Butterworth filter of second order, or
/// width of a mean.
struct Filter {
  Response kind = Response::first_order;
  double width = 0;
  /// By how much it is late; of a mean, which is not, the standard deviation of its impulse response.
  double spread() const {
    switch (kind) {
      case Response::first_order:
        break;
      case Response::second_order:
        return std::numbers::sqrt2 * width;
      case Response::mean:
        return width / std::sqrt(12.0);
    }
    return width;
  }
};

/// A Butterworth filter of second order: its moments are sqrt(2) t, 2 t^2, 0, and what is left when the input rests
/// swings out at 1/(sqrt(2) t) with as much damping.
Eigen::Vector3d second_order_responses(double u, double t) {
  const double m1 = std::numbers::sqrt2 * t, m2 = 2 * t * t;
  if (u <= 0) return {m1 - u, u * u - 2 * u * m1 + m2, -u * u * u + 3 * u * u * m1 - 3 * u * m2};
  if (t == 0) return Eigen::Vector3d::Zero();
  const double x = u / m1, e = std::exp(-x), cosine = e * std::cos(x), sine = e * std::sin(x);
  const auto swing = [&](double value, double slope) { return value * cosine + (value + m1 * slope) * sine; };
  return {swing(m1, -1), swing(m2, -2 * m1), swing(0, -3 * m2)};
}

/// Its responses to (-u)^n, u < 0, for n = 1, 2, 3. An exponential makes of it a polynomial of w = -u before, and
/// n! t^n exp(-u/t) after.
Eigen::Vector3d responses(const Filter& filter, double u, double t) {
  if (filter.kind == Response::second_order) return second_order_responses(u, t);
  if (filter.kind == Response::mean && t > 0) {
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
  const double scale = 1 / restick.fall;
  // Without a filter nothing is left after it.
  const std::size_t size = restick.velocity.size(),
                    end = filter.width > 0 ? size : std::min(size, static_cast<std::size_t>(std::ceil(at)));
  for (std::size_t i = 0; i < end; ++i) {
    const Eigen::Vector3d basis = responses(filter, (static_cast<double>(i) - at) * scale, filter.width * scale);
    const double y = restick.velocity[i];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column <= row; ++column) normal(row, column) += basis[row] * basis[column];
      right[row] += basis[row] * y;
    }
  }
  const Eigen::Vector3d c = normal.ldlt().solve(right);  // of the lower triangle
  return {std::max(0.0, restick.squares - c.dot(right)), c[0] * scale, at};
}

/// The best place, to a hundredth of a sample. What a filter leaves changes over its width: a wide one is tried at
/// fewer places.
Smallest fit(const Restick& restick, const Filter& filter) {
  Smallest best;
  best.at = restick.at;
  const auto try_at = [&](double at) {
    const Smallest here = fit_at(restick, at, filter);
    if (here.squares < best.squares) best = here;
    return here.squares;
  };
  const double from = restick.at - 3 * std::max(filter.width, 1.0) - 2, to = restick.at + 0.3 * restick.fall + 1.5;
  const double by = std::max(0.5, filter.width / 6);
  for (double at = std::max(from, 3.0); at <= to; at += by) try_at(at);
  const double about = best.at;
  boost::math::tools::brent_find_minima([&](double beside) { return try_at(about + by * beside); },
                                        std::max(-1.0, (3 - about) / by), 1.0, kBitsOfSearch);
  return best;
}

/// What a decay from the first sample on leaves.
double left_by_decay(const std::vector<Restick>& some, double t) {
  std::vector<double> squares;
  for (const Restick& restick : some) {
    double products = 0, norm = 0, sum = 0;
    for (std::size_t i = 0; i < restick.velocity.size(); ++i) {
      const double e = std::exp(-static_cast<double>(i) / t), y = restick.velocity[i];
      products += e * y, norm += e * e, sum += y * y;
    }
    squares.push_back((sum - products * products / norm) / static_cast<double>(restick.velocity.size()));
  }
  return median(std::move(squares));
}

/// The same at the time constant that fits most: re-stick is before.
double left_by_decay(const std::vector<Restick>& some) {
  const double longest = 2 * static_cast<double>(some.front().velocity.size());
  double best = 1, least = std::numeric_limits<double>::infinity();
  for (double t = 1; t < longest; t *= kRestickNext) {
    if (const double left = left_by_decay(some, t); left < least) least = left, best = t;
  }
  const auto left = [&](double t) { return left_by_decay(some, t); };
  return boost::math::tools::brent_find_minima(left, best / kRestickNext, best * kRestickNext, kBitsOfSearch).second;
}

/// Over re-sticks.
Smallest usual(const std::vector<Restick>& some, const Filter& filter, int threads = 1) {
  std::vector<double> squares(some.size()), slopes(some.size()), places(some.size());
  run_tasks(some.size(), threads, [&](std::size_t k) {
    const Smallest best = fit(some[k], filter);
    places[k] = best.at;
    squares[k] = best.squares / static_cast<double>(some[k].velocity.size());
    slopes[k] = best.slope;
  });
  return {median(std::move(squares)), median(std::move(slopes)), median(std::move(places))};
}

/// Squares that a decay to a level leaves from `first` on, where the input rests.
double left_by_tail(const Restick& restick, std::size_t first, double t) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double squares = 0;
  for (std::size_t i = first; i < restick.velocity.size(); ++i) {
    const Eigen::Vector2d x(std::exp(-static_cast<double>(i - first) / t), 1);
    const double y = restick.velocity[i];
    normal += x * x.transpose();
    right += x * y;
    squares += y * y;
  }
  return squares - normal.ldlt().solve(right).dot(right);
}

/// The time constant of each re-stick [samples] by a cubic before it; of its tail alone, where it is long enough: that
/// needs no motion to be known.
struct Refined {
  double by_all = 0;
  std::optional<double> by_tail;
};

Refined refine(const Restick& restick, double about) {
  const auto least = [&](const auto& left) {
    return boost::math::tools::brent_find_minima(left, about / kRestickNext, about * kRestickNext, kBitsOfSearch).first;
  };
  Refined out{least([&](double t) { return fit(restick, {Response::first_order, t}).squares; }), {}};
  const double from = fit(restick, {Response::first_order, out.by_all}).at + kDecayAfter * about + 1;
  const auto first = static_cast<std::size_t>(std::ceil(std::max(0.0, from)));
  if (static_cast<double>(restick.velocity.size()) < static_cast<double>(first) + kDecayLasts * about) return out;
  out.by_tail = least([&](double t) { return left_by_tail(restick, first, t); });
  return out;
}

/// The usual one of some time constants [samples] and its error. model: of the motion that was assumed, over it.
Estimate usual_of(const std::vector<double>& taus, double model) {
  const double tau = median(taus), scatter = kSigmaPerMad * median_absolute_deviation(taus, tau);
  return {tau, std::hypot(scatter / std::sqrt(static_cast<double>(taus.size())), model * tau)};
}

/// The time constant that fits each re-stick best; about: of the usual one [samples].
void refine(const std::vector<Restick>& some, double about, double step, int threads, LowPass& found) {
  std::vector<Refined> refined(some.size());
  run_tasks(some.size(), threads, [&](std::size_t k) { refined[k] = refine(some[k], about); });
  std::vector<double> by_all, by_tail;
  for (std::size_t k = 0; k < some.size(); ++k) {
    const auto stride = static_cast<double>(some[k].stride);
    by_all.push_back(stride * refined[k].by_all);
    if (refined[k].by_tail) by_tail.push_back(stride * *refined[k].by_tail);
  }
  const Estimate all = usual_of(by_all, kRestickModel);
  const Estimate tail = by_tail.size() < kFewestPeriods ? all : usual_of(by_tail, kDecayModel);
  const Estimate& best = tail.std_error < all.std_error ? tail : all;
  found.tau = best.value * step;
  found.std_error = best.std_error * step;
}

}  // namespace

double LowPass::corner() const {
  return tau > 0 ? (is_second_order ? std::numbers::sqrt2 : 1) / (2 * std::numbers::pi * tau) : 0;
}

namespace {

/// What re-sticks show from a part of the fastest on. is_explained: there is a filter, or a corner leaves next to
/// nothing (is_sharp).
struct FilterFinding {
  LowPass found;
  bool is_explained = false, is_sharp = false;
};

/// Every filter that is tried where v_r falls over so many samples.
std::vector<Filter> filters_for(double fall) {
  std::vector<Filter> filters;
  for (const Response kind : {Response::first_order, Response::second_order, Response::mean}) {
    for (double t = kRestickFirst; t < (kind == Response::mean ? 2 : 1) * fall; t *= kRestickNext)
      filters.push_back({kind, t});
  }
  return filters;
}

/// Those that may be the best: most leave far more, which few re-sticks show.
std::vector<Filter> filters_worth(const std::vector<Restick>& some, const std::vector<Filter>& all, int threads) {
  const std::vector<Restick> few = some_of(some, kRestickFew);
  std::vector<double> left(all.size());
  run_tasks(all.size(), threads, [&](std::size_t k) { left[k] = usual(few, all[k]).squares; });
  const double least = left.empty() ? 0 : *std::min_element(left.begin(), left.end());
  std::vector<Filter> worth;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (left[k] <= kRestickRival * least) worth.push_back(all[k]);
  }
  return worth;
}

/// Velocity about which re-sticks are looked at, and what is known of it.
struct RestickData {
  std::span<const double> velocity;
  double rest = 0, noise = 0, step = 0, fastest = 0;
  int threads = 1;
};

/// Where v_r comes to rest after each slip [samples], with the filter that was found.
std::vector<double> places_of(const std::vector<Restick>& all, const LowPass& found, const RestickData& at) {
  std::vector<double> places(all.size());
  run_tasks(all.size(), at.threads, [&](std::size_t k) {
    const auto stride = static_cast<double>(all[k].stride);
    const double width = found.is_first_order ? found.tau / (at.step * stride) : 0;
    places[k] = static_cast<double>(all[k].begin) + stride * fit(all[k], {Response::first_order, width}).at;
  });
  return places;
}

FilterFinding find_filter(const RestickData& at, double from, double shortest = kRestickRest) {
  const auto& [velocity, rest, noise, step, fastest, threads] = at;
  FilterFinding finding;
  LowPass& found = finding.found;
  const std::vector<Restick> all = find_resticks(velocity, rest, fastest, from, shortest),
                             some = some_of(all, kRestickSlips);
  if (some.size() < kFewestPeriods) return finding;
  found.slips = some.size();
  std::vector<double> falls;
  for (const Restick& restick : some) falls.push_back(restick.fall);
  const double most = median(falls);
  const Smallest sharp = usual(some, {}, threads);
  Smallest best = sharp;
  Filter filter;
  const std::vector<Filter> filters = filters_worth(some, filters_for(most), threads);
  std::vector<Smallest> behind(filters.size());
  run_tasks(filters.size(), threads, [&](std::size_t k) { behind[k] = usual(some, filters[k]); });
  for (std::size_t k = 0; k < filters.size(); ++k) {
    if (behind[k].squares < best.squares) best = behind[k], filter = filters[k];
  }
  if (sharp.squares > kRestickExplained * best.squares) {
    const auto left = [&](double width) { return usual(some, {filter.kind, width}, at.threads).squares; };
    const double lowest = filter.width / kRestickNext, highest = filter.width * kRestickNext;
    filter.width = boost::math::tools::brent_find_minima(left, lowest, highest, kBitsOfSearch).first;
    best = usual(some, filter, threads);
  }
  double decay = 0;
  run_tasks(2, threads, [&](std::size_t k) {
    if (k == 0) {
      decay = left_by_decay(some);
    } else {
      found.rise = rise_in_stick(at.velocity, at.rest, at.fastest) / at.fastest;
    }
  });
  const double tau = filter.spread(), stride = std::max(1.0, std::floor(most / static_cast<double>(kRestickMost)));
  found.tau = tau * stride * step;
  found.at_restick = tau * std::abs(best.slope) / fastest;
  const bool is_inside = decay > kRestickInside * best.squares, decays = sharp.squares > kRestickExplained * decay;
  if (!is_inside) found.at_restick = std::max(found.at_restick, from);
  const bool creeps = found.rise > kRestickCreeps * std::max(found.at_restick, kRestickSeen);
  // A second order goes beyond rest itself, by as much as it fits.
  const bool returns = filter.kind == Response::second_order ||
                       beyond_rest(some) < std::max(kRestickBeyond * found.at_restick * fastest, kRestickNoise * noise);
  found.is_filter =
      !creeps && tau > 0 && found.at_restick > kRestickSeen && sharp.squares > kRestickExplained * best.squares &&
      best.squares < std::pow(kRestickLeft * found.at_restick * fastest, 2) && (is_inside || decays) && returns;
  found.is_second_order = found.is_filter && filter.kind == Response::second_order;
  found.is_first_order = found.is_filter && filter.kind == Response::first_order && is_inside;
  if (found.is_first_order) refine(some, filter.width, step, threads, found);
  found.resticks = places_of(all, found, at);
  const double left = std::max(kRestickNoise * noise, kRestickUnexplained * fastest);
  finding.is_sharp = sharp.squares < left * left && sharp.slope * most > kRestickSteep * from * fastest;
  finding.is_explained = found.is_filter ? is_inside : finding.is_sharp;
  return finding;
}

}  // namespace

LowPass find_low_pass(std::span<const double> velocity, double rest, double noise, double step, int threads) {
  std::vector<double> size = thinned(velocity, std::size_t{1} << 15);
  for (double& v : size) v = std::abs(v - rest);
  const double fastest = size.empty() ? 0 : quantile(std::move(size), 0.999);
  if (!(fastest > 0)) return {};
  const RestickData at{velocity, rest, noise, step, fastest, threads};
  FilterFinding finding = find_filter(at, kRestickFrom);
  // Behind short sticks only the last of the slip shows it.
  if (finding.found.slips == 0) {
    // A fast slip is no cubic there, which a filter imitates: only that there is none is seen.
    const FilterFinding last = find_filter(at, kRestickFromShort, kRestickRestShort);
    if (last.is_sharp) finding.found = last.found;
    finding.found.is_filter = finding.found.is_first_order = false;
    return finding.found;
  }
  if (finding.is_explained) return finding.found;
  // Behind a slow filter the corner is higher up.
  FilterFinding higher = find_filter(at, kRestickFromSlow);
  return higher.found.is_filter ? higher.found : finding.found;
}

}  // namespace tribofit::kinematics
