#include <fmt/format.h>

#include <cmath>
#include <random>

#include "temp_files.hpp"
#include "tribofit/kinematics/clock_offset.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/simulate.hpp"

namespace tribofit {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// Stick-slip of the 15 mm test of [D], simulated; cycles differ in length as their break-away level scatters.
struct StickSlip {
  SimulatedMotion motion;

  explicit StickSlip(double duration) {
    const PublishedTest test = published_test(0.015, ExponentialLaw{});
    const std::vector<double> p = test.friction;
    Drive drive;
    drive.speed = constant_speed(test.speed);
    drive.radius = test.radius;
    drive.mean_load = test.load;
    SimulationOptions options;
    options.duration = duration;
    options.settle = settling_time(test.rig, drive, p);
    options.scatter = {0.01, 0};
    options.seed = 5;
    motion = simulate(test.rig, drive, FrictionModel(ExponentialLaw{}), p, options);
  }
  /// mu and v_b [mm/s] at time t
  std::pair<double, double> at(double t) const {
    const double place = t * motion.rate;
    const auto i = std::min(static_cast<std::size_t>(place), motion.size() - 2);
    const double part = place - static_cast<double>(i);
    const auto between = [&](const std::vector<double>& x) { return x[i] + part * (x[i + 1] - x[i]); };
    return {between(motion.friction), 1e3 * between(motion.velocity)};
  }
};

class Join : public TempFiles {
 protected:
  static ReadOptions with(const std::string& second_file) {
    ReadOptions options;
    options.second_file = second_file;
    options.clock_offset = estimate_clock_offset;
    return options;
  }
  /// Two files of one run; the second clock shows `offset` less than the first.
  std::pair<std::string, std::string> record(double offset, double friction_rate, double velocity_rate) const {
    const double duration = 20;
    const StickSlip motion(duration + 5);
    std::mt19937_64 random(11);
    std::normal_distribution<double> noise(0, 1);
    std::string friction = "time_s,COF\n", velocity = "t [ms];v_b [mm/s]\n";
    for (double t = 1; t < duration; t += 1 / friction_rate)
      friction += fmt::format("{:.6f},{:.5f}\n", t, motion.at(t).first + 0.003 * noise(random));
    for (double t = 1.6; t < duration - 0.7; t += 1 / velocity_rate)
      velocity += fmt::format("{:.4f};{:.4f}\n", 1e3 * (t - offset), motion.at(t).second + 0.02 * noise(random));
    return {write(friction, "friction.csv"), write(velocity, "velocity.csv")};
  }
};

TEST_F(Join, TheOffsetOfTheClocksIsFoundFromBreakAway) {
  for (const double offset : {0.0, 1.2345, -0.8}) {
    const auto [friction, velocity] = record(offset, 1000, 2500);
    ReadOptions options = with(velocity);
    const Trace trace = read_trace(friction, options);
    ASSERT_FALSE(trace.velocity.empty());
    EXPECT_EQ(trace.velocity.size(), trace.time.size());
    EXPECT_NEAR(trace.rate(), 1000, 1e-3);
    EXPECT_THAT(trace.notes, Contains(HasSubstr("clock offset from")));
    EXPECT_THAT(trace.notes, Contains(HasSubstr("outside the common time")));
    // the truth: the time base starts where the velocity's record does, at 1.6 s
    const StickSlip motion(25);
    double worst = 0;
    for (std::size_t i = 0; i < trace.size(); i += 7) {
      const double t = 1.6 + trace.time[i];
      const auto [mu, v] = motion.at(t);
      const double before = motion.at(t - 1.2e-3).second, after = motion.at(t + 1.2e-3).second;
      const double low = std::min({before, v, after}), high = std::max({before, v, after});
      worst = std::max(worst, std::max(low - 1e3 * trace.velocity[i], 1e3 * trace.velocity[i] - high));
    }
    EXPECT_LT(worst, 0.3) << "velocity is further off than a shift of 1.2 ms and noise explain, offset " << offset;
  }
}

TEST_F(Join, TheOffsetIsWithinItsUncertaintyOfTheTruth) {
  const StickSlip motion(25);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 1);
  std::vector<double> friction_time, friction, velocity_time, velocity;
  for (double t = 0; t < 20; t += 1e-3) {
    friction_time.push_back(t);
    friction.push_back(motion.at(t).first + 0.003 * noise(random));
  }
  for (double t = 0.5; t < 19; t += 0.7e-3) {
    velocity_time.push_back(t - 0.31415);
    velocity.push_back(1e-3 * (motion.at(t).second + 0.02 * noise(random)));
  }
  const ClockOffset found = estimate_clock_offset(friction_time, friction, velocity_time, velocity);
  EXPECT_GT(found.events, 40U);
  EXPECT_NEAR(found.offset, 0.31415, 2e-4);
  EXPECT_LT(found.uncertainty, 2e-4);
}

TEST_F(Join, TheFrictionMayBeInTheSecondFile) {
  const auto [friction, velocity] = record(0.5, 1000, 1000);
  ReadOptions options = with(friction);
  const Trace trace = read_trace(velocity, options);
  EXPECT_GT(trace.size(), 10000U);
  EXPECT_THAT(trace.notes, Contains(HasSubstr("the friction is in the second file")));
}

TEST_F(Join, WithoutBreakAwayTheTimesAreTakenAsWritten) {
  std::string friction = "time_s,mu\n", velocity = "time_s,v_r_mm_s\n";
  for (int i = 0; i < 100; ++i) friction += fmt::format("{},0.3\n", i);
  for (int i = 0; i < 50; ++i) velocity += fmt::format("{},{}\n", 2 * i + 10, i);
  ReadOptions options = with(write(velocity, "v.csv"));
  const Trace trace = read_trace(write(friction, "mu.csv"), options);
  EXPECT_THAT(trace.warnings, Contains(HasSubstr("the times were taken as written")));
  ASSERT_EQ(trace.size(), 90U);
  EXPECT_NEAR(trace.velocity[1], 0.5e-3, 1e-12) << "halfway between two samples of the slower instrument";
}

TEST_F(Join, ClocksThatNobodyComparesAreTakenAsWritten) {
  const auto [friction, velocity] = record(0, 500, 500);
  ReadOptions options = with(velocity);
  options.clock_offset = nullptr;
  EXPECT_THAT(read_trace(friction, options).warnings,
              Contains(HasSubstr("were not compared; the times were taken as written")));
}

TEST_F(Join, FilesThatDoNotFitAreRefused) {
  const std::string both = write("time_s,mu,v_b_mm_s\n0,1,1\n1,1,1\n2,1,1\n", "both.csv");
  const std::string other = write("time_s,v_b_mm_s\n0,1\n1,1\n2,1\n", "other.csv");
  ReadOptions options = with(other);
  try {
    read_trace(both, options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().file, other);
    EXPECT_THAT(error.problem(), HasSubstr("holds v_b like"));
  }
}

TEST_F(Join, ColumnsMayBeNamedInEitherFile) {
  const auto [friction, velocity] = record(0.2, 500, 500);
  ReadOptions options = with(velocity);
  options.columns = {{"mu", "COF"}, {"v_b", "v_b [mm/s]"}};
  EXPECT_NO_THROW(read_trace(friction, options));
  options.columns = {{"mu", "COF"}, {"v_b", "absent"}};
  EXPECT_THROW(read_trace(friction, options), InputError);
}

TEST_F(Join, TheSecondFileHasColumnsOfItsOwn) {
  std::string ni = "Time [s],Force [V]\n", drive = "Time [ms],Speed [mm/s],Torque\n";
  for (int i = 0; i < 60; ++i) {
    ni += fmt::format("{},{}\n", 0.001 * i, 0.1 + 0.001 * i);
    drive += fmt::format("{},{},-3\n", i, 100 + i);
  }
  const std::string first = write(ni, "ni.csv");
  ReadOptions options;
  options.columns = {{"force", "Force:10N/V"}};
  options.second_file = write(drive, "drive.csv");
  options.second_columns = {{"v_r", "Speed"}};
  const Trace trace = read_trace(first, options);
  EXPECT_NEAR(trace.friction[7], 1.07, 1e-12) << "the drive's torque is not friction where the first file names it";
  EXPECT_NEAR(trace.velocity[7], 0.107, 1e-9);
  options.second_columns = {{"v_r", "Velocity"}};
  EXPECT_THROW(read_trace(first, options), InputError);
}

}  // namespace
}  // namespace tribofit
