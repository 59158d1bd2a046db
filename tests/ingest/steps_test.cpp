#include <fmt/format.h>

#include <numbers>

#include "temp_files.hpp"

namespace tribofit {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

using Steps = TempFiles;

std::string stretch(double from, int rows, const std::string& step = {}) {
  std::string text;
  for (int i = 0; i < rows; ++i) text += fmt::format("{:.2f},0.3,120{}\n", from + 0.1 * i, step);
  return text;
}

TEST_F(Steps, AClockThatRestartsGoesOn) {
  const std::string file = write("time_s,mu,speed_rpm\n" + stretch(0.2, 20) + stretch(0.1, 30) + stretch(0.15, 25));
  ReadOptions options;
  options.step_radii = {0.006, 0.009, 0.012};
  const Trace trace = read_trace(file, options);
  ASSERT_EQ(trace.steps.size(), 3U);
  EXPECT_EQ(trace.steps[1].begin, 20U);
  EXPECT_EQ(trace.steps[2].end, 75U);
  for (std::size_t i = 0; i < trace.size(); ++i) EXPECT_NEAR(trace.time[i], 0.1 * static_cast<double>(i), 1e-9);
  EXPECT_EQ(trace.steps[1].conditions.radius.value, 0.009);
  EXPECT_FALSE(trace.conditions.radius.known()) << "the steps differ";
  options.step_radii = {0.006, 0.009};
  expect_error(file, options, "the file has 3 steps", "one radius for each step");
}

TEST_F(Steps, AStepColumnDividesWithoutARestart) {
  const std::string file = write("time_s,mu,speed_rpm,Step\n" + stretch(0, 15, ",4") + stretch(1.5, 15, ",7"));
  ReadOptions options;
  options.conditions.radius = {0.01, "command line"};
  const Trace trace = read_trace(file, options);
  ASSERT_EQ(trace.steps.size(), 2U);
  EXPECT_EQ(trace.steps[0].label, "4");
  EXPECT_EQ(trace.steps[1].label, "7");
  EXPECT_EQ(trace.steps[1].begin, 15U);
  EXPECT_EQ(trace.conditions.radius.value, 0.01);
  EXPECT_THAT(trace.notes, Contains(HasSubstr("the radius of 10 mm was taken for all 2 steps")));
}

TEST_F(Steps, AGapBeginsAStepWithTheSameConditions) {
  const std::string file = write("time_s,mu,speed_rpm\n" + stretch(0, 20) + stretch(2.5, 20));
  ReadOptions options;
  options.step_radii = {0.01};
  const Trace trace = read_trace(file, options);
  ASSERT_EQ(trace.steps.size(), 2U);
  EXPECT_EQ(trace.steps[1].begin, 20U);
  EXPECT_NEAR(trace.time[20], 2.5, 1e-12) << "the gap keeps its time";
  EXPECT_EQ(trace.steps[1].conditions.radius.value, 0.01);
  EXPECT_THAT(trace.warnings, Contains(HasSubstr("1 gap in time, the first of 0.6 s before line 22")));
}

TEST_F(Steps, AColumnThatCountsSamplesOrHoldsLabelsIsNoStep) {
  std::string counter = "time_s,mu,v_b_mm_s,step\n", labels = "time_s,mu,v_b_mm_s,step\n";
  for (int i = 0; i < 50; ++i) {
    counter += fmt::format("{},0.3,6,{}\n", i, i);
    labels += fmt::format("{},0.3,6,{}\n", i, i < 20 ? "run-in" : "test");
  }
  const Trace counted = read_trace(write(counter));
  EXPECT_EQ(counted.steps.size(), 1U);
  EXPECT_THAT(counted.warnings, Contains(HasSubstr("column step changes 49 times")));
  EXPECT_EQ(read_trace(write(labels)).steps.size(), 1U);
}

TEST_F(Steps, FilesContinueARun) {
  const std::string header = "time_s,mu,speed_rpm\n";
  const std::string first = write(header + stretch(0, 20), "a.csv"), second = write(header + stretch(2.0, 20), "b.csv"),
                    third = write(header + stretch(0, 20), "c.csv");
  ReadOptions options;
  options.conditions.radius = {0.01, "command line"};
  options.continued_in = {second, third};
  const Trace trace = read_trace(first, options);
  ASSERT_EQ(trace.size(), 60U);
  for (std::size_t i = 0; i < trace.size(); ++i) EXPECT_NEAR(trace.time[i], 0.1 * static_cast<double>(i), 1e-9);
  ASSERT_EQ(trace.steps.size(), 3U);
  EXPECT_EQ(trace.steps[0].label, "a.csv");
  EXPECT_EQ(trace.steps[2].label, "c.csv");
  EXPECT_EQ(trace.steps[2].begin, 40U);
  ReadOptions alone;
  alone.conditions = options.conditions;
  EXPECT_NE(trace.checksum, read_trace(first, alone).checksum);
  options.continued_in = {write("time_s,mu,v_b_mm_s\n0,0.3,1\n1,0.3,1\n", "d.csv")};
  EXPECT_THROW(read_trace(first, options), InputError);
}

TEST_F(Steps, AnAngleThatWrapsIsUnwrapped) {
  std::string text = "time_s,mu,v_b_mm_s,angle_deg\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("{},0.3,6,{}\n", i, (350 + 10 * i) % 360);
  const Trace trace = read_trace(write(text));
  EXPECT_NEAR(trace.disc_angle.back() - trace.disc_angle.front(), 990 * std::numbers::pi / 180, 1e-9);
}

TEST_F(Steps, TheRateIsThatBetweenTheGaps) {
  const Trace gap = read_trace(write("time_s,mu,v_b_mm_s\n" + stretch(0, 40) + stretch(50, 40)));
  EXPECT_NEAR(gap.rate(), 10, 1e-9);
  // A clock written with too few digits: intervals of 3, 3 and 4 units are a third of 10 units each.
  std::string rounded = "time_s,mu,v_b_mm_s\n";
  for (int i = 0; i <= 300; ++i) rounded += fmt::format("{:.1f},0.3,6\n", i / 3.0);
  EXPECT_NEAR(read_trace(write(rounded)).rate(), 3, 1e-9);
}

}  // namespace
}  // namespace tribofit
