#include "tribofit/ingest/units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

struct Case {
  const char* text;
  Quantity quantity;
  double si;
};

class Quantities : public ::testing::TestWithParam<Case> {};

TEST_P(Quantities, AreReadInSi) {
  const Case& c = GetParam();
  EXPECT_DOUBLE_EQ(parse_quantity(c.text, c.quantity, "--x"), c.si) << c.text;
}

INSTANTIATE_TEST_SUITE_P(
    Table, Quantities,
    ::testing::Values(
        Case{"15mm", Quantity::length, 0.015}, Case{"0.015 m", Quantity::length, 0.015},
        Case{"0.015", Quantity::length, 0.015}, Case{"1.5e1mm", Quantity::length, 0.015},
        Case{"+15 mm", Quantity::length, 0.015}, Case{"50 \u00b5m", Quantity::length, 50e-6},
        Case{"50 \u03bcm", Quantity::length, 50e-6}, Case{"50um", Quantity::length, 50e-6},
        Case{"1in", Quantity::length, 0.0254}, Case{"4rpm", Quantity::angular_velocity, 4 * full_turn / 60},
        Case{"4 RPM", Quantity::angular_velocity, 4 * full_turn / 60},
        Case{"4 1/min", Quantity::angular_velocity, 4 * full_turn / 60},
        Case{"4 min^-1", Quantity::angular_velocity, 4 * full_turn / 60},
        Case{"4 r/min", Quantity::angular_velocity, 4 * full_turn / 60},
        Case{"4 U/min", Quantity::angular_velocity, 4 * full_turn / 60},
        Case{"4 rev/min", Quantity::angular_velocity, 4 * full_turn / 60},
        Case{"0.419rad/s", Quantity::angular_velocity, 0.419},
        Case{"24 \u00b0/s", Quantity::angular_velocity, 24 * full_turn / 360}, Case{"50N", Quantity::force, 50},
        Case{"3 mN", Quantity::force, 0.003}, Case{"3 MN", Quantity::force, 3e6}, Case{"1.2kN", Quantity::force, 1200},
        Case{"2 kgf", Quantity::force, 19.6133}, Case{"2.5 Nm", Quantity::torque, 2.5},
        Case{"2.5 N\u00b7m", Quantity::torque, 2.5}, Case{"2.5 N*mm", Quantity::torque, 0.0025},
        Case{"2.5 mNm", Quantity::torque, 0.0025}, Case{"2.5 N m", Quantity::torque, 2.5},
        Case{"20kHz", Quantity::frequency, 20000}, Case{"0.5 Hz", Quantity::frequency, 0.5},
        Case{"12N/mm", Quantity::stiffness, 12000}, Case{"3 Ns/m", Quantity::damping, 3},
        Case{"3 N*s/mm", Quantity::damping, 3000}, Case{"30 %", Quantity::dimensionless, 0.3},
        Case{"0.3", Quantity::dimensionless, 0.3}, Case{"5 ms", Quantity::time, 0.005},
        Case{"2 min", Quantity::time, 120}, Case{"10 us", Quantity::time, 1e-5},
        Case{"6.3 mm/s", Quantity::velocity, 0.0063}, Case{"6.3 MM/S", Quantity::velocity, 0.0063},
        Case{"6.3mm s^-1", Quantity::velocity, 0.0063}, Case{"9.81 m/s\u00b2", Quantity::acceleration, 9.81},
        Case{"9.81 m/s^2", Quantity::acceleration, 9.81}, Case{"0.05 s/mm", Quantity::inverse_velocity, 50},
        Case{"100/mm", Quantity::inverse_length, 1e5}, Case{"100 1/mm", Quantity::inverse_length, 1e5},
        Case{"0.01 1/s", Quantity::inverse_time, 0.01}, Case{"0.01 1/K", Quantity::inverse_temperature, 0.01},
        Case{"23\u00b0C", Quantity::temperature, 23}, Case{"23 degC", Quantity::temperature, 23},
        Case{"296.15 K", Quantity::temperature, 23}, Case{"73.4 \u00b0F", Quantity::temperature, 23},
        Case{"90\u00b0", Quantity::angle, full_turn / 4}, Case{"2 rev", Quantity::angle, 2 * full_turn},
        Case{"100 g", Quantity::mass, 0.1}, Case{"10 mV", Quantity::voltage, 0.01}));

TEST(Units, BareNumbersTakeTheNamedUnit) {
  EXPECT_DOUBLE_EQ(parse_quantity("15", Quantity::length, "--radius", "mm"), 0.015);
  EXPECT_DOUBLE_EQ(parse_quantity("15 m", Quantity::length, "--radius", "mm"), 15);
}

TEST(Units, SiPrefixesAreTheSameUnitToTheLastBit) {
  for (const auto& [text, factor] : {std::pair{"1/mm", 1000.0},
                                     {"s/mm", 1000.0},
                                     {"s^2/mm^2", 1e6},
                                     {"mm/s", 1e-3},
                                     {"N/mm", 1000.0},
                                     {"kHz", 1000.0}}) {
    ASSERT_TRUE(find_unit(text)) << text;
    EXPECT_EQ(find_unit(text)->factor, factor) << text;
  }
}

TEST(Units, UnknownOnesAreNotFound) {
  for (const char* text : {"furlong", "mm/q", "mmm", "m//s", "mm/", "(mm/s", "N^9", "m s x", "mms"})
    EXPECT_FALSE(find_unit(text)) << text;
}

TEST(Units, RateFrequencyAndAngularVelocityAreKeptApart) {
  EXPECT_EQ(find_unit("1/s")->quantity, Quantity::inverse_time);
  EXPECT_EQ(find_unit("Hz")->quantity, Quantity::frequency);
  EXPECT_EQ(find_unit("rad/s")->quantity, Quantity::angular_velocity);
  EXPECT_FALSE(find_unit("1/s", Quantity::angular_velocity));
  EXPECT_FALSE(find_unit("Hz", Quantity::angular_velocity));
}

void expect_refused(const char* text, Quantity quantity, const char* problem, const char* advice) {
  try {
    const double value = parse_quantity(text, quantity, "--radius");
    FAIL() << text << " was read as " << value;
  } catch (const InputError& error) {
    EXPECT_THAT(error.problem(), ::testing::StartsWith("--radius: "));
    EXPECT_THAT(error.problem(), ::testing::HasSubstr(problem));
    EXPECT_THAT(error.advice(), ::testing::HasSubstr(advice));
  }
}

TEST(Units, BadQuantitiesAreRefusedWithAdvice) {
  expect_refused("", Quantity::length, "not a number", "15mm");
  expect_refused("mm", Quantity::length, "not a number", "15mm");
  expect_refused("15N", Quantity::length, "is a force, not a length", "15mm");
  expect_refused("15 mmm", Quantity::length, "unknown unit 'mmm'", "did you mean mm?");
  expect_refused("4 rmp", Quantity::angular_velocity, "unknown unit 'rmp'", "did you mean rpm?");
  expect_refused("inf", Quantity::length, "not a finite number", "15mm");
  expect_refused("nan mm", Quantity::length, "not a finite number", "15mm");
  expect_refused("1e999", Quantity::length, "outside the range", "15mm");
  expect_refused("0,015 m", Quantity::length, "decimal comma", "decimal point");
}

TEST(Units, AMessageStatesFileLineColumnProblemAndAdvice) {
  const InputError full("the cell is empty", "fill it in", {"a.csv", 7, "mu"});
  EXPECT_STREQ(full.what(), "a.csv:7: column mu: the cell is empty; fill it in");
  EXPECT_STREQ(InputError("is empty", "export again", {"a.csv", 0, ""}).what(), "a.csv: is empty; export again");
  EXPECT_STREQ(InputError("no", "yes").what(), "no; yes");
}

}  // namespace
}  // namespace tribofit
