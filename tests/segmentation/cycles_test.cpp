// Numbers of cycles, phases and per-cycle measures against simulated truth; odd records.
#include "tribofit/segmentation/cycles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../kinematics/stick_slip_truth.hpp"

namespace tribofit {
namespace {

Motion relative_motion(const std::vector<double>& v, double step, double noise = 0) {
  Motion motion;
  motion.step = step;
  motion.velocity_kind = VelocityKind::relative;
  motion.velocity_noise = noise;
  motion.relative_velocity = v;
  motion.friction.assign(v.size(), 0.3);
  for (std::size_t i = 0; i < v.size(); ++i) {
    motion.time.push_back(step * static_cast<double>(i));
    if (v[i] < 0) motion.friction[i] = -0.3;
  }
  motion.steps = {{0, v.size(), "", {}}};
  return motion;
}

void expect_ordered(const Segmentation& s, std::size_t n) {
  std::size_t at = 0;
  for (const Cycle& c : s.cycles) {
    EXPECT_LE(c.stick.begin, c.stick.end);
    EXPECT_LT(c.slip.begin, c.slip.end);
    if (c.stick.size() > 0) {
      EXPECT_GE(c.stick.begin, at);
      EXPECT_EQ(c.stick.end, c.slip.begin);
    }
    EXPECT_GE(c.slip.begin, at);
    at = c.slip.end;
  }
  EXPECT_LE(at, n);
}

TEST(Cycles, NoPhaseRunsAcrossAGap) {
  truth::Rig rig;
  rig.duration = 12;
  const truth::Run run = truth::simulate(rig);
  const Segmentation whole = find_cycles(compute_motion(run.trace));
  ASSERT_GT(whole.cycles.size(), 20u);
  const Cycle& torn = whole.cycles[10];
  // Half a second is lost from the middle of a stick, of a slip, and between the two.
  for (const std::size_t first :
       {torn.stick.begin + torn.stick.size() / 2, (torn.slip.begin + torn.slip.end) / 2, torn.slip.end + 1}) {
    Trace trace = run.trace;
    const auto begin = static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(0.5 * trace.rate());
    for (auto* channel : {&trace.time, &trace.friction, &trace.velocity}) {
      channel->erase(channel->begin() + begin, channel->begin() + end);
    }
    trace.steps = {{0, first, "", {}}, {first, trace.time.size(), "", {}}};
    const Segmentation s = find_cycles(compute_motion(std::move(trace)));
    for (const Cycle& c : s.cycles) {
      if (std::isfinite(c.break_away_friction)) {
        EXPECT_NEAR(c.break_away_friction, whole.cycles[10].break_away_friction, 0.02);
      }
      EXPECT_FALSE(c.stick_time > 1.2 * whole.stick_time.value) << c.stick_time;
      EXPECT_FALSE(c.slip_time > 1.2 * whole.slip_time.value) << c.slip_time;
      EXPECT_FALSE(c.period > 1.2 / whole.frequency.value) << c.period;
    }
  }
}

TEST(Cycles, CountsAndMeasuresOfATwin) {
  for (double rho : {0.0, 0.9}) {
    for (double scatter : {0.0, 0.004, 0.012}) {
      truth::Rig rig;
      rig.noise_correlation = rho;
      rig.scatter = scatter;
      rig.duration = 12;
      const truth::Run run = truth::simulate(rig);
      const Motion motion = compute_motion(run.trace);
      const Segmentation s = find_cycles(motion);
      SCOPED_TRACE(testing::Message() << "rho " << rho << " scatter " << scatter);
      EXPECT_EQ(s.kind, MotionKind::stick_slip);
      ASSERT_EQ(s.cycles.size(), run.break_away_time.size());
      expect_ordered(s, motion.size());
      EXPECT_FALSE(s.cycles.front().stick_complete);
      for (std::size_t k = 1; k + 1 < s.cycles.size(); ++k) {
        const Cycle& c = s.cycles[k];
        EXPECT_TRUE(c.stick_complete && c.slip_complete);
        EXPECT_NEAR(c.stick_time, run.break_away_time[k] - run.restick_time[k - 1], 4e-4);
        EXPECT_NEAR(c.slip_time, run.restick_time[k] - run.break_away_time[k], 4e-4);
        EXPECT_NEAR(c.period, run.break_away_time[k + 1] - run.break_away_time[k], 4e-4);
        EXPECT_GT(c.stick_maximum, c.break_away_friction - 0.002);  // an extreme of noisy samples is biased upwards
        EXPECT_LT(c.stick_maximum, c.break_away_friction + 0.015);
        EXPECT_NEAR(c.slip_minimum, rig.kinetic_friction, 0.02);
        EXPECT_NEAR(c.plateau_velocity, 0, 2e-5);
        EXPECT_NEAR(c.stick_slope / (rig.stiffness * rig.speed() * rig.radius / rig.load), 1, 0.06);
        EXPECT_EQ(c.direction, 1);
      }
      EXPECT_NEAR(s.amplitude.value, 0.0838, 0.002);
    }
  }
}

TEST(Cycles, FrequencyWithinItsInterval) {
  // Truth: the mean period of a run ten times as long.
  truth::Rig rig;
  rig.rate = 5000;
  rig.scatter = 0.006;
  rig.duration = 400;
  const truth::Run reference = truth::simulate(rig);
  const double truth_frequency = static_cast<double>(reference.break_away_time.size() - 1) /
                                 (reference.break_away_time.back() - reference.break_away_time.front());
  rig.duration = 20;
  int inside = 0;
  const int runs = 40;
  for (int k = 0; k < runs; ++k) {
    rig.seed = 100 + static_cast<unsigned>(k);
    const Segmentation s = find_cycles(compute_motion(truth::simulate(rig).trace));
    inside += std::abs(s.frequency.value - truth_frequency) < 1.96 * s.frequency.std_error ? 1 : 0;
  }
  EXPECT_GE(inside, 34);  // 95 % of 40 is 38; the reference has an error of its own
}

TEST(Cycles, WrongRadiusOrGainDoesNotBreakThem) {
  truth::Rig rig;
  const truth::Run run = truth::simulate(rig);
  for (double ratio : {0.85, 0.95, 1.06, 1.15}) {
    Trace trace = run.trace;
    trace.conditions.radius.value *= ratio;
    EXPECT_EQ(find_cycles(compute_motion(std::move(trace))).cycles.size(), run.break_away_time.size()) << ratio;
  }
}

TEST(Cycles, UnseenHighPassDoesNotBreakThem) {
  truth::Rig rig;
  const truth::Run run = truth::simulate(rig);
  for (double corner : {0.1, 0.5}) {
    Trace trace = run.trace;
    truth::high_pass(trace.velocity, corner, rig.rate);
    const Segmentation s = find_cycles(compute_motion(std::move(trace)));
    ASSERT_EQ(s.cycles.size(), run.break_away_time.size()) << corner;
    for (std::size_t k = 0; k < s.cycles.size(); ++k) {
      EXPECT_NEAR(s.cycles[k].break_away_time, run.break_away_time[k], 4e-4);
      EXPECT_NEAR(s.cycles[k].break_away_friction, run.break_away_friction[k], 2e-3);
    }
  }
}

TEST(Cycles, SlowAndFastDiscs) {
  for (double rpm : {0.5, 1.0, 16.0}) {
    truth::Rig rig;
    rig.rpm = rpm;
    rig.duration = rpm < 1 ? 20 : 6;
    const truth::Run run = truth::simulate(rig);
    EXPECT_EQ(find_cycles(compute_motion(run.trace)).cycles.size(), run.break_away_time.size()) << rpm;
  }
}

/// A run whose contact rings after each re-stick, with this part of the speed of a slip.
truth::Run ringing_run(double part) {
  truth::Rig rig;
  truth::Run run = truth::simulate(rig);
  std::size_t next = 0;
  const double disc = rig.speed() * rig.radius;
  for (std::size_t i = 0; i < run.trace.size(); ++i) {
    while (next < run.restick_time.size() && run.restick_time[next] < run.trace.time[i]) ++next;
    if (next == 0 || std::abs(run.trace.velocity[i] - disc) > 1.5e-4) continue;
    const double t = run.trace.time[i] - run.restick_time[next - 1];
    run.trace.velocity[i] += part * 0.08 * std::exp(-t / 0.01) * std::sin(2 * std::numbers::pi * 120 * t);
  }
  return run;
}

/// The samples of a trace from one time to another [s].
Trace part_of(const Trace& whole, double from, double to) {
  const auto sample = [&](double time) {
    return std::lower_bound(whole.time.begin(), whole.time.end(), time) - whole.time.begin();
  };
  Trace trace = whole;
  for (auto* channel : {&trace.time, &trace.velocity, &trace.friction})
    *channel = std::vector<double>(channel->begin() + sample(from), channel->begin() + sample(to));
  trace.steps = {{0, trace.size(), "", {}}};
  return trace;
}

TEST(Cycles, RingingAfterRestickIsChatterNotCycles) {
  const truth::Run run = ringing_run(0.1);
  EXPECT_EQ(find_cycles(compute_motion(run.trace)).cycles.size(), run.break_away_time.size());
}

/// Both lobes of the ringing, that against the slips and that along with them, rise above the threshold of a slip.
TEST(Cycles, RingingThatARecordBeginsOrEndsWithIsChatterToo) {
  const truth::Run run = ringing_run(0.15);
  const double quarter = 0.25 / 120;  // from the re-stick to the first peak of the ringing
  const std::size_t sticks = run.restick_time.size();
  for (const double beyond : {quarter, 3 * quarter}) {
    const double begin = run.restick_time.front() + beyond, end = run.restick_time[sticks - 2] + beyond;
    const Motion motion = compute_motion(part_of(run.trace, begin, end));
    const Segmentation s = find_cycles(motion);
    ASSERT_GT(std::abs(motion.relative_velocity.front()), s.slip_threshold);
    ASSERT_GT(std::abs(motion.relative_velocity.back()), s.slip_threshold);
    EXPECT_EQ(s.cycles.size(), sticks - 2) << beyond;
    for (const Cycle& cycle : s.cycles) EXPECT_EQ(cycle.direction, 1);
    EXPECT_GT(s.cycles.front().stick.begin, 0U);  // what is left out is no stick either
    EXPECT_FALSE(s.cycles.front().stick_complete || !s.cycles.back().slip_complete);
  }
}

TEST(Cycles, ARecordThatBeginsInSlipHasItUnlessItIsAlmostOver) {
  const truth::Run run = truth::simulate(truth::Rig{});
  const double restick = run.restick_time.front(), slip = restick - run.break_away_time.front();
  const auto begin_below = [&](double part) {  // of the peak of v_r, on the falling flank of the first slip
    Trace trace = part_of(run.trace, restick - 0.3 * slip, run.trace.time.back());
    const Motion motion = compute_motion(trace);
    std::size_t first = 0;
    while (motion.relative_velocity[first] > part * 0.084) ++first;
    return part_of(trace, trace.time[first], trace.time.back());
  };
  const Segmentation with = find_cycles(compute_motion(begin_below(0.4)));
  EXPECT_EQ(with.cycles.front().stick.size(), 0U);
  EXPECT_TRUE(with.cycles[1].stick_complete);
  const Motion motion = compute_motion(begin_below(0.1));
  const Segmentation without = find_cycles(motion);
  EXPECT_EQ(without.cycles.size() + 1, with.cycles.size());
  EXPECT_FALSE(without.cycles.front().stick_complete);
  EXPECT_NEAR(motion.time[without.cycles.front().stick.begin], restick, 2e-4);  // no moving sample in the stick
}

TEST(Cycles, ReversingDisc) {
  // Two strokes: the second mirrored. The disc's speed is a channel.
  truth::Rig rig;
  rig.duration = 4;
  truth::Run run = truth::simulate(rig);
  // End the stroke in stick.
  const auto n = static_cast<std::size_t>((run.restick_time.back() + 0.03) * rig.rate);
  run.break_away_time.resize(run.restick_time.size());
  for (auto* channel : {&run.trace.time, &run.trace.velocity, &run.trace.friction}) channel->resize(n);
  Trace trace = run.trace;
  trace.disc_speed.assign(n, rig.speed());
  for (std::size_t i = 0; i < n; ++i) {
    trace.time.push_back(static_cast<double>(n + i) / rig.rate);
    trace.velocity.push_back(-run.trace.velocity[i]);
    trace.friction.push_back(-run.trace.friction[i]);
    trace.disc_speed.push_back(-rig.speed());
  }
  trace.steps = {{0, 2 * n, "", {}}};
  const Segmentation s = find_cycles(compute_motion(std::move(trace)));
  EXPECT_EQ(s.kind, MotionKind::stick_slip);
  const auto forward = std::count_if(s.cycles.begin(), s.cycles.end(), [](const Cycle& c) { return c.direction > 0; });
  EXPECT_EQ(static_cast<std::size_t>(forward), run.break_away_time.size());
  EXPECT_EQ(s.cycles.size(), 2 * run.break_away_time.size());
  for (const Cycle& c : s.cycles) {
    EXPECT_GT(c.slip_minimum, 0.29);  // positive in either direction
    EXPECT_GT(c.peak_velocity, 0.05);
  }
}

TEST(Cycles, ReversalInTheMiddleOfASlipIsNoStick) {
  std::vector<double> v;
  for (int i = 0; i < 4000; ++i) v.push_back(0.1 * std::cos(2 * std::numbers::pi * i / 1000.0));
  const Segmentation s = find_cycles(relative_motion(v, 1e-3, 1e-5));
  EXPECT_EQ(s.kind, MotionKind::always_slipping);
  ASSERT_EQ(s.cycles.size(), 9u);
  for (std::size_t k = 0; k < s.cycles.size(); ++k) {
    EXPECT_EQ(s.cycles[k].direction, k % 2 == 0 ? 1 : -1);
    EXPECT_EQ(s.cycles[k].stick.size(), 0u);
    EXPECT_TRUE(std::isnan(s.cycles[k].break_away_time));
  }
  expect_ordered(s, v.size());
}

TEST(Cycles, ADwellBetweenStrokesIsAStick) {
  std::vector<double> v;
  for (int stroke = 0; stroke < 4; ++stroke) {
    for (int i = 0; i < 500; ++i) v.push_back((stroke % 2 == 0 ? 0.1 : -0.1) * std::sin(std::numbers::pi * i / 500.0));
    for (int i = 0; i < 500; ++i) v.push_back(0);
  }
  const Segmentation s = find_cycles(relative_motion(v, 1e-3));
  EXPECT_EQ(s.kind, MotionKind::stick_slip);
  ASSERT_EQ(s.cycles.size(), 4u);
  EXPECT_NEAR(s.cycles[1].stick_time, 0.5, 0.02);
}

TEST(Cycles, AlwaysSlippingIsOneSlipPerStep) {
  Motion motion = relative_motion(std::vector<double>(1000, 0.1), 0.1, 1e-4);
  motion.steps = {{0, 400, "a", {}}, {400, 1000, "b", {}}};
  const Segmentation s = find_cycles(motion);
  EXPECT_EQ(s.kind, MotionKind::always_slipping);
  ASSERT_EQ(s.cycles.size(), 2u);
  EXPECT_EQ(s.cycles[1].slip.begin, 400u);
  EXPECT_EQ(s.cycles[1].slip.end, 1000u);
  EXPECT_TRUE(std::isnan(s.frequency.value));
  ASSERT_FALSE(s.notes.empty());
}

TEST(Cycles, OddRecords) {
  EXPECT_EQ(find_cycles(Motion{}).kind, MotionKind::always_sticking);
  EXPECT_EQ(find_cycles(relative_motion({0, 0}, 1)).kind, MotionKind::always_sticking);
  EXPECT_EQ(find_cycles(relative_motion({0.1, 0.1}, 1)).kind, MotionKind::always_slipping);
  EXPECT_EQ(find_cycles(relative_motion(std::vector<double>(500, 0.0), 1, 1e-5)).kind, MotionKind::always_sticking);
  // One slip in the middle; one cut off at either end.
  std::vector<double> v(3000, 0.0);
  for (int i = 0; i < 300; ++i) v[static_cast<std::size_t>(1000 + i)] = 0.1 * std::sin(std::numbers::pi * i / 300.0);
  Segmentation s = find_cycles(relative_motion(v, 1e-3));
  ASSERT_EQ(s.cycles.size(), 1u);
  EXPECT_NEAR(s.cycles[0].slip_time, 0.3, 0.02);
  EXPECT_TRUE(std::isnan(s.frequency.value));
  v.erase(v.begin(), v.begin() + 1150);
  s = find_cycles(relative_motion(v, 1e-3));
  ASSERT_EQ(s.cycles.size(), 1u);
  EXPECT_EQ(s.cycles[0].stick.size(), 0u);
  EXPECT_TRUE(s.cycles[0].slip_complete);
  EXPECT_FALSE(s.notes.empty());
  for (std::size_t n = 1; n < 40; ++n) {
    std::vector<double> alternating(n);
    for (std::size_t i = 0; i < n; ++i) alternating[i] = i % 2 == 0 ? 0.1 : -0.1;
    expect_ordered(find_cycles(relative_motion(alternating, 1e-3)), n);
  }
}

TEST(Cycles, TwoSlipsAreFewerThanThreeCyclesAndSaid) {
  truth::Rig rig;
  rig.duration = 0.45;
  const truth::Run run = truth::simulate(rig);
  const Segmentation s = find_cycles(compute_motion(run.trace));
  EXPECT_EQ(s.cycles.size(), run.break_away_time.size());
  EXPECT_FALSE(s.notes.empty());
}

TEST(Cycles, PureStickNeverSlips) {
  for (bool stated : {true, false}) {
    Trace trace;
    const double radius = 0.015, speed = 4 * 2 * std::numbers::pi / 60;
    for (int i = 0; i < 4000; ++i) {
      trace.time.push_back(1e-3 * i);
      trace.velocity.push_back(6.283185e-3);
      trace.friction.push_back(0.3 + 1e-5 * i);
    }
    trace.steps = {{0, trace.size(), "", {}}};
    trace.conditions.radius = {radius, "command line"};
    if (stated) trace.conditions.speed = {speed, "command line"};
    const Segmentation s = find_cycles(compute_motion(std::move(trace)));
    EXPECT_EQ(s.kind, MotionKind::always_sticking);
    ASSERT_EQ(s.notes.size(), 1u);
    EXPECT_EQ(s.notes[0], "the record never slips");
  }
}

TEST(Cycles, AFewSamplesAreNoError) {
  for (std::size_t n = 2; n <= 10; ++n) {
    Trace trace;
    for (std::size_t i = 0; i < n; ++i) {
      trace.time.push_back(1e-3 * static_cast<double>(i));
      trace.velocity.push_back(1e-3 * static_cast<double>((i * 7) % 5) - 1e-3);
      trace.friction.push_back(0.3);
    }
    trace.steps = {{0, n, "", {}}};
    trace.conditions.radius = {0.015, "command line"};
    expect_ordered(find_cycles(compute_motion(trace)), n);
    trace.velocity.assign(n, 0);
    expect_ordered(find_cycles(compute_motion(trace)), n);
  }
}

TEST(Cycles, AreFoundAtTwoToFourSamplesASlip) {
  for (double rate : {75.0, 100.0, 130.0}) {
    for (unsigned seed : {1u, 2u, 3u}) {
      truth::Rig rig;
      rig.rate = rate;
      rig.duration = 20;
      rig.scatter = 0.004;
      rig.seed = seed;
      const truth::Run run = truth::simulate(rig);
      const Segmentation segmentation = find_cycles(compute_motion(run.trace));
      EXPECT_EQ(segmentation.kind, MotionKind::stick_slip) << rate << " Hz, seed " << seed;
      EXPECT_NEAR(static_cast<double>(segmentation.cycles.size()), static_cast<double>(run.break_away_time.size()), 1)
          << rate << " Hz, seed " << seed;
    }
  }
}

TEST(Cycles, TooFewSamplesASlipAreSaid) {
  const auto notes_at = [](double rate) {
    truth::Rig rig;
    rig.rate = rate;
    rig.rpm = 1;
    rig.duration = 40;
    std::string all;
    for (const std::string& note : find_cycles(compute_motion(truth::simulate(rig).trace)).notes) all += note + "; ";
    return all;
  };
  EXPECT_NE(notes_at(100).find("too few for a curve"), std::string::npos) << notes_at(100);
  EXPECT_EQ(notes_at(5000).find("too few for a curve"), std::string::npos) << notes_at(5000);
}

}  // namespace
}  // namespace tribofit
