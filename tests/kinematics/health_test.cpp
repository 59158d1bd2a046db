// Each check speaks up for the fault it is named after, and is quiet on a sound record.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

#include "../real_data.hpp"
#include "stick_slip_truth.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace tribofit {
namespace {

using ::testing::ElementsAre;
using Status = HealthItem::Status;

HealthItem item(const Motion& motion, const std::string& check) {
  for (const HealthItem& i : motion.health) {
    if (i.check == check) return i;
  }
  throw std::out_of_range(check);
}

truth::Rig long_rig() {
  truth::Rig rig;
  rig.duration = 36;  // 2.4 revolutions
  rig.rate = 5000;
  return rig;
}

TEST(Health, SoundRecordHasElevenChecksAndNoComplaint) {
  const Motion motion = compute_motion(truth::simulate(long_rig()).trace);
  std::vector<std::string> names;
  for (const HealthItem& i : motion.health) {
    names.push_back(i.check);
    EXPECT_EQ(i.status, Status::ok) << i.check << ": " << i.message;
    EXPECT_FALSE(i.message.empty());
  }
  EXPECT_THAT(names,
              ElementsAre("clipping", "drop-outs", "sagging-plateau", "bandwidth", "channel-delay", "revolutions",
                          "speed-ripple", "run-up", "plateau-speed", "resolution", "friction-zero"));
}

TEST(Health, ClippedVelocity) {
  Trace trace = truth::simulate(truth::Rig{}).trace;
  for (double& v : trace.velocity) v = std::max(v, -0.06);
  EXPECT_EQ(item(compute_motion(std::move(trace)), "clipping").status, Status::problem);
}

TEST(Health, DropOutsAndGaps) {
  Trace trace = truth::simulate(truth::Rig{}).trace;
  for (std::size_t i = 1000; i < trace.size(); i += 20000) trace.velocity[i] += 0.05;
  EXPECT_EQ(item(compute_motion(trace), "drop-outs").status, Status::warning);
  Trace gap = truth::simulate(truth::Rig{}).trace;
  for (std::size_t i = 50000; i < gap.size(); ++i) gap.time[i] += 4.0 / 20000;
  const HealthItem found = item(compute_motion(gap), "drop-outs");
  EXPECT_EQ(found.status, Status::warning);
  EXPECT_THAT(found.message, ::testing::HasSubstr("1 gaps"));
}

TEST(Health, DelayBetweenTheChannels) {
  for (double delay : {-1.5e-3, 2e-3}) {
    truth::Rig rig;
    const truth::Run run = truth::simulate(rig);
    Trace trace = run.trace;
    const auto shift = static_cast<std::ptrdiff_t>(std::lround(delay * rig.rate));
    const auto n = static_cast<std::ptrdiff_t>(trace.size());
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      trace.friction[static_cast<std::size_t>(i)] =
          run.trace.friction[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i - shift, 0, n - 1))];
    }
    const HealthItem found = item(compute_motion(std::move(trace)), "channel-delay");
    EXPECT_EQ(found.status, Status::warning);
    double value = 0;
    ASSERT_EQ(std::sscanf(found.message.c_str(), "friction jumps about %lf ms", &value), 1) << found.message;
    EXPECT_NEAR(value, 1e3 * std::abs(delay), 0.15);
    EXPECT_THAT(found.message, ::testing::HasSubstr(delay > 0 ? "after" : "before"));
  }
}

TEST(Health, FewerThanTwoRevolutionsAreSaid) {
  EXPECT_EQ(item(compute_motion(truth::simulate(truth::Rig{}).trace), "revolutions").status, Status::warning);
}

TEST(Health, SpeedRippleIsMeasured) {
  truth::Rig rig = long_rig();
  Trace trace = truth::simulate(rig).trace;
  const double disc = rig.speed() * rig.radius;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (std::abs(trace.velocity[i] - disc) < 1.5e-4)
      trace.velocity[i] += 0.05 * disc * std::cos(rig.speed() * trace.time[i] + 1);
  }
  const HealthItem found = item(compute_motion(std::move(trace)), "speed-ripple");
  EXPECT_EQ(found.status, Status::warning);
  double value = 0;
  ASSERT_EQ(std::sscanf(found.message.c_str(), "the plateau follows the disc angle by %lf %%", &value), 1);
  EXPECT_NEAR(value, 5, 0.2);
}

TEST(Health, BandwidthOfAFilteredChannel) {
  truth::Rig rig;
  rig.friction_noise = rig.velocity_noise = 0;
  Trace trace = truth::simulate(rig).trace;
  // Butterworth of second order at 100 Hz (bilinear transform), twice.
  const double k = std::tan(std::numbers::pi * 100 / rig.rate), norm = 1 / (1 + std::sqrt(2.0) * k + k * k);
  for (int pass = 0; pass < 2; ++pass) {
    const double v0 = trace.velocity[0];
    double x1 = v0, x2 = v0, y1 = v0, y2 = v0;
    for (double& v : trace.velocity) {
      const double y =
          norm * (k * k * (v + 2 * x1 + x2) - 2 * (k * k - 1) * y1 - (1 - std::sqrt(2.0) * k + k * k) * y2);
      x2 = x1, x1 = v, y2 = y1, y1 = y, v = y;
    }
  }
  const HealthItem found = item(compute_motion(std::move(trace)), "bandwidth");
  EXPECT_EQ(found.status, Status::problem);  // of no first order: it is not undone
  EXPECT_THAT(found.message, ::testing::HasSubstr("velocity falls"));
  EXPECT_THAT(found.message, ::testing::HasSubstr("friction stands"));
  EXPECT_THAT(found.message, ::testing::HasSubstr("is needed"));
}

TEST(Health, BandwidthOfTheDrillStringsChannels) {
  const auto path = real_data("measured/drill-string/drillstring_175.csv");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent";
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  Trace trace;
  trace.velocity_kind = VelocityKind::relative;
  while (std::getline(file, line)) {
    double time = 0, bit = 0, top = 0, torque = 0, weight = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &time, &bit, &top, &torque, &weight), 5);
    trace.time.push_back(time);
    trace.velocity.push_back(bit * 2 * std::numbers::pi / 60 * 0.05);
    trace.friction.push_back(torque / 0.05 / weight);
  }
  trace.steps = {{0, trace.size(), "", {}}};
  // Torque falls by four decades between 20 and 80 Hz, the speed of the bit does not.
  const HealthItem found = item(compute_motion(std::move(trace)), "bandwidth");
  EXPECT_EQ(found.status, Status::warning);
  EXPECT_THAT(found.message, ::testing::HasSubstr("friction falls from about"));
  EXPECT_THAT(found.message, ::testing::HasSubstr("the channels have different filters"));
}

TEST(Health, HalfTheSamplesClipped) {
  for (double noise : {2e-5, 0.0}) {
    truth::Rig rig;
    rig.rpm = 30;  // slips last as long as sticks
    rig.velocity_noise = noise;
    Trace trace = truth::simulate(rig).trace;
    std::vector<double> sorted = trace.velocity;
    std::sort(sorted.begin(), sorted.end());
    const double limit = sorted[sorted.size() * 35 / 100];
    for (double& v : trace.velocity) v = std::max(v, limit);
    const HealthItem found = item(compute_motion(std::move(trace)), "clipping");
    EXPECT_EQ(found.status, Status::problem) << noise;
    EXPECT_THAT(found.message, ::testing::HasSubstr("velocity stays at")) << noise;
  }
  Trace trace = truth::simulate(truth::Rig{}).trace;
  std::vector<double> sorted = trace.friction;
  std::sort(sorted.begin(), sorted.end());
  for (double& mu : trace.friction) mu = std::min(mu, sorted[sorted.size() / 2]);
  EXPECT_THAT(item(compute_motion(std::move(trace)), "clipping").message, ::testing::HasSubstr("friction stays at"));
}

TEST(Health, APlateauWithoutNoiseIsNoClipping) {
  for (bool coulomb : {false, true}) {
    for (bool stated : {true, false}) {
      truth::Rig rig;
      rig.friction_noise = rig.velocity_noise = 0;
      rig.coulomb = coulomb;
      Trace trace = truth::simulate(rig).trace;
      if (!stated) trace.conditions.speed = {};
      const HealthItem found = item(compute_motion(std::move(trace)), "clipping");
      EXPECT_EQ(found.status, Status::ok) << found.message;
    }
  }
}

TEST(Health, FrictionThatIsFlatAtBreakAwayIsNoClipping) {
  for (double rpm : {1.0, 4.0}) {
    truth::Rig rig;
    rig.friction_noise = rig.velocity_noise = 0;
    rig.flat_at_rest = true;
    rig.rpm = rpm;
    Trace trace = truth::simulate(rig).trace;
    for (double& mu : trace.friction) mu = 1e-5 * std::round(1e5 * mu);  // as a file has it
    EXPECT_EQ(item(compute_motion(trace), "clipping").status, Status::ok)
        << item(compute_motion(trace), "clipping").message;
    for (double& mu : trace.friction) mu = std::min(mu, 0.5);
    EXPECT_EQ(item(compute_motion(std::move(trace)), "clipping").status, Status::problem);
  }
}

/// The first pull on a slack rig makes the range wide: beside it a small drop of friction is no level that is held.
TEST(Health, ASmallDropOfFrictionIsNoClipping) {
  for (unsigned seed : {1U, 2U, 3U}) {
    for (double drop : {0.008, 0.015, 0.03}) {
      truth::Rig rig;
      rig.seed = seed;
      rig.rate = 5000;
      rig.duration = 8;
      rig.scatter = 0.001;
      rig.static_friction = rig.kinetic_friction + drop;
      rig.friction_noise = 0.002 * seed;
      Trace trace = truth::simulate(rig).trace;
      const std::size_t pull = trace.size() / 60;
      for (std::size_t i = 0; i < pull; ++i) trace.friction[i] *= static_cast<double>(i) / static_cast<double>(pull);
      EXPECT_EQ(item(compute_motion(trace), "clipping").status, Status::ok)
          << item(compute_motion(trace), "clipping").message;
    }
    // A limit behind noise is one, beside such a pull or not.
    truth::Rig rig;
    rig.seed = seed;
    rig.friction_noise = 0;
    Trace trace = truth::simulate(rig).trace;
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> noise(0, 0.002);
    const std::size_t pull = trace.size() / 60;
    for (std::size_t i = 0; i < trace.size(); ++i) {
      const double part = std::min(1.0, static_cast<double>(i) / static_cast<double>(pull));
      trace.friction[i] = std::min(part * trace.friction[i], 0.42) + noise(engine);
    }
    EXPECT_EQ(item(compute_motion(std::move(trace)), "clipping").status, Status::problem);
  }
}

/// v_r of a block that is driven to and fro, at rest for `pause` of the amplitude about each reversal; friction is
/// higher one way.
Trace reciprocating(double amplitude, double frequency, double phase, double pause, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  Trace trace;
  trace.velocity_kind = VelocityKind::relative;
  const std::size_t n = 16000;
  const double rate = 1000 * frequency;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / rate, s = std::sin(2 * std::numbers::pi * frequency * t + phase);
    const double v = amplitude * std::copysign(std::max(0.0, std::abs(s) - pause), s);
    const double slides = std::copysign(0.3 + 0.2 * std::exp(-52 * std::abs(v)), v) * (v < 0 ? 1.1 : 1);
    const double mu = v != 0 || pause == 0 ? slides : 0.5 * s / pause;
    trace.time.push_back(t);
    trace.velocity.push_back(v + 1e-3 * amplitude * normal(engine));
    trace.friction.push_back(mu + 0.003 * normal(engine));
  }
  trace.steps = {{0, n, "", {}}};
  return trace;
}

TEST(Health, AReversalIsNoRest) {
  unsigned seed = 0;
  for (double amplitude : {0.005, 0.08}) {
    for (double frequency : {0.1, 1.0, 5.0}) {
      for (double phase : {0.0, 0.7, std::numbers::pi / 2, 4.0}) {
        const Motion motion = compute_motion(reciprocating(amplitude, frequency, phase, 0, ++seed));
        EXPECT_FALSE(motion.sticks) << seed;
        for (const HealthItem& i : motion.health) EXPECT_NE(i.status, Status::problem) << i.check << ": " << i.message;
      }
    }
  }
}

TEST(Health, ARestAtEachReversalIsOne) {
  unsigned seed = 0;
  for (double pause : {0.15, 0.2, 0.4}) {
    for (double phase : {0.0, 0.7, std::numbers::pi / 2}) {
      const Motion motion = compute_motion(reciprocating(0.03, 1, phase, pause, ++seed));
      EXPECT_TRUE(motion.sticks) << seed;
      EXPECT_LT(std::abs(motion.plateau_velocity), 1e-4) << seed;
      for (const HealthItem& i : motion.health) EXPECT_NE(i.status, Status::problem) << i.check << ": " << i.message;
    }
  }
}

/// A held block over twelve speeds of a disc, a thousand samples each: friction of Coulomb and viscous parts.
Trace speed_steps(std::mt19937_64& engine) {
  std::vector<double> speeds;
  for (int k = 0; k < 12; ++k) speeds.push_back(1.5e-3 * std::pow(60.0, k / 11.0));
  std::shuffle(speeds.begin(), speeds.end(), engine);
  std::normal_distribution<double> noise(0, 0.003);
  Trace trace;
  trace.velocity_kind = VelocityKind::fixed_block;
  trace.conditions.radius = {0.015, "file"};
  for (std::size_t i = 0; i < 12000; ++i) {
    const double speed = speeds[i / 1000];
    trace.time.push_back(5e-3 * static_cast<double>(i));
    trace.disc_speed.push_back(speed / 0.015);
    trace.friction.push_back(0.35 + 1.5 * speed + noise(engine));
  }
  trace.steps = {{0, trace.size(), "", trace.conditions}};
  return trace;
}

TEST(Health, FrictionOfTheFastestStepIsNoClipping) {
  std::mt19937_64 engine(3);
  for (int record = 0; record < 40; ++record) {
    const Trace trace = speed_steps(engine);
    EXPECT_EQ(item(compute_motion(trace), "clipping").status, Status::ok)
        << item(compute_motion(trace), "clipping").message;
    // The same with an amplifier that ends below the fastest, a little noise behind it.
    Trace clipped = trace;
    std::normal_distribution<double> noise(0, 0.0003);
    for (double& mu : clipped.friction) mu = std::min(mu, 0.35 + 1.5 * 0.08) + noise(engine);
    const HealthItem found = item(compute_motion(std::move(clipped)), "clipping");
    EXPECT_EQ(found.status, Status::problem) << found.message;
    EXPECT_THAT(found.message, ::testing::HasSubstr("friction stays at"));
  }
}

TEST(Health, ChannelsThatStandStill) {
  for (double from : {0.4, 0.9}) {
    Trace trace = truth::simulate(truth::Rig{}).trace;
    const auto begin = static_cast<std::size_t>(from * static_cast<double>(trace.size()));
    const auto end = begin + trace.size() * 6 / 100;
    for (std::size_t i = begin; i < end; ++i) {
      trace.friction[i] = trace.friction[begin];
      trace.velocity[i] = trace.velocity[begin];
    }
    const HealthItem found = item(compute_motion(std::move(trace)), "drop-outs");
    EXPECT_EQ(found.status, Status::problem);
    EXPECT_THAT(found.message, ::testing::HasSubstr("both channels do not change"));
  }
}

TEST(Health, ARecordedSpeedIsComparedWithThePlateau) {
  const auto with_column = [](double factor) {
    truth::Rig rig;
    Trace trace = truth::simulate(rig).trace;
    trace.conditions.speed = {};
    trace.disc_speed.assign(trace.size(), factor * rig.speed());
    return item(compute_motion(std::move(trace)), "plateau-speed");
  };
  EXPECT_EQ(with_column(1).status, Status::ok) << with_column(1).message;
  EXPECT_EQ(with_column(1.05).status, Status::warning) << with_column(1.05).message;
  EXPECT_EQ(with_column(0.95).status, Status::warning) << with_column(0.95).message;
  for (double factor : {2.0, -1.0, 0.0, 0.1, 30.0}) {
    EXPECT_EQ(with_column(factor).status, Status::problem) << factor << ": " << with_column(factor).message;
  }
}

TEST(Health, ADiscThatTurnsForthAndBackHasNoMeanToBeComparedWith) {
  const PublishedTest test = published_test(0.015, ExponentialLaw{});
  for (const double turns : {2.0, 3.0, 3.1, 6.0}) {
    for (const double speed_error : {1.0, 1.1}) {
      SimulationOptions options;
      options.duration = 20;
      options.rate = 5000;
      const Drive drive{.speed = reversing_speed(2 * test.speed, turns / options.duration),
                        .radius = test.radius,
                        .mean_load = test.load};
      Sensors sensors;
      sensors.friction_noise = 0.003;
      sensors.velocity_noise = 2e-5;
      Trace trace =
          simulate_recording(FrictionModel(ExponentialLaw{}), test.friction, test.rig, drive, options, sensors)
              .recording.trace;
      ASSERT_EQ(trace.disc_speed.size(), trace.size());
      for (double& speed : trace.disc_speed) speed *= speed_error;
      const HealthItem found = item(compute_motion(std::move(trace)), "plateau-speed");
      EXPECT_EQ(found.status == Status::ok, speed_error == 1) << turns << " " << speed_error << ": " << found.message;
    }
  }
}

}  // namespace
}  // namespace tribofit
