#include <fmt/format.h>

#include <functional>
#include <numbers>

#include "temp_files.hpp"

namespace tribofit {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Text as the instruments of laboratories write it.
using LaboratoryText = TempFiles;

struct Blanks {
  const char* name;
  const char* heading;
  const char* row;  // of time, friction, velocity
  const char* line_end = "\n";
};

class BlankColumns : public TempFiles, public ::testing::WithParamInterface<Blanks> {};

TEST_P(BlankColumns, AreReadWithoutBeingTold) {
  std::string text = GetParam().heading;
  for (int i = 0; i < 40; ++i) {
    text += fmt::format(fmt::runtime(GetParam().row), fmt::format("{:.2f}", 0.05 * i),
                        fmt::format("{:.2f}", 0.3 + 0.01 * i), fmt::format("{:.3f}", 6.25 - 0.5 * i)) +
            GetParam().line_end;
  }
  const Trace trace = read_trace(write(text, "table.txt"));
  ASSERT_EQ(trace.size(), 40U);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_NEAR(trace.time[i], 0.05 * static_cast<double>(i), 1e-12);
    EXPECT_NEAR(trace.friction[i], 0.3 + 0.01 * static_cast<double>(i), 1e-12);
    EXPECT_NEAR(trace.velocity[i], 1e-3 * (6.25 - 0.5 * static_cast<double>(i)), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Text, BlankColumns,
    ::testing::Values(Blanks{"One", "time_s mu v_b_mm_s\n", "{} {} {}"},
                      Blanks{"Aligned", "   time_s      mu     v_b_mm_s\n", "{:>10}  {:>8}{:>12}"},
                      Blanks{"TabsAndBlanks", "time_s mu v_b_mm_s\n", "{}\t {}  \t{}"},
                      Blanks{"NamesOfWords", "Time (s)   Friction coefficient   Block velocity (mm/s)\n", "{} {} {}"},
                      Blanks{"UnitsInBrackets", "Time (s) COF v_b [mm/s]\n", "{} {} {}"},
                      Blanks{"UnitsBelow", "time COF v_b\ns - mm/s\n", " {} {} {}"},
                      Blanks{"TabbedHeading", "Time (s)\tCOF\tBlock velocity (mm/s)\n", "{} {} {}"},
                      Blanks{"Comment", "% Rig 3, 12 May\n% time_s mu v_b_mm_s\n", "{} {} {}"},
                      Blanks{"Preamble", "Test of the rig 3\nOperator none\n\ntime_s mu v_b_mm_s\n", "{} {} {}"},
                      Blanks{"LoneCr", "time_s,mu,v_b_mm_s\r", "{},{},{}", "\r"},
                      Blanks{"LoneCrBlanks", "time_s mu v_b_mm_s\r", "{} {} {}", "\r"},
                      Blanks{"CrLf", "time_s mu v_b_mm_s\r\n", "{} {} {}", "\r\n"}),
    [](const auto& param) { return std::string(param.param.name); });

/// A logger writes a clock: over midnight, with a date; without one, within a day.
TEST_F(LaboratoryText, ATimeColumnMayBeAClock) {
  const auto hours_of = [](int i) {
    return fmt::format("{:02}:{:02}:{:02}", (23 + i / 36000) % 24, i / 600 % 60, i / 10 % 60);
  };
  const auto table = [&](const std::function<std::string(int)>& clock, const char* heading, char sign) {
    std::string text = heading;
    for (int i = 35980; i < 36020; ++i) text += fmt::format("{0}{1}{2}{1}{3}\n", clock(i), sign, i % 7, i % 5);
    return text;
  };
  const auto iso = [&](int i) { return fmt::format("2024-02-{}T{}.{}00", i < 36000 ? 28 : 29, hours_of(i), i % 10); };
  const auto german = [&](int i) { return fmt::format("{}.12.2023 {},{}", i < 36000 ? 30 : 31, hours_of(i), i % 10); };
  const auto bare = [&](int i) { return fmt::format("12:{:02}:{:02}.{}", i / 600 % 60, i / 10 % 60, i % 10); };
  const std::vector<std::string> texts = {table(iso, "time,mu,v_b_mm_s\n", ','),
                                          table(german, "Zeit;mu;v_b_mm_s\n", ';')};
  for (const std::string& text : texts) {
    const Trace trace = read_trace(write(text, "clock.csv"));
    ASSERT_EQ(trace.size(), 40U) << text;
    for (std::size_t i = 0; i < 40; ++i)
      EXPECT_NEAR(trace.time[i] - trace.time[0], 0.1 * static_cast<double>(i), 1e-6) << text;
  }
  std::string day = "time,mu,v_b_mm_s\n";
  for (int i = 0; i < 40; ++i) day += bare(i) + ",0.3,1\n";
  const Trace trace = read_trace(write(day, "day.csv"));
  EXPECT_NEAR(trace.time.back() - trace.time.front(), 3.9, 1e-9);
  // May or March?
  const std::string either = "time,mu,v_b_mm_s\n5/3/2024 12:00:00,0.3,1\n5/3/2024 12:00:01,0.3,1\n";
  expect_error(write(either, "either.csv"), {}, "is not a number", "correct it", 2, "time");
}

TEST_F(LaboratoryText, BlanksWithADecimalComma) {
  std::string text = "time_s mu v_b_mm_s\n";
  for (int i = 0; i < 20; ++i) text += fmt::format("0,{:02} 0,41{} 6,2{}\n", i, i % 10, i % 10);
  const Trace trace = read_trace(write(text));
  EXPECT_EQ(trace.size(), 20U);
  EXPECT_DOUBLE_EQ(trace.friction[3], 0.413);
}

TEST_F(LaboratoryText, AFooterIsNoRow) {
  const std::string rows = "0,0.1,1\n1,0.2,2\n2,0.3,3\n3,0.3,3\n";
  for (const char* footer :
       {"\n\nAll steps completed, test completed normally at 19/08/2016 12:35:32", "\nEnd of data\n", "Mean,,\n"}) {
    const Trace trace = read_trace(write("time_s,mu,v_b_mm_s\n" + rows + footer));
    EXPECT_EQ(trace.size(), 4U) << footer;
    EXPECT_TRUE(trace.warnings.empty()) << trace.warnings.front();
    EXPECT_THAT(trace.notes, Not(Contains(HasSubstr("cut off"))));
  }
  const Trace blanks = read_trace(write("time_s mu v_b_mm_s\n0 0.1 1\n1 0.2 2\n2 0.3 3\nmean friction 0.2\n"));
  EXPECT_EQ(blanks.size(), 3U);
}

/// A step as Bruker's viewer of UMT files writes it.
std::string umt_step(int number, double radius, double force, double from, int rows) {
  std::string text = fmt::format(
      "Step No. {}\r\n\r\nStep Type Code: 0\r\nRadius       = {}\r\nVelocity     = 240\r\n"
      "Set Force    = {}\r\nDuration     = 2.17\r\n\r\n",
      number, radius, force);
  text += "Fx,Fz,X,T,Ff,COF\r\ng,g,mm,sec,g,\r\n\r\n";
  for (int i = 0; i < rows; ++i) {
    text += fmt::format("7.5,{:.3f},{},{:.4f},{:.3f},{:.5f}\r\n", force, radius, from + 0.02 * i, 7.5, 7.5 / -force);
  }
  return text;
}

TEST_F(LaboratoryText, StepsWithConditionsOfTheirOwn) {
  const std::string preamble = "Created by CETR UMT ver.1.136\r\nTotal number of steps = 2\r\n\r\nRun # 1\r\n";
  const std::string file =
      write(preamble + umt_step(1, 3.95, -200, 0, 30) + "\r\n" + umt_step(2, 6, -500, 0, 40) + "\r\n\r\n");
  ReadOptions options;
  options.columns = {{"v_b", "none"}};
  options.conditions.speed = {25, "command line"};
  const Trace trace = read_trace(file, options);
  ASSERT_EQ(trace.size(), 70U);
  ASSERT_EQ(trace.steps.size(), 2U);
  EXPECT_EQ(trace.steps[0].label, "1");
  EXPECT_EQ(trace.steps[1].label, "2");
  EXPECT_EQ(trace.steps[1].begin, 30U);
  EXPECT_NEAR(trace.steps[0].conditions.radius.value, 3.95e-3, 1e-12) << "in the unit of the lengths of the table";
  EXPECT_NEAR(trace.steps[1].conditions.radius.value, 6e-3, 1e-12);
  EXPECT_NEAR(trace.steps[0].conditions.load.value, 0.2 * 9.80665, 1e-9) << "gram-force, compression";
  EXPECT_NEAR(trace.steps[1].conditions.load.value, 0.5 * 9.80665, 1e-9);
  EXPECT_NEAR(trace.load[0], 0.2 * 9.80665, 1e-9);
  EXPECT_FALSE(trace.conditions.radius.known());
  EXPECT_THAT(trace.notes, Contains(HasSubstr("'Velocity: 240' in line 9 has no unit")));
  EXPECT_TRUE(trace.warnings.empty()) << trace.warnings.front();
}

TEST_F(LaboratoryText, OtherColumnsInALaterStepAreRefused) {
  std::string text = "Step 1\ntime_s,mu,v_b_mm_s\n";
  for (int i = 0; i < 20; ++i) text += fmt::format("{},0.3,6\n", i);
  text += "Step 2\ntime_s,v_b_mm_s,mu\n";
  for (int i = 0; i < 20; ++i) text += fmt::format("{},6,0.3\n", i);
  expect_error(write(text), {}, "the columns change here", "split the file", 24);
}

TEST_F(LaboratoryText, ThePreambleStatesTheConditions) {
  const std::string rows = "time_s,mu,v_b_mm_s\n0,0.1,1\n1,0.2,2\n2,0.3,3\n";
  const Trace trace = read_trace(write("Radius [mm]: 15\nSpeed: 4 rpm\nNormal load = 5 kgf\n" + rows));
  EXPECT_NEAR(trace.conditions.radius.value, 0.015, 1e-15);
  EXPECT_EQ(trace.conditions.radius.source, "file");
  EXPECT_NEAR(trace.conditions.speed.value, 4 * 2 * std::numbers::pi / 60, 1e-12);
  EXPECT_NEAR(trace.conditions.load.value, 49.03325, 1e-9);
  const Trace linear = read_trace(write("Track radius: 20 mm\nSliding speed: 10 mm/s\n" + rows));
  EXPECT_FALSE(linear.conditions.speed.known()) << "what slides is not named as the disc's speed";
  ReadOptions options;
  options.conditions.radius = {0.02, "command line"};
  EXPECT_EQ(read_trace(write("Radius [mm]: 15\n" + rows), options).conditions.radius.value, 0.02);
}

TEST_F(LaboratoryText, BlocksBesideEachOther) {
  std::string text =
      "\xEF\xBB\xBFTimestamp,2020-03-16 17:04:51,Timestamp,2020-03-16 17:04:51\r\nInterval,0.0005,Interval,0.0005\r\n"
      "Channel name,\"Force\",Channel name,\"Input 1\"\r\nUnit,\"V\",Unit,\"V\"\r\n";
  for (int i = 0; i < 30; ++i) text += fmt::format("{0},0.{1:02},{0},1.{1:02}\r\n", 0.0005 * i, i);
  ReadOptions options;
  options.columns = {{"force", "Force:10N/V"}, {"v_r", "Input 1:2mm/s/V"}};
  const Trace trace = read_trace(write(text), options);
  ASSERT_EQ(trace.size(), 30U);
  EXPECT_NEAR(trace.rate(), 2000, 1e-6);
  EXPECT_NEAR(trace.friction[7], 0.7, 1e-12);
  EXPECT_NEAR(trace.velocity[7], 2.14e-3, 1e-15);
}

TEST_F(LaboratoryText, ABlockMayEndBeforeTheOther) {
  std::string text = "Time (s)\tCOF\t\tTime (s)\tVelocity (mm/s)\n";
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("{:.2f}\t{:.3f}\t\t", 0.1 * i, 0.3 + 0.001 * i);
    text += i < 40 ? fmt::format("{:.2f}\t{:.3f}\n", 0.15 * i, 6 + 0.15 * i) : "\t\n";
  }
  const Trace trace = read_trace(write(text));
  ASSERT_EQ(trace.size(), 59U) << "those in the time of both";
  EXPECT_NEAR(trace.velocity[30], 9e-3, 1e-9) << "interpolated on the clock of friction";
}

TEST_F(LaboratoryText, UnitsOfASecondHeaderRow) {
  std::string text = "Axis1\nTime,Analog 1,Analog 2\nms,Servo motor speed,Torque\n";
  for (int i = 0; i < 30; ++i) text += fmt::format("{},{},-1.5\n", 0.5 * i, 100 + i);
  ReadOptions options;
  options.columns = {{"v_r", "Servo motor speed:mm/s"}, {"mu", "Torque:%"}};
  const Trace trace = read_trace(write(text), options);
  EXPECT_NEAR(trace.rate(), 2000, 1e-6);
  EXPECT_NEAR(trace.velocity[3], 0.103, 1e-12);
  EXPECT_NEAR(trace.friction[3], -0.015, 1e-15);
}

TEST_F(LaboratoryText, MeasurementFilesOfLabVIEW) {
  const std::string above =
      "LabVIEW Measurement\t\nSeparator\tTab\nTime\t17:04:51.123\n***End_of_Header***\t\n\t\nChannels\t2\t\n"
      "Samples\t40\t40\t\nY_Unit_Label\tNewton\tmm/s\t\nX0\t0.0E+0\t0.0E+0\t\nDelta_X\t0.002\t0.002\t\n"
      "***End_of_Header***\t\t\t\n";
  std::string with = above + "X_Value\tFriction force\tVelocity\tComment\n",
              without = above + "\tFriction force\tVelocity\tComment\n";
  for (int i = 0; i < 40; ++i) {
    with += fmt::format("{:.6f}\t{}\t{}\t\n", 0.002 * i, 10 + i, 6.5);
    without += fmt::format("\t{}\t{}\t\n", 10 + i, 6.5);
  }
  for (const std::string& text : {with, without}) {
    const Trace trace = read_trace(write(text, "run.lvm"));
    ASSERT_EQ(trace.size(), 40U);
    EXPECT_NEAR(trace.rate(), 500, 1e-6);
    EXPECT_EQ(trace.friction[3], 13);
    EXPECT_DOUBLE_EQ(trace.velocity[3], 6.5e-3);
  }
}

TEST_F(LaboratoryText, UnitsOfForceAndTorque) {
  const auto reads = [&](const std::string& unit) {
    return read_trace(write("time [s],Ft [" + unit + "],v_b [mm/s]\n0,2,1\n1,2,2\n2,2,3\n")).friction[0];
  };
  EXPECT_NEAR(reads("kgf"), 19.6133, 1e-9);
  EXPECT_NEAR(reads("gf"), 0.0196133, 1e-12);
  EXPECT_NEAR(reads("g"), 0.0196133, 1e-12) << "a mass stands for what it weighs";
  EXPECT_NEAR(reads("lbf"), 8.896443230521, 1e-9);
  EXPECT_NEAR(reads("lb"), 8.896443230521, 1e-9);
  EXPECT_NEAR(reads("kip"), 8896.443230521, 1e-6);
  const Trace share = read_trace(write("time [s],Ft [% of load],v_b [mm/s]\n0,31,1\n1,31,2\n2,31,3\n"));
  EXPECT_EQ(share.friction_kind, FrictionKind::coefficient);
  EXPECT_NEAR(share.friction[0], 0.31, 1e-15);
  ReadOptions options;
  options.conditions.radius = {0.5, "command line"};
  const auto torque = [&](const std::string& unit) {
    return read_trace(write("time [s],torque [" + unit + "],v_b [mm/s]\n0,1,1\n1,1,2\n2,1,3\n"), options).friction[0];
  };
  EXPECT_NEAR(torque("ft-lb"), 2 * 1.3558179483314004, 1e-12);
  EXPECT_NEAR(torque("lbf in"), 2 * 0.1129848290276167, 1e-12);
  EXPECT_NEAR(torque("kgf.cm"), 2 * 0.0980665, 1e-12);
  EXPECT_NEAR(torque("oz-in"), 2 * 0.007061551814226, 1e-12);
}

TEST_F(LaboratoryText, TheRefusalNamesTheVerbThatListsTheColumns) {
  expect_error(write("a,b,c\n1,2,3\n2,3,4\n"), {}, "no recognisable columns", "'identify columns ");
}

}  // namespace
}  // namespace tribofit
