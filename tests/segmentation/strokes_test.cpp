// Strokes of a motion back and forth, and which of them are remembered.
#include "tribofit/segmentation/strokes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "tribofit/segmentation/stroke_memory.hpp"

namespace tribofit {
namespace {

std::vector<double> remembered(const std::vector<double>& strokes) {
  StrokeMemory memory;
  for (const double length : strokes) memory.end_stroke(length);
  return {memory.lengths().begin(), memory.lengths().end()};
}

TEST(StrokeMemory, KeepsWhatIsNotClosed) {
  using Lengths = std::vector<double>;
  EXPECT_EQ(remembered({10}), Lengths({10}));
  EXPECT_EQ(remembered({10, 7, 3, 2}), Lengths({10, 7, 3, 2}));
  EXPECT_EQ(remembered({10, 10, 10}), Lengths({10}));            // the same loop again
  EXPECT_EQ(remembered({10, 7, 3, 5}), Lengths({10, 9}));        // 3 is closed, 7 goes on by 2
  EXPECT_EQ(remembered({10, 7, 12}), Lengths({20}));             // 15 from one end, about the same middle
  EXPECT_EQ(remembered({10, 9.9, 10, 9.9, 10}), Lengths({10}));  // a position that drifts
  EXPECT_EQ(remembered({10, 14}), Lengths({18}));                // beyond all: 9 from the middle of the 10
  EXPECT_EQ(remembered({10, 4, 4, 4}), Lengths({10, 4}));        // a small loop, over and over
  EXPECT_EQ(remembered({10, 4, 4, 4, 4}), Lengths({10}));
  EXPECT_EQ(remembered({20, 10, 9, 8, 7, 6, 5, 4, 3}), Lengths({9, 8, 7, 6, 5, 4, 3}));
}

/// A record of v(t) at 1 kHz with white noise [m/s], found as sliding.
struct Found {
  Motion motion;
  Strokes strokes;
};
Found found_in(const std::function<double(double)>& velocity, double duration, double noise, std::uint64_t seed = 1) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> error(0, 1);
  Trace trace;
  trace.velocity_kind = VelocityKind::relative;
  for (double t = 0; t < duration; t += 1e-3) {
    const double v = velocity(t);
    trace.time.push_back(t);
    trace.velocity.push_back(v + noise * error(engine));
    trace.friction.push_back(std::copysign(0.3 + 0.1 * std::exp(-std::abs(v) / 0.02), v) + 0.003 * error(engine));
  }
  Found out;
  out.motion = compute_motion(std::move(trace));
  out.strokes = strokes_of(out.motion, find_cycles(out.motion));
  return out;
}

/// 50 mm/s at 0.5 Hz: strokes of 2 v/w = 31.8 mm, from a quarter of a period on.
double swing(double t) {
  return 0.05 * std::cos(std::numbers::pi * t);
}

TEST(Strokes, AreMeasuredFromTheReversal) {
  constexpr double kLength = 0.1 / std::numbers::pi;
  for (const double noise : {0.0, 2e-4, 2e-3}) {
    const Found found = found_in(swing, 20, noise);
    ASSERT_TRUE(found.strokes.known()) << noise;
    EXPECT_NEAR(found.strokes.length, kLength, 1e-6 + 0.05 * noise) << noise;
    for (std::size_t i = 0; i < found.motion.size(); i += 7) {
      const double t = found.motion.time[i], since = t + 0.5 - std::floor(t + 0.5);
      // It begins half-way: the first half is taken to be as that of the others.
      const double expected = 0.5 * kLength * (1 - std::cos(std::numbers::pi * since));
      const bool near_turn = since < 0.03 || since > 0.97;  // which side of it is within the noise
      if (near_turn) continue;
      EXPECT_NEAR(found.strokes.distance[i], expected, 2e-5 + 0.1 * noise) << t << " s, " << noise;
    }
    for (const std::vector<double>& earlier : found.strokes.earlier) {
      ASSERT_FALSE(earlier.empty());
      EXPECT_NEAR(earlier[0], kLength, 2e-5 + 0.1 * noise);
    }
  }
}

TEST(Strokes, AreNoneWhereNothingReverses) {
  EXPECT_FALSE(found_in([](double t) { return 0.05 + 0.04 * std::sin(t); }, 20, 2e-4).strokes.known());
  EXPECT_FALSE(found_in([](double t) { return t < 10 ? 0.05 : -0.05; }, 20, 2e-4).strokes.known());
  EXPECT_EQ(too_few_reversals(0), "the block slides in one direction only");
  EXPECT_EQ(too_few_reversals(3), "sliding reverses 3 times only; 4 reversals are needed");
}

/// Where v_r is slower than its noise for a while, noise makes no strokes.
TEST(Strokes, DoNotTurnWithNoise) {
  const auto slow_middle = [](double t) { return 0.05 * std::pow(std::cos(std::numbers::pi * t), 3); };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Found found = found_in(slow_middle, 20, 1e-3, seed);
    ASSERT_TRUE(found.strokes.known()) << seed;
    // The integral of cos^3 over half a turn is 4/3.
    EXPECT_NEAR(found.strokes.length, 0.05 * 4 / 3 / std::numbers::pi, 1e-4) << seed;
  }
}

}  // namespace
}  // namespace tribofit
