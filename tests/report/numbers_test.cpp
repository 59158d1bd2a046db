#include "report/numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "report/terminal_text.hpp"

namespace tribofit {
namespace {

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

TEST(Numbers, Rates) {
  EXPECT_EQ(frequency_text(20000), "20 kHz");
  EXPECT_EQ(frequency_text(118.31), "118.3 Hz");
  EXPECT_EQ(frequency_text(12345, 2), "12 kHz");
  EXPECT_EQ(frequency_text(748.2, 2), "750 Hz");
}

TEST(Numbers, TablesLineUpWhateverTheAlphabet) {
  ReportTable table;
  table.text({"name"}).numbers({"value"});
  table.rows = {{"α", "1"}, {"beta", "10.5"}};
  EXPECT_EQ(aligned(table, 2, {0, 1}), (std::vector<std::string>{"  name  value", "  α         1", "  beta   10.5"}));
}

TEST(Numbers, SentencesBreakAtBlanks) {
  EXPECT_EQ(wrapped("one two three", 9, 2), "one two\n  three");
  EXPECT_EQ(wrapped("unbreakable-word", 5, 0), "unbreakable-word");
}

}  // namespace
}  // namespace tribofit
