#include "growth_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limits.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit::segmentation {
namespace {

// The exponential runs by recurrence.
template <bool with_shared>
Sums sums_at(const Window& w, const Growth& growth, double t0) {
  Sums s;
  const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(t0)));
  s.rss = w.squares[std::min(first, w.v.size())];
  const double factor = std::exp(growth.lambda);
  double e = std::exp(growth.lambda * (static_cast<double>(first) - t0));
  for (std::size_t i = first; i < w.v.size(); ++i, e *= factor) {
    const double x = growth.lambda * (static_cast<double>(i) - t0);
    const double shape = e - 1 - x;
    const double r = w.v[i] - growth.a * shape - growth.b * (e - 1);
    const double slope = growth.a * (e - 1) + growth.b * e;  // dv/dx
    const double d = -growth.lambda * slope;                 // dv/dt0
    s.rss += r * r;
    s.h += d * d;
    s.g += d * r;
    if constexpr (with_shared) {
      const Eigen::Vector3d j(growth.a * shape, x * slope, e - 1);
      s.mixed += d * j;
      s.shared += j * j.transpose();
      s.gradient += j * r;
    }
  }
  return s;
}

}  // namespace

Sums sums_of(const Window& window, const Growth& growth, double t0) {
  return sums_at<true>(window, growth, t0);
}

double fit_time(const Window& w, const Growth& growth, double start) {
  double t0 = std::clamp(start, -2.0, w.crossing);
  Sums here = sums_at<false>(w, growth, t0);
  for (int k = 0; k < 20 && here.h > 0; ++k) {
    double step = std::clamp(here.g / here.h, -5 / growth.lambda, 5 / growth.lambda);
    bool better = false;
    for (int half = 0; half < 6 && !better; ++half, step *= 0.5) {
      const double next = std::clamp(t0 + step, -2.0, w.crossing);
      const Sums there = sums_at<false>(w, growth, next);
      if (there.rss < here.rss) t0 = next, here = there, better = true;
    }
    if (!better || std::abs(step) < 1e-3) break;
  }
  return t0;
}

PooledFit fit_growth(std::vector<Window>& windows, Growth growth, bool with_jump) {
  PooledFit fit;
  fit.growth = growth;
  double damping = 1e-3;
  const auto total = [&](const Growth& g, const std::vector<double>& t0) {
    double rss = 0;
    for (std::size_t i = 0; i < windows.size(); ++i) rss += sums_at<false>(windows[i], g, t0[i]).rss;
    return rss;
  };
  std::vector<double> times;
  for (const Window& w : windows) times.push_back(w.t0), fit.samples += w.v.size();
  fit.rss = total(growth, times);
  for (int iteration = 0; iteration < 30; ++iteration) {
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    std::vector<Sums> all;
    for (std::size_t i = 0; i < windows.size(); ++i) {
      all.push_back(sums_at<true>(windows[i], fit.growth, times[i]));
      const Sums& s = all.back();
      hessian += s.shared;
      gradient += s.gradient;
      if (s.h <= 0) continue;
      hessian -= s.mixed * s.mixed.transpose() / s.h;
      gradient -= s.mixed * (s.g / s.h);
    }
    if (!with_jump) {
      hessian.row(2).setZero(), hessian.col(2).setZero();
      hessian(2, 2) = 1, gradient(2) = 0;
    }
    fit.information = hessian;
    bool better = false;
    double gain = 0;
    for (int attempt = 0; attempt < 8 && !better; ++attempt) {
      Eigen::Matrix3d damped = hessian;
      damped.diagonal() *= 1 + damping;
      const Eigen::Vector3d step = solve_symmetric(damped, gradient);
      Growth next = fit.growth;
      next.a *= std::exp(std::clamp(step(0), -1.0, 1.0));
      next.lambda *= std::exp(std::clamp(step(1), -0.5, 0.5));
      next.b = with_jump ? std::max(0.0, next.b + step(2)) : 0;
      std::vector<double> moved = times;
      for (std::size_t i = 0; i < windows.size(); ++i) {
        const Sums& s = all[i];
        if (s.h > 0) moved[i] += (s.g - s.mixed.dot(step)) / s.h;
        moved[i] = std::clamp(moved[i], -2.0, windows[i].crossing);
      }
      const double rss = std::isfinite(step.sum()) ? total(next, moved) : HUGE_VAL;
      if (rss < fit.rss) {
        gain = fit.rss - rss;
        fit.growth = next, fit.rss = rss, times = std::move(moved), better = true;
        damping = std::max(1e-6, damping * 0.2);
      } else {
        damping = std::min(1e6, 8 * (damping + 1e-4));
      }
    }
    if (!better || gain < 1e-7 * fit.rss) break;
  }
  for (std::size_t i = 0; i < windows.size(); ++i) windows[i].t0 = times[i];
  return fit;
}

Noise noise_of(const std::vector<Window>& windows, const Growth& growth) {
  Remainder all;
  for (const Window& w : windows) {
    Remainder left;
    for (std::size_t i = 0; i < w.v.size(); ++i) {
      const double t = static_cast<double>(i) - w.t0;
      const double x = t > 0 ? growth.lambda * t : 0;
      left.add(w.v[i] - growth.a * (std::expm1(x) - x) - growth.b * std::expm1(x));
    }
    all += left;
  }
  if (all.squares <= 0) return {};
  return {all.squares / all.count, variance_inflation(all.correlation(kMostCorrelation))};
}

}  // namespace tribofit::segmentation
