// Sums over the samples of a window, against a loop that takes one sample after the other.
#include "segmentation/growth_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace tribofit::segmentation {
namespace {

Window window_of(std::size_t samples, double excess) {
  Window w;
  w.excess = excess;
  w.pull = 1.2;
  w.squares.push_back(0);
  for (std::size_t i = 0; i < samples; ++i) {
    const auto t = static_cast<double>(i);
    w.v.push_back(1e-4 * t * t + 2e-3 * std::sin(5 * t));
    w.squares.push_back(w.squares.back() + w.v.back() * w.v.back());
  }
  w.crossing = static_cast<double>(samples);
  return w;
}

/// By the formulas of the growth: v = a (e^x - 1 - x) + b (e^x - 1) with x = lambda (t - t0).
Sums one_by_one(const Window& w, const Growth& common, double t0) {
  const Growth g = growth_in(w, common);
  const double by_gain = w.excess / (1 + common.gain * w.excess);
  Sums s;
  for (std::size_t i = 0; i < w.v.size(); ++i) {
    const double t = static_cast<double>(i), x = g.lambda * (t - t0);
    if (t < t0) {
      s.rss += w.v[i] * w.v[i];
      continue;
    }
    const double shape = std::expm1(x) - x, slope = g.a * std::expm1(x) + g.b * std::exp(x);
    const double r = w.v[i] - g.a * shape - g.b * std::expm1(x), d = -g.lambda * slope;
    const Eigen::Vector4d j(g.a * shape, x * slope, std::expm1(x), by_gain * (x * slope - 2 * g.a * shape));
    s.rss += r * r;
    s.h += d * d;
    s.g += d * r;
    s.mixed += d * j;
    s.shared += j * j.transpose();
    s.gradient += j * r;
  }
  return s;
}

TEST(GrowthSums, AreThoseOfOneSampleAfterTheOther) {
  const Growth growth{3e-3, 0.11, 2e-3, 0.4};
  for (const std::size_t samples : {0U, 1U, 3U, 4U, 5U, 8U, 41U}) {
    for (const double t0 : {-1.5, 0.0, 2.3, 4.0, 60.0}) {
      const Window w = window_of(samples, 0.2);
      const Sums found = sums_of(w, growth, t0), truth = one_by_one(w, growth, t0);
      const auto is_close = [&](double a, double b) { return std::abs(a - b) <= 1e-10 * (std::abs(b) + 1e-12); };
      EXPECT_TRUE(is_close(found.rss, truth.rss)) << samples << " from " << t0;
      EXPECT_TRUE(is_close(found.h, truth.h)) << samples << " from " << t0;
      EXPECT_LE((found.mixed - truth.mixed).norm(), 1e-10 * truth.mixed.norm()) << samples << " from " << t0;
      EXPECT_LE((found.shared - truth.shared).norm(), 1e-10 * truth.shared.norm()) << samples << " from " << t0;
      EXPECT_LE((found.gradient - truth.gradient).norm(), 1e-10 * truth.gradient.norm()) << samples << " from " << t0;
      EXPECT_LE(std::abs(found.g - truth.g), 1e-10 * std::abs(truth.g)) << samples << " from " << t0;
    }
  }
}

}  // namespace
}  // namespace tribofit::segmentation
