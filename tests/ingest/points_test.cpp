#include "temp_files.hpp"

#include <fmt/format.h>

#include <algorithm>

// Tables of steady points: rows of friction and sliding velocity that no clock orders.

namespace tribofit {
namespace {

using ::testing::Contains;
using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class Points : public TempFiles {};

TEST_F(Points, ATableWithoutATimeIsOfPointsInTheOrderOfTheirSpeeds) {
  const Trace trace = read_trace(write("v_r [mm/s],mu,std_error\n20,0.30,0.01\n5,0.40,0.02\n10,0.35,0.01\n"));
  EXPECT_EQ(trace.kind, RecordKind::points);
  EXPECT_EQ(trace.kind_source, "no time column");
  EXPECT_THAT(trace.velocity, ElementsAre(0.005, 0.010, 0.020));
  EXPECT_THAT(trace.friction, ElementsAre(0.40, 0.35, 0.30));
  EXPECT_THAT(trace.friction_std_error, ElementsAre(0.02, 0.01, 0.01));
  EXPECT_THAT(trace.time, ElementsAre(0, 1, 2));
  const Trace shuffled =
      read_trace(write("v_r [mm/s],mu,std_error\n10,0.35,0.01\n20,0.30,0.01\n5,0.40,0.02\n", "shuffled.csv"));
  EXPECT_EQ(shuffled.checksum, trace.checksum);
  EXPECT_EQ(shuffled.velocity, trace.velocity);
}

TEST_F(Points, AVelocityWithoutAnOwnerIsTheSlidingVelocityButThatOfABlockIsNot) {
  const Trace trace = read_trace(write("velocity [m/s],force [N]\n0.2,3\n-0.1,-4\n"));
  EXPECT_EQ(trace.kind, RecordKind::points);
  EXPECT_EQ(trace.velocity_kind, VelocityKind::relative);
  EXPECT_THAT(trace.velocity, ElementsAre(-0.1, 0.2));
  const std::string block = write("mu,v_b [mm/s]\n0.3,2\n0.2,4\n", "block.csv");
  expect_error(block, {}, "no time column", "kind points");
  ReadOptions stated;
  stated.kind = RecordKind::points;
  EXPECT_THAT(read_trace(block, stated).velocity, ElementsAre(0.002, 0.004));
}

TEST_F(Points, ARateOrAnIntervalMakesARecordOfTheRows) {
  const std::string file = write("v_r [mm/s],mu\n20,0.30\n5,0.40\n10,0.35\n");
  ReadOptions options;
  options.rate = 10;
  EXPECT_FALSE(read_trace(file, options).kind.has_value());
  options.kind = RecordKind::points;
  EXPECT_THAT(read_trace(file, options).velocity, ElementsAre(0.005, 0.010, 0.020));
  EXPECT_FALSE(read_trace(write("dt: 0.1 s\nv_r [mm/s],mu\n20,0.30\n5,0.40\n10,0.35\n", "b.csv")).kind.has_value());
}

TEST_F(Points, TimesInNoOrderAreNoClock) {
  std::string text = "time_s,v_r [mm/s],mu\n";
  for (int i = 0; i < 40; ++i) text += std::to_string(i * 17 % 40) + "," + std::to_string(5 + i) + ",0.3\n";
  const Trace trace = read_trace(write(text));
  EXPECT_EQ(trace.kind, RecordKind::points);
  EXPECT_EQ(trace.kind_source, "the times are in no order");
  std::string ordered = "time_s,v_r [mm/s],mu\n";
  for (int i = 0; i < 40; ++i) ordered += std::to_string(i) + "," + std::to_string(5 + i) + ",0.3\n";
  const std::string file = write(ordered, "ordered.csv");
  EXPECT_FALSE(read_trace(file).kind.has_value());
  ReadOptions stated;
  stated.kind = RecordKind::points;
  EXPECT_EQ(read_trace(file, stated).kind, RecordKind::points);
}

TEST_F(Points, ALongTableWithoutATimeIsARecordWhoseRateIsMissing) {
  std::string text = "v_r [mm/s],mu\n";
  for (int i = 0; i < 6000; ++i) text += std::to_string(5 + i % 100) + ",0.3\n";
  const std::string file = write(text);
  expect_error(file, {}, "no time column", "rate");
  ReadOptions stated;
  stated.kind = RecordKind::points;
  EXPECT_EQ(read_trace(file, stated).size(), 6000U);
}

TEST_F(Points, ARecordOfAJointNeedsNoRadiusAndOneOfADiscDoes) {
  std::string joint = "time [s],v_r [rad/s],torque [Nm]\n", disc = "time [s],speed [rpm],torque [Nm]\n";
  for (int i = 0; i < 40; ++i) {
    joint += fmt::format("{:.2f},{},2\n", 0.01 * i, 0.5 + 0.001 * i);
    disc += fmt::format("{:.2f},{},2\n", 0.01 * i, 60 + 0.1 * i);
  }
  const Trace trace = read_trace(write(joint));
  EXPECT_DOUBLE_EQ(trace.velocity.front(), 0.5);
  EXPECT_THAT(trace.notes, Contains(HasSubstr("lever of 1 m")));
  expect_error(write(disc), {}, "needs the friction radius", "radius");
  write(joint);
  ReadOptions loaded;  // a coefficient needs the radius
  loaded.conditions.load = {50, "command line"};
  expect_error(path("trace.csv"), loaded, "needs the friction radius", "radius");
}

TEST_F(Points, AJointWithoutARadiusHasALeverOfAMetre) {
  const Trace trace = read_trace(write("velocity [rad/s],torque [Nm],std_error [Nm]\n0.5,2,0.1\n-0.5,-2.5,0.2\n"));
  EXPECT_THAT(trace.velocity, ElementsAre(-0.5, 0.5));
  EXPECT_THAT(trace.friction, ElementsAre(-2.5, 2));
  EXPECT_THAT(trace.friction_std_error, ElementsAre(0.2, 0.1));
  EXPECT_EQ(trace.friction_kind, FrictionKind::force);
  EXPECT_THAT(trace.notes, Contains(HasSubstr("lever of 1 m")));
  ReadOptions options;
  options.conditions.radius = {0.1, "command line"};
  options.conditions.load = {10, "command line"};
  const Trace arm = read_trace(path("trace.csv"), options);
  EXPECT_THAT(arm.velocity, ElementsAre(-0.05, 0.05));
  EXPECT_THAT(arm.friction, ElementsAre(-2.5, 2));
  EXPECT_THAT(arm.friction_std_error, ElementsAre(0.2, 0.1));
}

TEST_F(Points, AStandardErrorHasTheUnitOfItsFrictionAndIsAboveZero) {
  const Trace trace = read_trace(write("v_r [mm/s],friction force [mN],std_error\n5,400,20\n10,350,10\n"));
  EXPECT_THAT(trace.friction_std_error, ElementsAre(0.02, 0.01));
  const std::string file = write("v_r [mm/s],mu,std_error\n5,0.4,0.1\n10,0.3,0\n", "zero.csv");
  expect_error(file, {}, "above zero", "std_error=none", 3, "std_error");
  ReadOptions without;
  without.columns = {{"std_error", "none"}};
  EXPECT_THAT(read_trace(file, without).friction_std_error, IsEmpty());
}

TEST_F(Points, FilesOfPointsAddUpButCannotBeJoined) {
  const std::string one = write("v_r [mm/s],mu\n20,0.30\n5,0.40\n"), two = write("v_r [mm/s],mu\n10,0.35\n", "b.csv");
  ReadOptions more;
  more.continued_in = {two};
  EXPECT_THAT(read_trace(one, more).velocity, ElementsAre(0.005, 0.010, 0.020));
  ReadOptions joined;
  joined.kind = RecordKind::points;
  joined.second_file = two;
  try {
    read_trace(one, joined);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.problem(), HasSubstr("no time on which"));
  }
}

/// The pull of a spring alone is a record of a slider on it.
TEST_F(Points, ThePullOfASpringIsAnotherKind) {
  const std::string file = write("time_s,spring [mN]\n0,100\n1,200\n2,300\n");
  const Trace trace = read_trace(file);
  EXPECT_EQ(trace.kind, RecordKind::spring_slider);
  EXPECT_EQ(trace.friction_kind, FrictionKind::force);
  EXPECT_THAT(trace.friction, ElementsAre(0.1, 0.2, 0.3));
  ReadOptions over_load;
  over_load.kind = RecordKind::spring_slider;
  over_load.columns = {{"spring", "spring:1"}};
  EXPECT_EQ(read_trace(file, over_load).friction_kind, FrictionKind::coefficient);
  ReadOptions loaded;
  loaded.conditions.load = {2, "command line"};
  EXPECT_THAT(read_trace(file, loaded).friction, ElementsAre(0.05, 0.1, 0.15));
}

/// So is the motion of a mass alone.
TEST_F(Points, DisplacementsAloneAreAMotion) {
  const Trace trace = read_trace(write("time_s,x_b [um],x_d [mm]\n0,100,1\n1,200,2\n2,300,4\n"));
  EXPECT_EQ(trace.kind, RecordKind::motion_only);
  EXPECT_THAT(trace.block_position, ElementsAre(DoubleEq(1e-4), DoubleEq(2e-4), DoubleEq(3e-4)));
  EXPECT_THAT(trace.drive_position, ElementsAre(0.001, 0.002, 0.004));
  EXPECT_THAT(trace.friction, IsEmpty());
  EXPECT_THAT(trace.velocity, IsEmpty());
  EXPECT_THROW(read_trace(write("time_s,x_b\n0,100\n1,200\n2,300\n")), InputError) << "no unit";
}

TEST_F(Points, DisplacementsBesideFrictionGiveTheVelocityWhereThatIsNotThere) {
  const Trace both = read_trace(write("time_s,mu,x_b [mm],x_d [mm]\n0,0.3,1,1\n1,0.4,2,2\n2,0.3,3,4\n"));
  EXPECT_EQ(both.kind, std::nullopt);
  EXPECT_EQ(both.velocity_kind, VelocityKind::relative);
  EXPECT_THAT(both.block_position, SizeIs(3));
  const std::string file = write("time_s,mu,v_b [mm/s],x_b [mm]\n0,0.3,1,1\n1,0.4,2,2\n2,0.3,3,4\n");
  EXPECT_THAT(read_trace(file).velocity, ElementsAre(0.001, 0.002, 0.003));
  EXPECT_THAT(read_trace(file).block_position, IsEmpty());
  ReadOptions named;
  named.columns = {{"x_b", "x_b [mm]"}};
  EXPECT_THAT(read_trace(file, named).velocity, IsEmpty());
  EXPECT_EQ(read_trace(file, named).velocity_kind, VelocityKind::block);
}

TEST_F(Points, FrictionAloneIsARecordOfItsOwnWhereNothingElseIsInTheFile) {
  const Trace trace = read_trace(write("time_s,force [N]\n0,1\n1,2\n2,3\n"));
  EXPECT_EQ(trace.kind, RecordKind::force_only);
  EXPECT_EQ(trace.friction_kind, FrictionKind::force);
  EXPECT_THROW(read_trace(write("time_s,force [N],c\n0,1,1\n1,2,1\n2,3,1\n")), InputError) << "c may be a velocity";
  ReadOptions stated;
  stated.kind = RecordKind::force_only;
  EXPECT_EQ(read_trace(write("time_s,force [N],c\n0,1,1\n1,2,1\n2,3,1\n"), stated).kind, RecordKind::force_only);
}

}  // namespace
}  // namespace tribofit
