#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "contact_apart.hpp"
#include "tribofit/fit/rate_state.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {

/// a = 0.010, b = 0.014, D_c = 10 um on a machine `times` as stiff as the critical one.
inline RateStateMachine machine_of(StateEvolution evolution, double times, double a = 0.010, double b = 0.014) {
  RateStateMachine m;
  m.evolution = evolution;
  m.parameters.a = a;
  m.parameters.b[0] = b;
  m.parameters.distance[0] = 10 * kMicrometre;
  m.parameters.stiffness = times * std::abs(critical_stiffness(a, b, 10 * kMicrometre));
  m.reference_speed = 1 * kMicrometre;
  return m;
}

/// 2 and 10 um/s in turn, over 120 and 400 um.
inline const std::vector<LoadPointPhase> kSteps = {{0, 2e-6}, {60, 10e-6}, {100, 2e-6}, {160, 10e-6}, {200, 2e-6}};

inline std::vector<double> times_until(double end, double rate) {
  std::vector<double> out;
  for (std::size_t i = 0; static_cast<double>(i) / rate < end; ++i) out.push_back(static_cast<double>(i) / rate);
  return out;
}

inline Motion motion_from(const RateStateMachine& machine, const std::vector<LoadPointPhase>& phases,
                          std::vector<double> times, double noise, double drift = 0, std::uint64_t seed = 1) {
  Motion motion;
  motion.time = std::move(times);
  motion.friction = apart::Contact(machine).friction(phases, motion.time);
  motion.relative_velocity.assign(motion.time.size(), 0.0);
  motion.load_point = phases;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < motion.size(); ++i)
    motion.friction[i] += noise * normal(generator) + drift * motion.time[i];
  return motion;
}

inline void expect_recovered(const RateStateFit& fit, const RateStateMachine& machine, double within,
                             double within_distance) {
  ASSERT_TRUE(fit.converged) << ::testing::PrintToString(fit.messages);
  const auto& p = machine.parameters;
  EXPECT_NEAR(fit.parameters[0].value / p.a, 1, within);
  EXPECT_NEAR(fit.parameters[1].value / p.b[0], 1, within);
  EXPECT_NEAR(fit.parameters[2].value / p.distance[0], 1, within_distance);
  EXPECT_NEAR(fit.parameters[3].value / p.stiffness, 1, within_distance);
}

inline RateStateOptions together() {
  RateStateOptions options;
  options.each_step = false;
  return options;
}

}  // namespace tribofit
