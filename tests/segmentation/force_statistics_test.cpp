#include "tribofit/segmentation/force_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace tribofit {
namespace {

struct Teeth {
  double peak = 12, peak_scatter = 0.3, drop = 4, drop_scatter = 0.2;  // N
  double rise = 20, fall_time = 0.02, noise = 0.02;                    ///< [N/s], [s], [N]
  double duration = 40, rate = 1000;                                   ///< [s], [Hz]
  double sign = 1;
};

struct Drawn {
  Motion motion;
  double peak = 0, drop = 0;
  std::size_t slips = 0;
};

/// Straight rises to a level, falls as half a cosine: peak, drop and period are known.
Drawn draw(const Teeth& teeth) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Drawn out;
  out.motion.kind = RecordKind::force_only;
  out.motion.step = 1 / teeth.rate;
  double level = teeth.peak - teeth.drop, peak = teeth.peak, drop = 0, since = -1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(teeth.duration * teeth.rate); ++i) {
    double force = level;
    if (since >= 0) {
      force = peak - 0.5 * drop * (1 - std::cos(std::numbers::pi * since / teeth.fall_time));
      since += out.motion.step;
      if (since > teeth.fall_time) {
        since = -1;
        level = peak - drop;
        peak = teeth.peak + teeth.peak_scatter * normal(random);
      }
    } else {
      level += teeth.rise * out.motion.step;
      if (level >= peak) {
        since = 0;
        drop = teeth.drop + teeth.drop_scatter * normal(random);
        out.peak += peak;
        out.drop += drop;
        ++out.slips;
      }
    }
    out.motion.time.push_back(static_cast<double>(i) * out.motion.step);
    out.motion.friction.push_back(teeth.sign * force + teeth.noise * normal(random));
    out.motion.relative_velocity.push_back(0);
  }
  out.peak /= static_cast<double>(out.slips);
  out.drop /= static_cast<double>(out.slips);
  return out;
}

TEST(ForceStatistics, SlipsAreCountedAndMeasured) {
  for (const double sign : {1.0, -1.0}) {
    for (const double noise : {0.0, 0.02, 0.1}) {
      const Teeth teeth{.noise = noise, .sign = sign};
      const Drawn drawn = draw(teeth);
      const ForceStatistics found = force_statistics(drawn.motion);
      EXPECT_NEAR(static_cast<double>(found.slips), static_cast<double>(drawn.slips), 1) << noise;
      EXPECT_NEAR(found.peak.mean.value, drawn.peak, 0.05 + 0.2 * noise) << noise;
      EXPECT_NEAR(found.drop.mean.value, drawn.drop, 0.05 + 0.2 * noise) << noise;
      EXPECT_NEAR(found.peak.scatter, teeth.peak_scatter, 0.07);
      EXPECT_NEAR(found.peak.mean.std_error, teeth.peak_scatter / std::sqrt(static_cast<double>(drawn.slips)), 0.02);
      EXPECT_NEAR(found.period.mean.value, teeth.duration / static_cast<double>(drawn.slips), 0.01);
      EXPECT_NEAR(found.slip_time.mean.value, teeth.fall_time, 0.004);
    }
  }
}

TEST(ForceStatistics, WhatOnlyWandersOrSwingsHasNoSlips) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Motion motion;
  motion.kind = RecordKind::force_only;
  motion.step = 1e-3;
  double wander = 0;
  for (std::size_t i = 0; i < 40000; ++i) {
    wander = 0.999 * wander + 0.01 * normal(random);
    motion.time.push_back(static_cast<double>(i) * motion.step);
    motion.friction.push_back(10 + wander + 0.02 * normal(random));
  }
  const ForceStatistics wandering = force_statistics(motion);
  EXPECT_EQ(wandering.slips, 0U);
  EXPECT_NEAR(wandering.whole.mean.value, 10, 4 * wandering.whole.mean.std_error);
  EXPECT_NEAR(wandering.whole.scatter, 0.22, 0.05);
  for (std::size_t i = 0; i < motion.friction.size(); ++i)
    motion.friction[i] = 10 + std::sin(0.02 * static_cast<double>(i));
  EXPECT_EQ(force_statistics(motion).slips, 0U);
  std::fill(motion.friction.begin(), motion.friction.end(), 10.0);
  EXPECT_EQ(force_statistics(motion).slips, 0U);
}

}  // namespace
}  // namespace tribofit
