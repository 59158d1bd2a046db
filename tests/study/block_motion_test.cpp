// The displacement of a block from its velocity and friction, against the simulation that made the record.
#include "tribofit/study/block_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "machines.hpp"
#include "tribofit/oscillator/sensors.hpp"
#include "tribofit/oscillator/simulate.hpp"

namespace {

using namespace tribofit;

struct Recorded {
  SimulatedMotion truth;
  Motion motion;
  Segmentation cycles;
};

Recorded recorded(const Machine& machine) {
  SimulationOptions options{.duration = 3, .rate = 10000};
  options.settle = settling_time(machine.rig, machine.drive(), machine.parameters);
  options.scatter = {0.004, 0.3};
  Recorded out;
  out.truth = simulate(machine.rig, machine.drive(), machine.model, machine.parameters, options);
  Trace trace = record(out.truth, machine.model, machine.parameters, {}).trace;
  trace.conditions.radius = {machine.radius, "test"};
  trace.conditions.speed = {machine.speed, "test"};
  out.motion = compute_motion(std::move(trace), {}, {.trim = false, .undo_high_pass = false});
  out.cycles = find_cycles(out.motion);
  return out;
}

TEST(BlockMotion, DisplacementIsThatOfTheSimulation) {
  const Machine machine = tribofit::studies::published_machine();
  const Recorded one = recorded(machine);
  const BlockMotion block = block_motion(one.motion, one.cycles, machine.load / machine.rig.stiffness);
  ASSERT_EQ(block.cycles, 3u);
  ASSERT_GT(block.size(), 1000u);
  // The sample at which it begins: its velocity is that of the truth from there on.
  std::size_t begin = one.truth.size();
  for (std::size_t i = 0; i + block.size() <= one.truth.size() && begin == one.truth.size(); ++i) {
    const bool same = one.truth.velocity[i] == block.velocity[0] && one.truth.velocity[i + 50] == block.velocity[50];
    if (same) begin = i;
  }
  ASSERT_LT(begin + block.size(), one.truth.size() + 1);
  const double swing = 2 * machine.load * 0.2 / machine.rig.stiffness;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < block.size(); ++i) {
    EXPECT_NEAR(block.displacement[i], one.truth.displacement[begin + i], 0.01 * swing);
    wrong += block.sticks[i] != one.truth.sticks[begin + i];
  }
  EXPECT_LT(wrong, 30u);
  EXPECT_NEAR(block.disc_velocity, machine.disc_velocity(), 1e-9);
}

TEST(BlockMotion, IsEmptyWhereNoCyclesAreWhole) {
  const Machine machine = tribofit::studies::published_machine();
  const Recorded one = recorded(machine);
  EXPECT_EQ(block_motion(one.motion, one.cycles, 1, 1000).size(), 0u);
  Segmentation sliding = one.cycles;
  sliding.kind = MotionKind::always_slipping;
  EXPECT_EQ(block_motion(one.motion, sliding, 1).size(), 0u);
  EXPECT_EQ(block_motion(one.motion, {}, 1).size(), 0u);
}

}  // namespace
