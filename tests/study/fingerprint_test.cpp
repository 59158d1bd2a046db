/// Fingerprints show what the equation of their effect says.
#include "tribofit/study/fingerprint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace tribofit {
namespace {

TEST(Fingerprint, EveryEffectHasOneThatMoves) {
  for (const Effect& effect : effect_catalogue()) {
    const std::string key = describe(effect).key;
    const Fingerprint print = fingerprint(effect);
    ASSERT_FALSE(print.clouds.empty()) << key;
    EXPECT_LE(print.clouds.size(), 2u) << key;
    EXPECT_FALSE(print.conditions.empty()) << key;
    double low = 1e300, high = -1e300;
    for (const FingerprintCloud& cloud : print.clouds) {
      EXPECT_GE(cloud.x.size(), 7u) << key;
      ASSERT_EQ(cloud.x.size(), cloud.y.size()) << key;
      for (std::size_t i = 0; i < cloud.x.size(); ++i) {
        ASSERT_TRUE(std::isfinite(cloud.x[i]) && std::isfinite(cloud.y[i])) << key;
        low = std::min(low, cloud.y[i]);
        high = std::max(high, cloud.y[i]);
      }
    }
    EXPECT_GT(high - low, 1e-3 * print.y.si) << key;
  }
}

TEST(Fingerprint, FollowsTheEquation) {
  const Fingerprint coupling = fingerprint(make_effect("load-coupling"));  // kappa = 0.15
  for (std::size_t i = 0; i < coupling.clouds[0].x.size(); i += 100) {
    EXPECT_NEAR(coupling.clouds[0].y[i], 50 * (1 + 0.15 * coupling.clouds[0].x[i]), 1e-9);
  }
  const Fingerprint mass = fingerprint(make_effect("sensor-inertia"));  // 0.1 kg under 50 N
  for (std::size_t i = 0; i < mass.clouds[0].x.size(); i += 100) {
    EXPECT_NEAR(mass.clouds[0].y[i], -0.1 * mass.clouds[0].x[i] / 50, 1e-6);
  }
  const Fingerprint ripple = fingerprint(make_effect("speed-ripple"));  // A = 0.08, n = 2
  for (std::size_t i = 0; i < ripple.clouds[0].x.size(); i += 100) {
    const double angle = 2 * std::numbers::pi * ripple.clouds[0].x[i];
    EXPECT_NEAR(ripple.clouds[0].y[i], 4 * std::numbers::pi / 30 * 0.015 * (1 + 0.08 * std::cos(2 * angle)), 1e-9);
  }
}

}  // namespace
}  // namespace tribofit
