#include "columns.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "temp_files.hpp"

namespace tribofit {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double turn = 2 * std::numbers::pi;

TEST(ColumnNames, AreTakenApart) {
  struct Case {
    const char *name, *base, *unit;
  };
  for (const Case& c : {Case{"v_b_mm_s", "vb", "mm/s"},
                        {"time_s", "time", "s"},
                        {"load_N", "load", "N"},
                        {"speed_rpm", "speed", "rpm"},
                        {"temperature_C", "temperature", "C"},
                        {"dq_f_m_per_s", "dqf", "m/s"},
                        {"torque_on_bit_Nm", "torqueonbit", "Nm"},
                        {"weight_on_bit_N", "weightonbit", "N"},
                        {"v_b [mm/s]", "vb", "mm/s"},
                        {"DAQ.Fx (N)", "fx", "N"},
                        {"DAQ.COF ()", "cof", ""},
                        {"Rotary.Velocity (rpm)", "velocity", "rpm"},
                        {"RTC.Temperature (\u00b0C)", "temperature", "\u00b0C"},
                        {"a_m_s2", "a", "m/s^2"},
                        {"t / ms", "t", "ms"},
                        {"Zeit in s", "zeit", "s"},
                        {"F_n_N", "fn", "N"}}) {
    const ColumnName name = parse_column_name(c.name);
    EXPECT_EQ(name.base, c.base) << c.name;
    ASSERT_TRUE(name.unit) << c.name;
    EXPECT_EQ(*name.unit, c.unit) << c.name;
  }
  for (const char* name : {"mu", "COF", "v_b", "v_r", "F_N", "F_T", "Fn", "Timestamp", "Friction Coefficient"}) {
    EXPECT_FALSE(parse_column_name(name).unit) << name;
  }
  EXPECT_EQ(parse_column_name("F_N").base, "fn");
}

class Columns_ : public TempFiles {
 protected:
  /// Four rows under `header`; cell k of row i is k + 1 + i / 10.
  Trace read(const std::string& header, const ReadOptions& options = {}) const {
    return read_trace(write(rows(header)), options);
  }
  static std::string rows(const std::string& header) {
    const auto columns = 1 + std::count(header.begin(), header.end(), ',');
    std::string text = header + "\n";
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < columns; ++k) text += fmt::format("{}{}.{}", k > 0 ? "," : "", k + 1, i);
      text += "\n";
    }
    return text;
  }
};

TEST_F(Columns_, FrictionIsRecognisedUnderTheFieldsNames) {
  for (const char* name : {"mu", "COF", "friction", "DAQ.COF", "friction coefficient", "\u03bc", "\u00b5",
                           "Coefficient of friction", "Reibwert"}) {
    const Trace trace = read(std::string("time_s,") + name + ",v_b_mm_s");
    EXPECT_EQ(trace.friction.front(), 2) << name;
    EXPECT_EQ(trace.friction_kind, FrictionKind::coefficient) << name;
  }
}

TEST_F(Columns_, ForceOverLoadIsACoefficient) {
  for (const char* force : {"Ft_N", "Fx [N]", "tangential force (N)", "Friction force [N]", "Force_N", "F_T [N]"}) {
    for (const char* load : {"Fn_N", "Fz [N]", "normal force (N)", "load_N", "weight [N]", "WOB (N)", "F_N [N]"}) {
      const Trace trace = read(fmt::format("time_s,{},{},v_b_mm_s", force, load));
      EXPECT_EQ(trace.friction_kind, FrictionKind::coefficient) << force << load;
      EXPECT_DOUBLE_EQ(trace.friction[1], 2.1 / 3.1) << force << load;
      EXPECT_DOUBLE_EQ(trace.load[1], 3.1);
      EXPECT_THAT(trace.notes, Contains(HasSubstr("over the measured load")));
    }
  }
}

TEST_F(Columns_, ForceWithoutALoadStaysAForceOrIsDividedByTheNominalOne) {
  const Trace force = read("time_s,Ft_kN,v_b_mm_s");
  EXPECT_EQ(force.friction_kind, FrictionKind::force);
  EXPECT_DOUBLE_EQ(force.friction[1], 2100);
  ReadOptions options;
  options.conditions.load = {50, "command line"};
  const Trace nominal = read("time_s,Ft_N,v_b_mm_s", options);
  EXPECT_EQ(nominal.friction_kind, FrictionKind::coefficient);
  EXPECT_DOUBLE_EQ(nominal.friction[1], 2.1 / 50);
}

TEST_F(Columns_, ACoefficientIsPreferredToForcesAndTheLoadKept) {
  const Trace trace = read("time_s,Fx_N,Fz_N,COF,v_b_mm_s");
  EXPECT_EQ(trace.friction.front(), 4);
  EXPECT_EQ(trace.load.front(), 3);
  EXPECT_NEAR(trace.conditions.load.value, 3.15, 1e-12);
  EXPECT_EQ(trace.conditions.load.source, "file");
  ReadOptions options;
  options.columns = {{"force", "Fx_N"}};
  EXPECT_DOUBLE_EQ(read("time_s,Fx_N,Fz_N,COF,v_b_mm_s", options).friction.front(), 2.0 / 3.0)
      << "what the user names comes first";
}

TEST_F(Columns_, TorqueOverRadiusAndLoad) {
  ReadOptions options;
  options.conditions.radius = {0.05, "command line"};
  const Trace trace = read("time_s,torque_Nm,load_N,v_r_mm_s", options);
  EXPECT_DOUBLE_EQ(trace.friction[1], 2.1 / 0.05 / 3.1);
  EXPECT_EQ(trace.velocity_kind, VelocityKind::relative);
}

TEST_F(Columns_, VelocityIsRecognisedUnderTheFieldsNames) {
  for (const char* name : {"v_b_mm_s", "Velocity (mm/s)", "block velocity [mm/s]", "vibrometer [mm/s]"}) {
    const Trace trace = read(fmt::format("time_s,mu,{}", name));
    EXPECT_EQ(trace.velocity_kind, VelocityKind::block) << name;
    EXPECT_DOUBLE_EQ(trace.velocity[1], 3.1e-3) << name;
  }
  for (const char* name : {"v_r [m/s]", "sliding velocity (m/s)", "relative velocity [m/s]", "rubbing velocity [m/s]",
                           "Sliding Speed (m/s)"}) {
    const Trace trace = read(fmt::format("time_s,mu,{}", name));
    EXPECT_EQ(trace.velocity_kind, VelocityKind::relative) << name;
    EXPECT_DOUBLE_EQ(trace.velocity[1], 3.1) << name;
  }
}

TEST_F(Columns_, ADiscSpeedAloneMeansAFixedBlock) {
  ReadOptions options;
  options.conditions.radius = {0.015, "command line"};
  for (const char* name : {"speed_rpm", "rpm", "disc speed [rpm]", "Rotary.Velocity (rpm)", "Drehzahl [1/min]"}) {
    const Trace trace = read(fmt::format("time_s,mu,{}", name), options);
    EXPECT_EQ(trace.velocity_kind, VelocityKind::fixed_block) << name;
    EXPECT_TRUE(trace.velocity.empty());
    EXPECT_DOUBLE_EQ(trace.disc_speed[1], 3.1 * turn / 60) << name;
  }
}

TEST_F(Columns_, ARotationalSpeedNamedAsVelocityIsMultipliedByTheRadius) {
  ReadOptions options;
  options.conditions.radius = {0.05, "command line"};
  options.columns = {{"v_r", "bit_speed_rpm"}};
  const Trace trace = read("time_s,mu,bit_speed_rpm", options);
  EXPECT_EQ(trace.velocity_kind, VelocityKind::relative);
  EXPECT_DOUBLE_EQ(trace.velocity[1], 3.1 * turn / 60 * 0.05);
  options.conditions.radius = {};
  expect_error(path("trace.csv"), options, "a velocity given as a rotational speed needs the friction radius",
               "radius");
}

TEST_F(Columns_, OptionalChannelsComeInSi) {
  const Trace trace = read("time_ms,mu,v_b_mm_s,speed_rpm,load_kN,temperature_C,angle_deg");
  EXPECT_NEAR(trace.time[1], 1e-4, 1e-15);
  EXPECT_DOUBLE_EQ(trace.disc_speed[1], 4.1 * turn / 60);
  EXPECT_DOUBLE_EQ(trace.load[1], 5100);
  EXPECT_DOUBLE_EQ(trace.temperature[1], 6.1);
  EXPECT_DOUBLE_EQ(trace.disc_angle[1], 7.1 * turn / 360);
}

TEST_F(Columns_, UnitsOfTheUserBeatThoseOfTheFile) {
  ReadOptions options;
  options.units = {{"v_b", "m/s"}};
  EXPECT_DOUBLE_EQ(read("time_s,mu,v_b_mm_s", options).velocity[1], 3.1);
  options.units = {{"v_b", "mm/s"}, {"time", "ms"}};
  EXPECT_DOUBLE_EQ(read("time,mu,v_b", options).velocity[1], 3.1e-3);
}

TEST_F(Columns_, VoltsNeedASensitivity) {
  ReadOptions options;
  for (const auto& [text, per_volt] :
       {std::pair{"5 mm/s/V", 5e-3}, {"0.2 V/(mm/s)", 5e-3}, {"5 mm/s/mV", 5.0}, {"200 mV/(mm/s)", 5e-3}}) {
    options.units = {{"v_b", text}};
    EXPECT_NEAR(read("time_s,mu,v_b [V]", options).velocity[1], 3.1 * per_volt, 1e-12) << text;
  }
  options.units = {{"v_b", "5 mm/s/V"}};
  EXPECT_NEAR(read("time_s,mu,v_b [mV]", options).velocity[1], 3.1e-3 * 5e-3, 1e-15);
  options.units = {{"v_b", "5 N/V"}};
  EXPECT_THROW(read("time_s,mu,v_b [V]", options), InputError);
}

TEST_F(Columns_, AChannelCanBeLeftOut) {
  ReadOptions options;
  options.columns = {{"load", "none"}, {"temperature", ""}};
  const Trace trace = read("time_s,mu,v_b_mm_s,load_N,temperature_C", options);
  EXPECT_TRUE(trace.load.empty());
  EXPECT_TRUE(trace.temperature.empty());
  EXPECT_FALSE(trace.conditions.load.known());
}

TEST_F(Columns_, ContradictionsAndAmbiguitiesAreSaid) {
  ReadOptions options;
  options.conditions.load = {50, "command line"};
  EXPECT_THAT(read("time_s,mu,v_b_mm_s,load_N", options).warnings,
              Contains(HasSubstr("the stated load of 50 N contradicts")));
  EXPECT_THAT(read("time_s,mu,mu,v_b_mm_s").warnings, Contains(HasSubstr("mu could be it too")));
  EXPECT_THAT(read("time_s,mu,v_b_mm_s,angle").warnings,
              Contains(HasSubstr("column angle has no unit and was not read")));
  EXPECT_THAT(read("time,mu,v_b_mm_s,foo").notes, Contains(HasSubstr("columns not used: foo")));
}

TEST_F(Columns_, OnlyNeededColumnsMustBeNumbers) {
  const Trace trace =
      read_trace(write("time_s,state,mu,comment,v_b_mm_s\n0,on,0.1,\"a, b\",1\n1,off,0.2,,2\n2,on,0.3,nan,3\n"));
  EXPECT_THAT(trace.friction, ::testing::ElementsAre(0.1, 0.2, 0.3));
}

TEST_F(Columns_, AStatedSpeedBeatsAColumnThatContradictsIt) {
  const auto with_speed = [](double rpm) {
    std::string text = "time_s,mu,v_b_mm_s,speed_rpm\n";
    for (int i = 0; i < 40; ++i) text += fmt::format("{:.1f},0.3,6.1,{}\n", 0.1 * i, rpm);
    return text;
  };
  ReadOptions options;
  options.conditions.speed = {4 * 2 * std::numbers::pi / 60, "command line"};
  for (const double rpm : {8.0, -4.0, 0.0}) {
    const Trace trace = read_trace(write(with_speed(rpm)), options);
    EXPECT_TRUE(trace.disc_speed.empty()) << rpm;
    EXPECT_EQ(trace.conditions.speed.source, "command line");
    EXPECT_THAT(trace.warnings, Contains(HasSubstr("stated speed of 4 rpm (command line) contradicts"))) << rpm;
  }
  const Trace agrees = read_trace(write(with_speed(4.02)), options);
  EXPECT_EQ(agrees.disc_speed.size(), agrees.size());
  EXPECT_TRUE(agrees.warnings.empty());
}

TEST_F(Columns_, ColumnsBeyondTheHeaderAreNamedByNumber) {
  ReadOptions options;
  options.columns = {{"v_b", "#3:mm/s"}};
  const std::string file = write("time_s,mu\n0,0.3,1\n1,0.3,2\n2,0.3,3\n");
  EXPECT_DOUBLE_EQ(read_trace(file, options).velocity[2], 3e-3);
  options.columns = {{"v_b", "#4:mm/s"}};
  expect_error(file, options, "no column #4 for v_b", "#1 to #3", 1);
}

TEST_F(Columns_, AUnitInBracketsIsThatOfTheColumn) {
  ReadOptions options;
  const std::string file = write("time_s,mu,laser,belt [mm/s]\n0,0.3,1,4\n1,0.3,2,5\n2,0.3,3,6\n");
  for (const auto& [text, last] : {std::pair{"laser[mm/s]", 3e-3}, {"laser [um/s]", 3e-6}, {"belt [mm/s]", 6e-3}}) {
    options.columns = {{"v_b", text}};
    EXPECT_DOUBLE_EQ(read_trace(file, options).velocity[2], last) << text;
  }
}

TEST_F(Columns_, AColumnHoldsOneChannel) {
  ReadOptions options;
  options.columns = {{"force", "F_N"}, {"load", "F_N"}, {"v_r", "v_r [m/s]"}};
  const std::string file = write("time_s,F_N,v_r [m/s]\n0,1,2\n1,1,2\n2,1,2\n");
  expect_error(file, options, "is named for force and for load", "a column holds one channel", 1, "F_N");
}

TEST_F(Columns_, ACoefficientAboveFiveIsDoubted) {
  const std::string header = "time_s,mu,v_b_mm_s\n";
  EXPECT_THAT(read_trace(write(header + "0,15,1\n1,17.5,2\n2,16,1\n")).warnings,
              Contains(HasSubstr("friction reaches 17.5: is the column really a coefficient?")));
  EXPECT_TRUE(read_trace(write(header + "0,1.5,1\n1,4.9,2\n2,1,1\n")).warnings.empty());
}

}  // namespace
}  // namespace tribofit
