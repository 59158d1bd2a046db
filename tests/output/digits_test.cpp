#include "tribofit/output/digits.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tribofit {
namespace {

TEST(Digits, ValueAndErrorEndAtTheSamePlace) {
  EXPECT_EQ(with_error(0.052138, 0.000434), "0.05214 +/- 0.00043");
  EXPECT_EQ(with_error(4.8834, 0.0123), "4.883 +/- 0.012");
  EXPECT_EQ(with_error(83.91, 0.0996), "83.91 +/- 0.10");  // 0.0996 is 0.10 to two digits
  EXPECT_EQ(with_error(12345, 678), "12350 +/- 680");
  EXPECT_EQ(with_error(-0.5, 0.25), "-0.50 +/- 0.25");
}

TEST(Digits, AnErrorThatIsNotKnownIsNotMadeUp) {
  EXPECT_EQ(with_error(4.8834, std::nan("")), "4.883");
  EXPECT_EQ(with_error(4.8834, 0), "4.883");
  EXPECT_EQ(with_error(std::nan(""), 0.1), "-");
}

TEST(Digits, DigitsOfAMeasuredValueStopAtSix) {
  EXPECT_EQ(with_error(4.877842069, 5e-8), "4.87784 +/- 5e-08");
}

TEST(Digits, SignificantDigits) {
  EXPECT_EQ(significant(0.0031234, 3), "0.00312");
  EXPECT_EQ(significant(83.88, 3), "83.9");
  EXPECT_EQ(significant(9.9999, 3), "10.0");
  EXPECT_EQ(significant(1.234e-7, 2), "1.2e-07");
  EXPECT_EQ(significant(0, 3), "0");
}

TEST(Digits, PercentKeepsWhatMatters) {
  EXPECT_EQ(percent(0.0123), "1.2 %");
  EXPECT_EQ(percent(0.4), "40 %");
  EXPECT_EQ(percent(0.00042), "0.04 %");
  EXPECT_EQ(percent(0.00007), "0.007 %");
  EXPECT_EQ(percent(1e-9), "< 0.001 %");
}

TEST(Digits, AShareIsNeverRoundedUpToAll) {
  EXPECT_EQ(share_text(0.99999), "99.99 %");
  EXPECT_EQ(share_text(0.9312), "93.1 %");
  EXPECT_EQ(share_text(1), "100 %");
}

TEST(Digits, NoZerosBehindWhatAMessageSays) {
  EXPECT_EQ(general(15), "15");
  EXPECT_EQ(general(4.00071, 4), "4.001");
  EXPECT_EQ(general(123456, 3), "1.23e+05");
  EXPECT_EQ(general_with_sign(0.512, 2), "+0.51");
}

TEST(Digits, CountsInGroupsOfThree) {
  EXPECT_EQ(grouped(2400000), "2 400 000");
  EXPECT_EQ(grouped(999), "999");
}

}  // namespace
}  // namespace tribofit
