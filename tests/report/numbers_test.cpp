#include "report/numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "report/terminal_text.hpp"

namespace tribofit {
namespace {

TEST(Numbers, ValueAndErrorEndAtTheSamePlace) {
  EXPECT_EQ(with_error(0.052138, 0.000434), "0.05214 +/- 0.00043");
  EXPECT_EQ(with_error(4.8834, 0.0123), "4.883 +/- 0.012");
  EXPECT_EQ(with_error(83.91, 0.0996), "83.91 +/- 0.10");  // 0.0996 is 0.10 to two digits
  EXPECT_EQ(with_error(12345, 678), "12350 +/- 680");
  EXPECT_EQ(with_error(-0.5, 0.25), "-0.50 +/- 0.25");
}

TEST(Numbers, AnErrorThatIsNotKnownIsNotMadeUp) {
  EXPECT_EQ(with_error(4.8834, std::nan("")), "4.883");
  EXPECT_EQ(with_error(4.8834, 0), "4.883");
  EXPECT_EQ(with_error(std::nan(""), 0.1), "-");
}

TEST(Numbers, WhatTheDataDoNotDetermineHasNoNumber) {
  const Motion motion;
  FitParameter p;
  p.parameter = {.name = "sigma0", .unit = "1/mm", .si = 1e3, .lower = 1, .upper = 1e5};
  p.value = 0;
  p.std_error = 2e26;
  p.determined = false;
  p.profile_lower95 = p.profile_upper95 = std::nan("");
  EXPECT_EQ(value_text(p, motion), "not determined");
  p.profile_lower95 = 28e3;
  p.profile_upper95 = 1e8;
  EXPECT_EQ(value_text(p, motion), "not determined (at least 28 1/mm)");
  p.profile_lower95 = 1e3;
  p.profile_upper95 = 3e3;
  EXPECT_EQ(value_text(p, motion), "not determined (at most 3.0 1/mm)");
}

TEST(Numbers, DigitsOfAMeasuredValueStopAtSix) {
  EXPECT_EQ(with_error(4.877842069, 5e-8), "4.87784 +/- 5e-08");
}

TEST(Numbers, SignificantDigits) {
  EXPECT_EQ(significant(0.0031234, 3), "0.00312");
  EXPECT_EQ(significant(83.88, 3), "83.9");
  EXPECT_EQ(significant(9.9999, 3), "10.0");
  EXPECT_EQ(significant(1.234e-7, 2), "1.2e-07");
  EXPECT_EQ(significant(0, 3), "0");
}

TEST(Numbers, PercentKeepsWhatMatters) {
  EXPECT_EQ(percent(0.0123), "1.2 %");
  EXPECT_EQ(percent(0.4), "40 %");
  EXPECT_EQ(percent(0.00042), "0.04 %");
  EXPECT_EQ(percent(0.00007), "0.007 %");
  EXPECT_EQ(percent(1e-9), "< 0.001 %");
}

TEST(Numbers, AShareIsNeverRoundedUpToAll) {
  EXPECT_EQ(share_text(0.99999), "99.99 %");
  EXPECT_EQ(share_text(0.9312), "93.1 %");
  EXPECT_EQ(share_text(1), "100 %");
}

TEST(Numbers, CountsAndRates) {
  EXPECT_EQ(grouped(2400000), "2 400 000");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(frequency_text(20000), "20 kHz");
  EXPECT_EQ(frequency_text(118.31), "118.3 Hz");
  EXPECT_EQ(frequency_text(12345, 2), "12 kHz");
  EXPECT_EQ(frequency_text(748.2, 2), "750 Hz");
}

TEST(Numbers, TablesLineUpWhateverTheAlphabet) {
  ReportTable table;
  table.text({"name"}).numbers({"value"});
  table.rows = {{"α", "1"}, {"beta", "10.5"}};
  EXPECT_EQ(aligned(table, 2), (std::vector<std::string>{"  name  value", "  α         1", "  beta   10.5"}));
}

TEST(Numbers, SentencesBreakAtBlanks) {
  EXPECT_EQ(wrapped("one two three", 9, 2), "one two\n  three");
  EXPECT_EQ(wrapped("unbreakable-word", 5, 0), "unbreakable-word");
}

}  // namespace
}  // namespace tribofit
