/// Tables of earlier values and their comparison with pooled values made by hand.
#include "tribofit/campaign/compare.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "command.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace {

using namespace tribofit;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

PooledValue value_of(const std::string& name, const std::string& unit, double value, double std_error) {
  PooledValue v;
  v.name = name;
  v.unit = unit;
  v.runs = 4;
  v.value = value;
  v.std_error = std_error;
  v.lower95 = value - 2 * std_error;
  v.upper95 = value + 2 * std_error;
  return v;
}

/// Two radii at 4 rpm and 50 N, lot A; both laws by both protocols.
std::vector<PooledGroup> made_groups() {
  std::vector<PooledGroup> groups;
  for (const double radius : {0.009, 0.015}) {
    PooledGroup group;
    group.conditions = {{radius, "manifest"}, {0.41888, "plateau"}, {50, "manifest"}};
    group.others = {{"lot", "A"}};
    for (const char* law : {"exponential", "fractional"}) {
      for (const char* protocol : {"joint", "published"}) {
        const bool exponential = std::string(law) == "exponential";
        group.fits.push_back({law,
                              protocol,
                              {value_of("mu_s", "1", 0.51, 0.001), value_of("mu_k", "1", 0.32, 0.001),
                               value_of(exponential ? "alpha" : "beta", "s/mm", 0.05, 0.0005)},
                              0});
      }
    }
    PooledValue runout = value_of("A", "1", 0.05, 0.001);
    runout.effect = "runout";
    group.fits[0].parameters.push_back(runout);
    group.measures = {value_of("frequency", "Hz", 4.9, 0.01), value_of("amplitude", "mm/s", 84, 0.3)};
    groups.push_back(group);
  }
  return groups;
}

EarlierTable table_of(const std::string& text) {
  const Workshop shop;
  shop.write("t.csv", text);
  return read_earlier((shop / "t.csv").string(), made_groups());
}

EarlierComparison comparison_of(const std::string& text) {
  return compare_with(table_of(text), made_groups());
}

TEST(Earlier, ReadsValuesInTheUnitsOfOurs) {
  const EarlierTable table = table_of(
      "# a comment\nradius_mm,mu_s,alpha [s/m],v_r_amplitude_m_s,fundamental_hz,alpha_std_error [s/mm]\n"
      "9,0.5,50,0.084,4.9,0.001\n");
  ASSERT_EQ(table.values.size(), 4u);
  EXPECT_EQ(table.values[0].name, "mu_s");
  EXPECT_DOUBLE_EQ(table.values[0].conditions.radius.value, 0.009);
  EXPECT_EQ(table.values[0].line, 3u);
  EXPECT_EQ(table.values[1].name, "alpha");
  EXPECT_NEAR(table.values[1].value, 0.05, 1e-15);
  EXPECT_NEAR(table.values[1].std_error, 0.001, 1e-15);
  EXPECT_EQ(table.values[2].name, "amplitude");
  EXPECT_NEAR(table.values[2].value, 84, 1e-12);
  EXPECT_EQ(table.values[3].name, "frequency");
  EXPECT_TRUE(std::isnan(table.values[3].std_error));
  EXPECT_THAT(table.notes, IsEmpty());
}

TEST(Earlier, ReadsSemicolonsWithDecimalCommasAndUnitsInCells) {
  const EarlierTable table = table_of("Radius;mu_s\n9 mm;0,5\n1,5cm;0,51\n");
  ASSERT_EQ(table.values.size(), 2u);
  EXPECT_DOUBLE_EQ(table.values[1].conditions.radius.value, 0.015);
  EXPECT_DOUBLE_EQ(table.values[1].value, 0.51);
}

TEST(Earlier, ReadsARowAValue) {
  const EarlierTable table = table_of(
      "radius_mm,law,protocol,name,unit,value,std_error\n"
      "9,exponential,joint,alpha,s/m,50,1\n9,,,frequency,Hz,4.8,\n9,,,nonsense,1,3,\n");
  ASSERT_EQ(table.values.size(), 2u);
  EXPECT_NEAR(table.values[0].value, 0.05, 1e-15);
  EXPECT_NEAR(table.values[0].std_error, 0.001, 1e-15);
  EXPECT_EQ(table.values[0].law, "exponential");
  EXPECT_EQ(table.values[0].protocol, "joint");
  EXPECT_THAT(table.notes, ElementsAre(HasSubstr("nonsense")));
}

/// The table that a campaign writes of its own pooled values.
TEST(Earlier, ReadsThePooledValuesOfAnEarlierCampaign) {
  const EarlierTable table = table_of(
      "radius_mm,speed_rpm,load_N,lot,law,protocol,name,unit,runs,mean,mean_std_error,value,std_error,ci95_lower,"
      "ci95_upper,statistical,between_runs,systematic\n"
      "9,4,50,A,exponential,joint,mu_s,1,4,0.52,0.1,0.521,0.0004,0.52,0.522,0.0003,0.0002,0\n"
      "9,4,50,A,,,rms_velocity,mm/s,4,15,0.1,15,0.1,14,16,,,0\n9,4,50,A,,,frequency,Hz,4,3,0.1,3.7,0.1,3,4,,,0\n");
  ASSERT_EQ(table.values.size(), 2u);  // the groups made by hand have no rms_velocity
  EXPECT_EQ(table.values[0].value, 0.521);
  EXPECT_EQ(table.values[0].std_error, 0.0004);
  EXPECT_EQ(table.values[1].name, "frequency");
  const EarlierComparison c = compare_with(table, made_groups());
  ASSERT_EQ(c.values.size(), 2u);
  EXPECT_EQ(c.values[0].law + c.values[0].protocol, "exponentialjoint");
}

TEST(Compare, DifferencesInPercentAndStandardErrors) {
  const EarlierComparison c = comparison_of("radius_mm,alpha_s_per_mm,alpha_std_error_s_per_mm\n9,0.052,0.0012\n");
  ASSERT_EQ(c.values.size(), 2u);  // joint and published
  EXPECT_EQ(c.values[0].protocol, "joint");
  EXPECT_EQ(c.values[1].protocol, "published");
  EXPECT_NEAR(c.values[0].percent, 100 * (0.05 / 0.052 - 1), 1e-12);
  EXPECT_NEAR(c.values[0].in_std_errors, -0.002 / 0.0013, 1e-9);  // 5, 12, 13
  EXPECT_FALSE(c.values[0].inside95);
  const EarlierComparison without = comparison_of("radius_mm,alpha_s_per_mm\n9,0.0505\n");
  EXPECT_NEAR(without.values[0].in_std_errors, -1, 1e-9);
  EXPECT_TRUE(without.values[0].inside95);
}

TEST(Compare, ASystematicErrorOfOursCounts) {
  std::vector<PooledGroup> groups = made_groups();
  groups[0].measures[1].std_error = 0.3;
  groups[0].measures[1].systematic = 0.4;
  const Workshop shop;
  shop.write("t.csv", "radius_mm,amplitude_mm_s\n9,83\n");
  const EarlierComparison c = compare_with(read_earlier((shop / "t.csv").string(), groups), groups);
  ASSERT_EQ(c.values.size(), 1u);
  EXPECT_NEAR(c.values[0].in_std_errors, 2, 1e-9);
}

TEST(Compare, FrictionGoesWithEveryLawTheDecayWithItsOwn) {
  const EarlierComparison c = comparison_of("radius_mm,mu_s,beta_s_per_mm,runout.A\n15,0.5,0.05,0.04\n");
  std::vector<std::string> found;
  for (const ComparedValue& v : c.values) found.push_back(v.earlier.name + " " + v.law + " " + v.protocol);
  EXPECT_THAT(found, ElementsAre("mu_s exponential joint", "mu_s exponential published", "mu_s fractional joint",
                                 "mu_s fractional published", "beta fractional joint", "beta fractional published",
                                 "runout.A exponential joint"));
  const EarlierComparison one = comparison_of("radius_mm,law,mu_s\n15,fractional,0.5\n");
  ASSERT_EQ(one.values.size(), 2u);
  EXPECT_EQ(one.values[0].law, "fractional");
  const EarlierComparison prefixed = comparison_of("radius_mm,exponential_published_mu_s\n15,0.5\n");
  ASSERT_EQ(prefixed.values.size(), 1u);
  EXPECT_EQ(prefixed.values[0].protocol, "published");
}

TEST(Compare, ConditionsMatchWhereAllThatTheRowStatesDoes) {
  const auto matched = [](const std::string& text) { return comparison_of(text).values.size(); };
  EXPECT_EQ(matched("radius_mm,speed_rpm,frequency_hz\n9,4,4.9\n"), 1u);     // 4.0000 rpm from the plateau
  EXPECT_EQ(matched("radius_mm,speed_rpm,frequency_hz\n9,4.02,4.9\n"), 1u);  // to 1 %
  EXPECT_EQ(matched("radius_mm,speed_rpm,frequency_hz\n9,5,4.9\n"), 0u);
  EXPECT_EQ(matched("radius_mm,frequency_hz\n9.05,4.9\n"), 0u);
  EXPECT_EQ(matched("load_N,frequency_hz\n50,4.9\n"), 2u);  // both radii
  EXPECT_EQ(matched("radius_mm,lot,frequency_hz\n9,A,4.9\n"), 1u);
  EXPECT_EQ(matched("radius_mm,lot,frequency_hz\n9,B,4.9\n"), 0u);
}

TEST(Compare, WhatHasNoPartnerIsNamed) {
  const EarlierComparison c =
      comparison_of("radius_mm,mu_s,fundamental_amplitude,humidity\n9,0.5,1.284,50\n12,0.5,1.5,50\n");
  EXPECT_EQ(c.values.size(), 4u);
  EXPECT_THAT(c.unmatched,
              ElementsAre(HasSubstr("fundamental_amplitude"), HasSubstr("humidity"),
                          HasSubstr("line 3: there are no runs of 12 mm"), HasSubstr("no row for the runs of 15 mm")));
}

struct Bad {
  const char *name, *text, *where, *problem;
};

TEST(Earlier, BadTablesAreRefusedWithFileLineAndColumn) {
  const Bad cases[] = {
      {"empty", "", "t.csv: ", "is empty"},
      {"only comments", "# nothing\n", "t.csv: ", "no header"},
      {"no values in it", "radius_mm,mu_s\n", "t.csv: ", "holds no values"},
      {"no column of conditions", "mu_s,mu_k\n0.5,0.4\n", "t.csv:1: ", "no column of conditions"},
      {"no column of values", "radius_mm,height\n9,3\n", "t.csv:1: ", "no column of values"},
      {"missing unit", "radius_mm,alpha\n9,0.05\n", "t.csv:1: column alpha: ", "has no unit"},
      {"unknown unit", "radius_mm,alpha [s/mmm]\n9,0.05\n", "t.csv:1: column alpha [s/mmm]: ", "unknown unit"},
      {"unit of another kind", "radius_mm,alpha [mm/s]\n9,0.05\n", "t.csv:1: column alpha [mm/s]: ", "unit of"},
      {"radius without unit", "radius,mu_s\n9,0.5\n", "t.csv:2: column radius: ", "has no unit"},
      {"radius not above zero", "radius_mm,mu_s\n-9,0.5\n", "t.csv:2: column radius_mm: ", "not greater than zero"},
      {"no number", "radius_mm,mu_s\n9,0.5\n15,o.5\n", "t.csv:3: column mu_s: ", "not a number"},
      {"not finite", "radius_mm,mu_s\n9,inf\n", "t.csv:2: column mu_s: ", "not a number"},
      {"negative error", "radius_mm,mu_s,mu_s_std_error\n9,0.5,-1\n", "t.csv:2: column mu_s_std_error: ", "less than"},
      {"too many cells", "radius_mm,mu_s\n9,0.5,7\n", "t.csv:2: ", "3 cells"},
      {"no conditions in a row", "radius_mm,mu_s\n,0.5\n", "t.csv:2: ", "states no conditions"},
      {"two columns of a value", "radius_mm,alpha_s_per_mm,alpha [s/m]\n9,1,1\n",
       "t.csv:1: column alpha [s/m]: ", "second column"},
      {"long, unknown unit", "radius_mm,name,unit,value\n9,alpha,s/mmm,1\n", "t.csv:2: column unit: ", "unknown unit"}};
  for (const Bad& bad : cases) {
    try {
      table_of(bad.text);
      ADD_FAILURE() << bad.name << " was read";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(bad.where)) << bad.name;
      EXPECT_THAT(error.what(), HasSubstr(bad.problem)) << bad.name;
      EXPECT_FALSE(error.advice().empty()) << bad.name;
    }
  }
}

}  // namespace
