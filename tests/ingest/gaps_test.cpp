#include <fmt/format.h>

#include <set>

#include "temp_files.hpp"

namespace tribofit {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

using Gaps = TempFiles;

constexpr std::size_t rows = 4262;

/// Rows at 1 kHz; those named hold `cell` for friction.
std::string table(const std::set<std::size_t>& bad, const std::string& cell, bool with_time = true) {
  std::string text = with_time ? "time_s,mu,v_b_mm_s\n" : "mu,v_b_mm_s\n";
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    if (with_time) text += fmt::format("{:.3f},", t);
    text += fmt::format("{},{:.4f}\n", bad.contains(i) ? cell : fmt::format("{:.4f}", 0.3 + t), 6 + t);
  }
  return text;
}

TEST_F(Gaps, AnIsolatedBadCellIsLeftOutAndSaid) {
  for (const char* cell : {"NaN", "", "-inf", "1e300", "#N/A", "---"}) {
    const Trace trace = read_trace(write(table({1000}, cell)));
    ASSERT_EQ(trace.size(), rows - 1) << cell;
    EXPECT_NEAR(trace.time[1000], 1.001, 1e-12);
    EXPECT_NEAR(trace.friction[1000], 1.301, 1e-12) << "nothing is filled in";
    ASSERT_EQ(trace.steps.size(), 2U) << "nothing is taken across a gap";
    EXPECT_EQ(trace.steps[1].begin, 1000U);
    EXPECT_THAT(trace.warnings,
                Contains(HasSubstr("1 row with a cell that is not a number was left out as a gap (line 1002)")));
  }
}

TEST_F(Gaps, SeveralAreCountedWithTheirLines) {
  const Trace trace = read_trace(write(table({17, 18, 19, 3000}, "NaN")));
  EXPECT_EQ(trace.size(), rows - 4);
  EXPECT_THAT(trace.warnings, Contains(HasSubstr("4 rows with a cell that is not a number were left out as gaps (lines "
                                                 "19, 20, 21, 3002)")));
}

TEST_F(Gaps, WithoutATimeColumnTheOthersKeepTheirTime) {
  ReadOptions options;
  options.rate = 1000;
  const Trace trace = read_trace(write(table({1000, 2000}, "NaN", false)), options);
  EXPECT_EQ(trace.size(), rows - 2);
  EXPECT_NEAR(trace.time.back(), 1e-3 * (rows - 1), 1e-9);
  EXPECT_NEAR(trace.time[1000], 1.001, 1e-9);
}

TEST_F(Gaps, MoreAreRefusedAsTheFirstIs) {
  expect_error(write(table({17, 18, 19, 20}, "NaN")), {}, "'NaN' is not a finite number", "remove the row", 19, "mu");
  expect_error(write(table({17, 100, 200, 300, 400}, "abc")), {}, "'abc' is not a number", "columns", 19, "mu");
}

TEST_F(Gaps, MessagesNameTheLineOfTheRowsThatRemain) {
  std::string text = table({1000}, "NaN");
  text += "1.000,0.3,6\n";  // time goes back in the last line
  expect_error(write(text), {}, "time goes backwards", "sort", rows + 2, "time_s");
}

/// A log begins before the block is loaded and ends after it is lifted; the zero of the load cell is off.
TEST_F(Gaps, RowsBeforeTheLoadAndAfterItTakeNoPart) {
  for (const double zero : {0.0, 0.4, -0.3}) {
    std::string text = "time_s,force_N,load_N,v_r_mm_s\n";
    for (std::size_t i = 0; i < 1000; ++i) {
      const bool loaded = i >= 100 && i < 950;
      text += fmt::format("{:.3f},{},{},5\n", 1e-3 * static_cast<double>(i), loaded ? 4 : 0, (loaded ? 10 : 0) + zero);
    }
    const Trace trace = read_trace(write(text));
    ASSERT_EQ(trace.size(), 850U) << zero;
    EXPECT_NEAR(trace.time.front(), 0.1, 1e-12) << "times stay those of the file";
    EXPECT_NEAR(trace.friction.front(), 4 / (10 + zero), 1e-12) << zero;
    EXPECT_THAT(trace.warnings, Contains(HasSubstr("150 of 1000 rows have no load")));
  }
}

/// A programme of loads may begin with a twentieth of the largest.
TEST_F(Gaps, ALowStepOfTheLoadIsKept) {
  std::string text = "time_s,force_N,load_N,v_r_mm_s\n";
  for (std::size_t i = 0; i < 900; ++i) {
    const double load = i < 300 ? 5 : i < 600 ? 100 : 4;
    text += fmt::format("{:.3f},{},{},5\n", 1e-3 * static_cast<double>(i), 0.3 * load + (i % 2 == 0 ? 0.1 : 0), load);
  }
  EXPECT_EQ(read_trace(write(text)).size(), 900U);
}

/// Within a test they are a fault that is named.
TEST_F(Gaps, ARowWithoutLoadWithinTheTestIsRefused) {
  expect_error(write("time_s,force_N,load_N,v_r_mm_s\n0,4,10,5\n0.1,4,10,5\n0.2,4,0,5\n0.3,4,10,5\n0.4,4,10,5\n"), {},
               "the load is 0 N", "remove the rows without load", 4, "load_N");
}

}  // namespace
}  // namespace tribofit
