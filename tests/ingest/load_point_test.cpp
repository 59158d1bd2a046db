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

/// xlook and the laboratory at Penn State write them so.
TEST_F(LoadPoint, NamesAndUnitsOfRockMechanics) {
  const Trace xlook =
      read_trace(write("lp_disp,nor_stress,time,mu\nmic,MPa,sec,.\n0,20,0,0.6\n2,20,1,0.61\n4,20,2,0.62\n"));
  ASSERT_EQ(xlook.drive_position.size(), 3U);
  EXPECT_DOUBLE_EQ(xlook.drive_position[2], 4e-6);
  EXPECT_DOUBLE_EQ(xlook.normal_stress.value, 20e6);
  std::string rows = "time_s,vdcdt_um,mu\n";
  for (int i = 0; i < 100; ++i) rows += std::to_string(i) + "," + std::to_string(2 * i) + ",0.6\n";
  const Trace column = read_trace(write(rows, "psu.csv"));
  EXPECT_EQ(column.kind, RecordKind::velocity_steps);
  EXPECT_DOUBLE_EQ(column.drive_position[2], 4e-6);
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

TEST_F(LoadPoint, APlainDisplacementIsItsOwnWhereItGoesOneWay) {
  std::string one_way = "time_s,Velocity (um/s),Displacement (um),mu\n", to_and_fro = "time_s,Displacement (um),mu\n";
  for (int i = 0; i < 100; ++i) {
    const int back = i < 95 ? i : 0;  // where the machine returns to
    one_way += std::to_string(i) + ",2," + std::to_string(2 * back) + ",0.6\n";
    to_and_fro += std::to_string(i) + "," + std::to_string(i % 20 < 10 ? i % 20 : 20 - i % 20) + ",0.6\n";
  }
  const Trace trace = read_trace(write(one_way));
  EXPECT_EQ(trace.kind, RecordKind::velocity_steps);
  EXPECT_EQ(trace.kind_source, "a displacement in one direction is all the motion recorded");
  EXPECT_DOUBLE_EQ(trace.drive_position.at(10), 2e-5);
  expect_error(write(to_and_fro), {}, "no velocity column", "name the columns");
  expect_error(write("time_s,Ft [N],Displacement (um)\n0,29,0\n1,30,2\n2,31,4\n"), {}, "no velocity column",
               "where Displacement (um) is the displacement of a drive");
  ReadOptions named;
  named.columns = {{"x_d", "Displacement"}};
  EXPECT_EQ(read_trace(write(to_and_fro), named).drive_position.size(), 100U);
}

TEST_F(LoadPoint, ASpeedInMicrometresThatIsSetInStepsIsItsOwn) {
  std::string steps = "time_s,Velocity (um/s),mu\n", moves = steps;
  for (int i = 0; i < 100; ++i) {
    steps += std::to_string(i) + (i / 25 % 2 == 0 ? ",2,0.6\n" : ",20,0.6\n");
    moves += std::to_string(i) + "," + std::to_string(2 + i % 9) + ",0.6\n";
  }
  const Trace trace = read_trace(write(steps));
  EXPECT_EQ(trace.kind, RecordKind::velocity_steps);
  EXPECT_DOUBLE_EQ(trace.load_point_speed.at(30), 2e-5);
  EXPECT_NE(read_trace(write(moves)).kind, RecordKind::velocity_steps);
}

TEST_F(LoadPoint, RowsOfOneTimeAndUnitsGivenAsADotAreRead) {
  std::string text = "Time\tLP_Disp\tmu\nsec\tmicron\t.\n";
  for (int i = 0; i < 120; ++i) {
    text += std::to_string(i) + "\t" + std::to_string(i) + "\t0.6\n";
    if (i == 60) text += "60\t60\t0.6\n";  // where the sampling changes
  }
  const Trace trace = read_trace(write(text));
  EXPECT_EQ(trace.size(), 120U);
  ASSERT_EQ(trace.warnings.size(), 1U);
  EXPECT_THAT(trace.warnings.front(), HasSubstr("1 row at the time of the row before was left out"));
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
  expect_error(write("time_s,mu\n0,0.6\n1,0.6\n2,0.6\n"), options, "of the load point", "columns");
}

}  // namespace
}  // namespace tribofit
