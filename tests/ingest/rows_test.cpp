#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>

#include "csv/rows.hpp"
#include "temp_files.hpp"

namespace tribofit {
namespace {

using Rows_ = TempFiles;

/// Decimals as people and programs write them.
std::string random_decimal(std::mt19937_64& random) {
  std::uniform_int_distribution<int> kind(0, 6), decimals(0, 17);
  std::normal_distribution<double> normal(0, 1);
  const double value = normal(random) * std::pow(10.0, decimals(random) - 9);
  switch (kind(random)) {
    case 0:
      return fmt::format("{:.{}f}", value, decimals(random));
    case 1:
      return fmt::format("{:.{}e}", value, decimals(random));
    case 2:
      return fmt::format("{:.{}g}", value, 1 + decimals(random));
    case 3:
      return fmt::format("{:.17g}", value);
    case 4:
      return fmt::format("{}", static_cast<long long>(value * 1e6));
    case 5:
      return fmt::format("{:.{}E}", value * 1e60, decimals(random));
    default:
      return fmt::format(".{}", decimals(random));
  }
}

TEST_F(Rows_, CellsAreReadAsStrtodReadsThem) {
  std::mt19937_64 random(7);
  std::string text = "time_s,mu,v_b_mps\n";
  std::vector<double> mu, v;
  constexpr int rows = 100000;
  for (int i = 0; i < rows; ++i) {
    const std::string a = random_decimal(random), b = random_decimal(random);
    mu.push_back(std::strtod(a.c_str(), nullptr));
    v.push_back(std::strtod(b.c_str(), nullptr));
    text += fmt::format("{},{},{}\n", i, a, b);
  }
  ReadOptions options;
  options.columns = {{"v_b", "v_b_mps:m/s"}};
  const Trace trace = read_trace(write(text), options);
  ASSERT_EQ(trace.size(), mu.size());
  for (std::size_t i = 0; i < mu.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(trace.friction[i]), std::bit_cast<std::uint64_t>(mu[i])) << i;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(trace.velocity[i]), std::bit_cast<std::uint64_t>(v[i])) << i;
  }
}

/// How a file writes its rows.
struct RowForm {
  const char *name, *heading, *row;  // of time, friction and velocity, in the order of the format's arguments
  bool decimal_comma = false;
};

TEST_F(Rows_, AreReadAlikeInWhateverFormTheyAreWritten) {
  constexpr int rows = 30000;  // several chunks
  const RowForm forms[] = {
      {"commas", "time_s,mu,v_b_mps\n", "{},{},{}\n"},
      {"ends of lines", "time_s,mu,v_b_mps\r\n", "{},{},{}\r\n"},
      {"blanks", "time_s, mu, v_b_mps\n", "{}, {} ,  {}\n"},
      {"last separator", "time_s,mu,v_b_mps,\n", "{},{},{},\n"},
      {"other columns", "note,time_s,x,mu,v_b_mps,y,z\n", "run a,{},-1e400,{},{},,7\n"},
      {"other columns, ends of lines", "note,time_s,x,mu,v_b_mps,y,z\r\n", "run a,{},9.5,{},{},1,\r\n"},
      {"quotes", "time_s,mu,v_b_mps,note\n", "{},\"{}\",{},\"a, \"\"b\"\"\"\n"},
      {"order", "v_b_mps,time_s,mu\n", "{2},{0},{1}\n"},
      {"semicolons", "time_s;mu;v_b_mps\n", "{};{};{}\n", true},
      {"tabs", "time_s\tmu\tv_b_mps\n", "{}\t{}\t{}\n"},
      {"columns of blanks", "time_s mu v_b_mps\n", "  {}   {} \t {}\n"},
  };
  ReadOptions options;
  options.columns = {{"v_b", "v_b_mps:m/s"}};
  std::optional<Trace> first;
  for (const RowForm& form : forms) {
    std::string text = form.heading;
    for (int i = 0; i < rows; ++i) {
      std::string row =
          fmt::format(fmt::runtime(form.row), fmt::format("{:.4f}", i * 1e-4),
                      fmt::format("{:.7g}", 0.3 + 0.1 * std::sin(i * 0.01)), fmt::format("{:.3e}", std::cos(i * 0.02)));
      if (form.decimal_comma) std::replace(row.begin(), row.end(), '.', ',');
      text += row;
    }
    const Trace trace = read_trace(write(text), options);
    if (!first) first = trace;
    EXPECT_EQ(trace.time, first->time) << form.name;
    EXPECT_EQ(trace.friction, first->friction) << form.name;
    EXPECT_EQ(trace.velocity, first->velocity) << form.name;
  }
  ASSERT_EQ(first->size(), std::size_t{rows});
  EXPECT_EQ(first->friction[157], std::strtod(fmt::format("{:.7g}", 0.3 + 0.1 * std::sin(1.57)).c_str(), nullptr));
}

TEST_F(Rows_, ThatNoMemoryHoldsAreRefused) {
  std::string text = "time_s,mu,v_b_mps\n";
  for (int i = 0; i < 1000; ++i) text += fmt::format("{},0.1,1\n", i);  // more than is looked at to know text
  const std::string file = write(text);
  std::filesystem::resize_file(file, std::uintmax_t{1} << 42);  // a hole, which takes no room
  ReadOptions options;
  options.columns = {{"v_b", "v_b_mps:m/s"}};
  expect_error(file, options, "of memory", "cut the file into parts");
}

/// Several chunks, with text and blank lines in between.
std::string long_table(std::size_t rows) {
  std::string text = "time_s,note,mu,v_b_mm_s\n";
  for (std::size_t i = 0; i < rows; ++i) {
    text += fmt::format("{:.5f},run {},{:.5f},{:.4f}\n", static_cast<double>(i) * 1e-4, i % 7,
                        0.3 + 0.1 * std::sin(static_cast<double>(i) * 0.01), static_cast<double>(i % 1000) / 100);
    if (i % 50000 == 49999) text += "pause\n\n";
  }
  return text;
}

TEST_F(Rows_, DoNotDependOnTheNumberOfThreads) {
  const std::string file = write(long_table(150000));
  ASSERT_GT(std::filesystem::file_size(file), 4U << 20);  // several chunks
  ReadOptions options;
  options.threads = 1;
  const Trace one = read_trace(file, options);
  ASSERT_EQ(one.size(), 150000U);
  for (std::size_t i = 0; i < one.size(); i += 997) {
    EXPECT_NEAR(one.time[i], static_cast<double>(i) * 1e-4, 1e-9);
    EXPECT_DOUBLE_EQ(one.velocity[i], 1e-3 * (static_cast<double>(i % 1000) / 100));
  }
  for (const int threads : {2, 3, 8, 0}) {
    options.threads = threads;
    const Trace many = read_trace(file, options);
    EXPECT_EQ(many.time, one.time);
    EXPECT_EQ(many.friction, one.friction);
    EXPECT_EQ(many.velocity, one.velocity);
    EXPECT_EQ(many.checksum, one.checksum);
    EXPECT_EQ(many.notes, one.notes);
    EXPECT_EQ(many.warnings, one.warnings);
  }
}

TEST_F(Rows_, TheFirstErrorOfTheFileIsReportedWithItsLine) {
  std::string text = "time_s,mu,v_b_mm_s\n";
  constexpr std::size_t rows = 200000;
  for (std::size_t i = 0; i < rows; ++i) {
    const std::string mu = i == 61234 ? "" : i > 61300 && i < 61600 ? "abc" : "0.41234";
    text += fmt::format("{:.5f},{},{:.4f}\n", static_cast<double>(i) * 1e-4, mu, 6.28);
  }
  const std::string file = write(text);
  for (const int threads : {1, 2, 5}) {
    ReadOptions options;
    options.threads = threads;
    expect_error(file, options, "the cell is empty", "fill it in", 61236, "mu");
  }
}

TEST_F(Rows_, LinesOfRowsAreKnownAcrossDroppedLines) {
  std::string text = long_table(120000);
  const std::size_t last = text.rfind('\n', text.size() - 2);
  text = text.substr(0, last + 1) + "0.5,run,0.3,1\n";  // time goes back in the last line
  const std::string file = write(text);
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  expect_error(file, {}, "time goes backwards", "sort", lines, "time_s");
}

TEST_F(Rows_, TheChecksumIsOfTheContent) {
  const std::string a = write("t_s,mu,v_b [mm/s]\n0,0.1,1\n1,0.2,2\n", "a.csv"),
                    b = write("t_s,mu,v_b [mm/s]\n0,0.1,1\n1,0.2,3\n", "b.csv");
  const std::string c = write("t_s,mu,v_b [mm/s]\n0,0.1,1\n1,0.2,2\n", "c.csv");
  EXPECT_EQ(read_trace(a).checksum, read_trace(c).checksum);
  EXPECT_NE(read_trace(a).checksum, read_trace(b).checksum);
  EXPECT_NE(read_trace(a).checksum, 0U);
}

}  // namespace
}  // namespace tribofit
