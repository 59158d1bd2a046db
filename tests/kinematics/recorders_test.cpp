// What recorders do to a record of known truth: found, left out or undone, and absent where it is not there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "stick_slip_truth.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::recorders {
namespace {

using ::testing::HasSubstr;

/// With noise of friction of 0.003 and of the velocity of 0.02 mm/s.
Trace recorded(unsigned seed, double rpm = 4) {
  truth::Rig rig;
  rig.duration = 8, rig.rpm = rpm;
  rig.scatter = 0.004;
  rig.friction_noise = 0.003, rig.velocity_noise = 2e-5;
  rig.seed = seed;
  return truth::simulate(rig).trace;
}

const HealthItem& item(const Motion& motion, const std::string& check) {
  return *std::find_if(motion.health.begin(), motion.health.end(),
                       [&](const HealthItem& i) { return i.check == check; });
}

/// A slow channel in a fast record: of values that are repeated the first is used, those of a coarse converter all are.
TEST(Recorders, ValuesThatAreHeldAreUsedOnce) {
  Trace sound = recorded(3);
  const double disc = sound.conditions.speed.value * sound.conditions.radius.value;
  for (const std::size_t count : {2U, 5U, 20U}) {
    for (const bool both : {true, false}) {
      Trace trace = sound;
      for (std::size_t i = 0; i < trace.size(); ++i) {
        trace.velocity[i] = trace.velocity[i - i % count];
        if (both) trace.friction[i] = trace.friction[i - i % count];
      }
      const Motion motion = compute_motion(std::move(trace));
      ASSERT_EQ(motion.size() + motion.trimmed, sound.size() / count);
      for (std::size_t i = 0; i < motion.size(); ++i) {
        const std::size_t fresh = (i + motion.trimmed) * count;
        ASSERT_DOUBLE_EQ(motion.time[i], sound.time[fresh]);
        ASSERT_NEAR(motion.relative_velocity[i], disc - sound.velocity[fresh], 1e-12);
      }
      EXPECT_THAT(motion.notes,
                  ::testing::Contains(::testing::HasSubstr("in one of " + std::to_string(count) + " samples")));
      EXPECT_EQ(item(motion, "drop-outs").status, HealthItem::Status::ok) << item(motion, "drop-outs").message;
    }
  }
  Trace coarse = sound;
  for (double& v : coarse.velocity) v = 1e-3 * std::round(v / 1e-3);
  EXPECT_EQ(compute_motion(std::move(coarse)).size(), sound.size());
}

/// The same where straight lines lead from value to value, as software draws them between two rates.
TEST(Recorders, ValuesBetweenWhichLinesAreDrawnAreUsedOnce) {
  Trace sound = recorded(3);
  for (const std::size_t count : {2U, 7U, 20U}) {
    for (const auto channel : {&Trace::velocity, &Trace::friction}) {
      Trace trace = sound;
      std::vector<double>& x = trace.*channel;
      for (std::size_t i = 0; i + count < x.size(); ++i) {
        const std::size_t knot = i - i % count;
        const double part = static_cast<double>(i % count) / static_cast<double>(count);
        x[i] = (sound.*channel)[knot] + part * ((sound.*channel)[knot + count] - (sound.*channel)[knot]);
      }
      const Motion motion = compute_motion(std::move(trace));
      ASSERT_EQ(motion.size() + motion.trimmed, (sound.size() + count - 1) / count);
      for (std::size_t i = 0; i < motion.size(); ++i)
        ASSERT_DOUBLE_EQ(motion.time[i], sound.time[(i + motion.trimmed) * count]);
    }
  }
}

/// A laser that loses its speckle reads about nothing, or anything, for some samples: they are left out.
TEST(Recorders, AVelocityThatDropsOutIsLeftOutThere) {
  std::mt19937_64 engine(8);
  std::uniform_real_distribution<double> anything(-0.15, 0.15);
  for (const bool reads_anything : {false, true}) {
    Trace trace = recorded(4);
    const Trace sound = trace;
    std::vector<std::size_t> lost;
    for (std::size_t begin = 1000; begin + 30 < trace.size(); begin += 1511) {
      if (std::abs(sound.velocity[begin]) < 2e-3 || std::abs(sound.velocity[begin] - sound.velocity[begin + 12]) > 5e-4)
        continue;
      for (std::size_t i = begin; i < begin + 12; ++i)
        trace.velocity[i] = reads_anything ? anything(engine) : 0.01 * trace.velocity[i], lost.push_back(i);
    }
    ASSERT_GT(lost.size(), 500U);
    const double disc = trace.conditions.speed.value * trace.conditions.radius.value;
    const double near = reads_anything ? 2e-3 : 1e-3;  // anything may come near by chance
    const Motion motion = compute_motion(std::move(trace));
    std::size_t wrong = 0;
    for (const std::size_t i : lost) {
      if (i < motion.trimmed || i - motion.trimmed >= motion.size()) continue;
      wrong += std::abs(motion.relative_velocity[i - motion.trimmed] - (disc - sound.velocity[i])) > near ? 1U : 0U;
    }
    EXPECT_LT(wrong, lost.size() / 50);
    EXPECT_THAT(item(motion, "drop-outs").message, HasSubstr("jumps away and back"));
  }
  for (const double rpm : {1.0, 4.0, 60.0, 200.0})
    EXPECT_THAT(item(compute_motion(recorded(5, rpm)), "drop-outs").message, Not(HasSubstr("jumps away"))) << rpm;
}

/// Where a joint that turns at 1 rad/s, sampled at 67 Hz, is at rest, which an encoder reads as exactly zero.
Trace joint_at_rest(std::size_t begin, std::size_t end) {
  std::mt19937_64 engine(6);
  std::normal_distribution<double> error;
  Trace trace;
  trace.velocity_kind = VelocityKind::relative;
  for (std::size_t i = 0; i < 1200; ++i) {
    const bool rests = i >= begin && i < end;
    trace.time.push_back(static_cast<double>(i) / 67);
    trace.velocity.push_back(rests ? 0 : 1 + 0.05 * error(engine));
    trace.friction.push_back((rests ? 0.46 : 2) + 0.1 * error(engine));
  }
  return trace;
}

TEST(Recorders, AnEncoderThatReadsZeroAtRestLosesNothing) {
  for (const auto& [begin, end] : {std::pair{900, 1200}, std::pair{0, 300}, std::pair{500, 700}}) {
    const Motion motion = compute_motion(joint_at_rest(static_cast<std::size_t>(begin), static_cast<std::size_t>(end)));
    const auto middle = static_cast<std::size_t>((begin + end) / 2);
    EXPECT_EQ(item(motion, "drop-outs").status, HealthItem::Status::ok) << item(motion, "drop-outs").message;
    EXPECT_EQ(motion.relative_velocity[middle], 0);
    EXPECT_FALSE(motion.has_fault(middle, SampleFault::any));
  }
}

/// Friction says that the joint went on.
TEST(Recorders, ALoosePlugInASlidingVelocityIsNoRest) {
  Trace within = joint_at_rest(900, 1200), to_the_end = joint_at_rest(0, 0);
  for (std::size_t i = 300; i < 500; ++i) within.velocity[i] = 0;
  for (std::size_t i = 1000; i < 1200; ++i) to_the_end.velocity[i] = 0;
  const Motion motion = compute_motion(std::move(within));
  EXPECT_EQ(item(motion, "drop-outs").status, HealthItem::Status::problem);
  EXPECT_THAT(item(motion, "drop-outs").message, HasSubstr("repeats one value"));
  EXPECT_TRUE(motion.has_fault(400, SampleFault::any));
  EXPECT_FALSE(motion.has_fault(1100, SampleFault::any));
  EXPECT_EQ(item(compute_motion(std::move(to_the_end)), "drop-outs").status, HealthItem::Status::problem);
}

/// Plateaus and the block's mean velocity drift alike: it is the zero. A disc that slows down moves plateaus alone.
TEST(Recorders, AZeroThatDriftsIsTakenOff) {
  for (const double by : {3e-4, -1e-3}) {
    Trace zero = recorded(6);
    const Trace sound = zero;
    const auto n = static_cast<double>(zero.size());
    for (std::size_t i = 0; i < zero.size(); ++i) zero.velocity[i] += by * static_cast<double>(i) / n;
    const double disc = zero.conditions.speed.value * zero.conditions.radius.value;
    const Motion motion = compute_motion(std::move(zero));
    EXPECT_THAT(item(motion, "plateau-speed").message, HasSubstr("the zero of the velocity drifts"));
    double worst = 0;
    for (std::size_t i = 0; i < motion.size(); ++i)
      worst = std::max(worst, std::abs(motion.relative_velocity[i] - disc + sound.velocity[i + motion.trimmed]));
    EXPECT_LT(worst, 0.05 * std::abs(by));
  }
  for (const unsigned seed : {6U, 7U, 8U})
    EXPECT_THAT(item(compute_motion(recorded(seed)), "plateau-speed").message, Not(HasSubstr("drifts")));
  Trace slowing = recorded(6);
  const double rate = 2e-3 / slowing.duration();  // of the disc [m/s^2]: the block follows in stick, and slips more
  double gone = 0;
  for (std::size_t i = 0; i < slowing.size(); ++i) {
    const bool sticks =
        std::abs(slowing.velocity[i] - slowing.conditions.speed.value * slowing.conditions.radius.value) < 3e-4;
    const double off = sticks ? -rate * slowing.time[i] : 0;
    gone += off;
    slowing.velocity[i] += off;
    if (!sticks) slowing.velocity[i] -= std::exchange(gone, 0.0) / 400;  // it goes nowhere all the same
  }
  EXPECT_THAT(item(compute_motion(std::move(slowing)), "plateau-speed").message,
              Not(HasSubstr("zero of the velocity")));
}

/// Noise behind a running median repeats values, steps of a converter do so at its levels.
TEST(Recorders, ARunningMedianIsAProblem) {
  for (const std::size_t half : {1U, 3U, 10U}) {
    Trace trace = recorded(7);
    const std::vector<double> x = trace.friction;
    for (std::size_t i = half; i + half < x.size(); ++i) {
      std::vector<double> some(x.begin() + static_cast<std::ptrdiff_t>(i - half),
                               x.begin() + static_cast<std::ptrdiff_t>(i + half + 1));
      std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(half), some.end());
      trace.friction[i] = some[half];
    }
    const HealthItem band = item(compute_motion(std::move(trace)), "bandwidth");
    EXPECT_EQ(band.status, HealthItem::Status::problem) << half;
    EXPECT_THAT(band.message, HasSubstr("friction repeats values at uneven places"));
  }
  for (const double step : {1e-5, 1e-4, 1e-3, 3e-3, 1e-2}) {
    Trace coarse = recorded(7);
    for (double& mu : coarse.friction) mu = step * std::round(mu / step);
    EXPECT_THAT(item(compute_motion(std::move(coarse)), "bandwidth").message, Not(HasSubstr("uneven"))) << step;
  }
}

/// Friction that is cut off behind noise as wide as what is cut stops rising while its spring is stretched on.
TEST(Recorders, FrictionThatLevelsOffIsClipped) {
  std::mt19937_64 random(3);
  for (const double rpm : {2.0, 4.0, 8.0}) {
    for (const int sign : {1, -1}) {
      Trace trace = recorded(8, rpm);
      const auto dither = truth::noise(trace.size(), 0.002, 0, random);
      for (std::size_t i = 0; i < trace.size(); ++i)
        trace.friction[i] = sign * (std::min(trace.friction[i], 0.5) + dither[i]);
      EXPECT_NE(item(compute_motion(std::move(trace)), "clipping").status, HealthItem::Status::ok) << rpm;
    }
  }
  for (const double rpm : {1.0, 4.0, 12.0}) {
    for (const double noise : {3e-5, 3e-4, 3e-3}) {
      for (const bool flat : {false, true}) {
        truth::Rig rig;
        rig.duration = 8;
        rig.rpm = rpm;
        rig.friction_noise = noise;
        rig.flat_at_rest = flat;
        const HealthItem clipping = item(compute_motion(truth::simulate(rig).trace), "clipping");
        EXPECT_EQ(clipping.status, HealthItem::Status::ok) << rpm << ' ' << noise << ' ' << flat << clipping.message;
      }
    }
  }
}

/// Noise with the tails of a laser's: t with three degrees of freedom. No sample is lost for it, and hardly one left
/// out.
TEST(Recorders, HeavyTailsAreNoFault) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    truth::Rig rig;
    rig.duration = 8;
    rig.friction_noise = rig.velocity_noise = 0;
    rig.seed = seed;
    Trace trace = truth::simulate(rig).trace;
    std::mt19937_64 random(seed);
    std::student_t_distribution<double> noise(3);
    for (std::size_t i = 0; i < trace.size(); ++i) {
      trace.friction[i] += 0.002 * noise(random);
      trace.velocity[i] += 3e-5 * noise(random);
    }
    const Motion motion = compute_motion(std::move(trace));
    for (const HealthItem& i : motion.health) EXPECT_NE(i.status, HealthItem::Status::problem) << i.message;
    std::size_t left_out = 0;
    for (std::size_t i = 0; i < motion.size(); ++i) left_out += motion.has_fault(i, SampleFault::any) ? 1U : 0U;
    EXPECT_LE(left_out, 10U) << seed;
  }
}

/// A drive that moves at one speed, dwells and comes back: its strokes are motion, and friction that stays where it was
/// left is no limit of a range.
TEST(Recorders, DwellsOfADriveAreNoFault) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    for (const bool encoder : {false, true}) {  // reads exactly zero at rest
      std::mt19937_64 random(seed);
      std::normal_distribution<double> noise;
      Trace trace;
      trace.velocity_kind = VelocityKind::relative;
      double friction = 0.3;
      for (std::size_t i = 0; i < 8000; ++i) {
        const std::size_t place = i % 500, within = place % 250;  // 2 s forth, 0.5 s rest, the same back
        const double ramp =
            std::min({1.0, 0.25 * static_cast<double>(within + 1), 0.25 * static_cast<double>(200 - within)});
        const double v = within >= 200 ? 0 : (place < 250 ? 0.005 : -0.005) * ramp;
        if (v != 0) friction = v > 0 ? 0.3 : -0.3;
        trace.time.push_back(0.01 * static_cast<double>(i));
        trace.velocity.push_back(v + (encoder && v == 0 ? 0 : 2e-5 * noise(random)));
        trace.friction.push_back(friction + (v == 0 ? 0.001 : 0.004) * noise(random));
      }
      trace.steps = {{0, trace.size(), "", {}}};
      const Motion motion = compute_motion(std::move(trace));
      EXPECT_EQ(item(motion, "clipping").status, HealthItem::Status::ok) << item(motion, "clipping").message;
      EXPECT_EQ(item(motion, "drop-outs").status, HealthItem::Status::ok) << item(motion, "drop-outs").message;
      EXPECT_TRUE(motion.faults.empty());
    }
  }
}

/// A speed of two values is not cut off at the upper one.
TEST(Recorders, ASpeedOfTwoValuesIsNotCutOff) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise;
  Trace trace;
  trace.velocity_kind = VelocityKind::relative;
  double speed = 64.9;
  for (std::size_t i = 0; i < 6000; ++i) {
    speed += 0.1 * (64.9 - speed) + 0.1 * noise(random);
    trace.time.push_back(0.1 * static_cast<double>(i));
    trace.velocity.push_back(std::clamp(std::round(speed), 64.0, 65.0) * 1e-3);
    trace.friction.push_back(0.4 + 0.01 * noise(random));
  }
  trace.steps = {{0, trace.size(), "", trace.conditions}};
  const Motion motion = compute_motion(std::move(trace));
  EXPECT_EQ(item(motion, "clipping").status, HealthItem::Status::ok) << item(motion, "clipping").message;
  EXPECT_TRUE(motion.faults.empty());
}

/// A load that is the same for long, with markers where the converter had nothing; and spikes as wide as a filter.
TEST(Recorders, MarkersOfALoadThatHardlyChangesAreLeftOut) {
  Trace trace = recorded(9);
  trace.load.assign(trace.size(), 50);
  for (std::size_t i = trace.size() / 2; i < trace.size(); ++i) trace.load[i] = 51;
  for (std::size_t i = 20000; i < 20040; ++i) trace.load[i] = -9999;
  for (std::size_t i = 0; i < 5; ++i) trace.velocity[50000 + i] = 40 + static_cast<double>(i);
  const Motion motion = compute_motion(std::move(trace));
  EXPECT_TRUE(motion.has_fault(20010 - motion.trimmed, SampleFault::any));
  EXPECT_TRUE(motion.has_fault(50002 - motion.trimmed, SampleFault::velocity));
  for (const double load : motion.load) EXPECT_GT(load, 0);
  EXPECT_LT(*std::max_element(motion.relative_velocity.begin(), motion.relative_velocity.end()), 1);
}

/// Strokes of 10 mm at 5.00 mm/s with dwells, of which only the position was recorded: its slope is taken over as much
/// as its noise asks for, and no more.
TEST(Recorders, TheSpeedOfAStrokeIsThatOfItsPosition) {
  for (const double scatter : {1e-7, 2e-6, 2e-5}) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0, scatter);
    Trace trace;
    trace.velocity_kind = VelocityKind::relative;
    double position = 0;
    std::vector<double> speeds;
    for (std::size_t i = 0; i < 5000; ++i) {
      const std::size_t place = i % 500;
      speeds.push_back(place % 250 >= 200 ? 0 : place < 250 ? 0.005 : -0.005);
      position += 0.01 * speeds.back();
      trace.time.push_back(0.01 * static_cast<double>(i));
      trace.drive_position.push_back(position + noise(random));
      trace.friction.push_back(0.3 * (place < 250 ? 1 : -1) + 0.004 * noise(random) / scatter);
    }
    trace.steps = {{0, trace.size(), "", {}}};
    const Motion motion = compute_motion(std::move(trace));
    std::vector<double> moving, resting;  // well within a stroke or a dwell
    for (std::size_t i = 0; i < motion.size(); ++i) {
      const std::size_t place = (i + motion.trimmed) % 250;
      if (place > 60 && place < 140) moving.push_back(std::abs(motion.relative_velocity[i]));
      if (place == 225) resting.push_back(std::abs(motion.relative_velocity[i]));
    }
    EXPECT_NEAR(median(moving), 0.005, 5e-6) << scatter;
    EXPECT_LT(median(resting), 2e-4) << scatter;
  }
}

/// Cubics from value to value, as splines are.
TEST(Recorders, ValuesBetweenWhichSplinesAreDrawnAreUsedOnce) {
  const Trace sound = recorded(3);
  for (const std::size_t count : {5U, 10U}) {
    Trace trace = sound;
    for (std::size_t i = count; i + 2 * count < trace.size(); ++i) {  // Catmull and Rom's
      const std::size_t knot = i - i % count;
      const double u = static_cast<double>(i % count) / static_cast<double>(count);
      for (const auto channel : {&Trace::velocity, &Trace::friction}) {
        const std::vector<double>& x = sound.*channel;
        const double a = x[knot - count], b = x[knot], c = x[knot + count], d = x[knot + 2 * count];
        (trace.*channel)[i] = b + 0.5 * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)));
      }
    }
    const Motion motion = compute_motion(std::move(trace));
    EXPECT_NEAR(static_cast<double>(motion.size() + motion.trimmed),
                static_cast<double>(sound.size()) / static_cast<double>(count), 2)
        << count;
  }
}

/// Friction behind four poles takes its time at re-stick, where a contact's jumps; a delay does not draw it out.
TEST(Recorders, AFilterOfHigherOrderDrawsTheJumpOut) {
  Trace trace = recorded(5), late = recorded(5);
  for (int pole = 0; pole < 4; ++pole) {
    double y = trace.friction[0];
    for (double& mu : trace.friction) mu = y += 0.1 * (mu - y);  // 300 Hz each
  }
  std::rotate(late.friction.begin(), late.friction.end() - 20, late.friction.end());
  const std::string text = "to fall at re-stick";
  EXPECT_THAT(item(compute_motion(std::move(trace)), "bandwidth").message, HasSubstr(text));
  EXPECT_THAT(item(compute_motion(std::move(late)), "bandwidth").message, Not(HasSubstr(text)));
  for (const double rpm : {1.0, 4.0, 20.0})
    EXPECT_THAT(item(compute_motion(recorded(5, rpm)), "bandwidth").message, Not(HasSubstr(text))) << rpm;
}

/// A friction channel that passes no constant: negative in slip, while its sign is right.
TEST(Recorders, FrictionThatIsNegativeInSlipIsAProblem) {
  for (const int sign : {1, -1}) {
    Trace trace = recorded(8, 20);
    double mean = 0;
    for (const double mu : trace.friction) mean += mu / static_cast<double>(trace.size());
    for (double& mu : trace.friction) mu = sign * mu;
    EXPECT_EQ(item(compute_motion(trace), "friction-zero").status, HealthItem::Status::ok);
    if (sign < 0) continue;
    for (double& mu : trace.friction) mu -= mean;
    EXPECT_EQ(item(compute_motion(std::move(trace)), "friction-zero").status, HealthItem::Status::problem);
  }
}

}  // namespace
}  // namespace tribofit::recorders
