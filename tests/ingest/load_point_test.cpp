#include <gtest/gtest.h>

#include "columns.hpp"
#include "temp_files.hpp"

namespace tribofit {
namespace {

using ::testing::HasSubstr;

class LoadPoint : public TempFiles {};

TEST_F(LoadPoint, ADisplacementOfThatNameMakesVelocitySteps) {
  const Trace trace = read_trace(write("time_s,lp_disp_um,mu\n0,0,0.6\n1,2,0.61\n2,4,0.62\n2.01,4.1,0.62\n"));
  EXPECT_EQ(trace.kind, RecordKind::velocity_steps);
  EXPECT_EQ(trace.kind_source, "the motion of a load point was recorded");
  ASSERT_EQ(trace.drive_position.size(), 4U);
  EXPECT_DOUBLE_EQ(trace.drive_position[2], 4e-6);
  EXPECT_TRUE(trace.velocity.empty());
}

TEST_F(LoadPoint, SamplingMayChange) {
  std::string text = "Time (s),Load Point Displacement (mm),Friction\n";
  double t = 0;
  for (int i = 0; i < 400; ++i) {
    text += std::to_string(t) + "," + std::to_string(0.01 * t) + ",0.6\n";
    t += i % 50 < 25 ? 1 : 0.01;  // which a clock of one rate would not do
  }
  const Trace trace = read_trace(write(text));
  EXPECT_EQ(trace.size(), 400U);
  EXPECT_EQ(trace.steps.size(), 1U);
  EXPECT_TRUE(trace.warnings.empty());
}

TEST_F(LoadPoint, ShearStressOverNormalStressIsMu) {
  const Trace trace = read_trace(
      write("time_s,LP disp [um],Shear Stress [MPa],Normal Stress [kPa]\n0,0,3,5000\n1,2,3.1,5000\n2,4,3.2,5000\n"));
  EXPECT_EQ(trace.kind, RecordKind::velocity_steps);
  EXPECT_EQ(trace.friction_kind, FrictionKind::coefficient);
  EXPECT_DOUBLE_EQ(trace.friction[1], 0.62);
  EXPECT_DOUBLE_EQ(trace.normal_stress.value, 5e6);
  EXPECT_FALSE(trace.conditions.load.known());
}

TEST_F(LoadPoint, AStressOverAForceIsRefused) {
  const std::string file =
      write("time_s,lp_disp_um,shear stress [MPa],normal force [N]\n0,0,3,5\n1,2,3.1,5\n2,4,3.2,5\n");
  expect_error(file, {}, "shear stress and the load a force", "both as stresses");
  const std::string alone = write("time_s,lp_disp_um,shear stress [MPa]\n0,0,3\n1,2,3.1\n2,4,3.2\n", "alone.csv");
  expect_error(alone, {}, "needs the normal stress", "load=NAME:MPa");
}

TEST_F(LoadPoint, WhereTheKindIsStatedAnyDisplacementOrSpeedIsItsOwn) {
  ReadOptions options;
  options.kind = RecordKind::slide_hold_slide;
  const Trace by_displacement =
      read_trace(write("time_s,mu,displacement [um]\n0,0.6,0\n1,0.6,10\n2,0.6,20\n"), options);
  EXPECT_DOUBLE_EQ(by_displacement.drive_position.at(1), 1e-5);
  const Trace by_speed = read_trace(write("time_s,mu,velocity [um/s]\n0,0.6,1\n1,0.6,1\n2,0.6,10\n"), options);
  EXPECT_DOUBLE_EQ(by_speed.load_point_speed.at(2), 1e-5);
  options.load_point = {{0, 1e-6}, {1, 1e-5}};
  const Trace stated = read_trace(write("time_s,mu\n0,0.6\n1,0.6\n2,0.6\n"), options);
  EXPECT_EQ(stated.load_point.size(), 2U);
  options.load_point.clear();
  expect_error(write("time_s,mu\n0,0.6\n1,0.6\n2,0.6\n"), options, "of the load point", "--columns");
}

}  // namespace
}  // namespace tribofit
