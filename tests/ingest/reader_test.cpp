#include "reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "binary_reader.hpp"
#include "temp_files.hpp"
#include "tribofit/kinematics/clock_offset.hpp"

namespace tribofit {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

RawColumn column(std::string name, std::string unit, std::vector<double> numbers, std::size_t rows = 0) {
  RawColumn result;
  result.name = std::move(name);
  result.unit = std::move(unit);
  result.numbers = std::move(numbers);
  result.rows = rows;
  return result;
}

std::vector<double> series(std::size_t count, double first, double step) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = first + step * static_cast<double>(i);
  return values;
}

/// Everything here is read by the tests' own reader: no CSV code is used.
class Readers : public TempFiles {
 protected:
  std::string write_binary(const RawTable& table, const std::string& name = "trace.bin") const {
    return write(binary_format::bytes_of(table), name);
  }
  static Trace read(const std::string& file, const ReadOptions& options = {}) {
    static const std::array only = {binary_format::reader};
    return read_trace(file, options, only);
  }
  static InputError error_of(const std::string& file, const ReadOptions& options = {}) {
    try {
      read(file, options);
    } catch (const InputError& error) {
      return error;
    }
    ADD_FAILURE() << "no InputError";
    return {"", ""};
  }
};

TEST_F(Readers, UnitsAndChannelsAreThoseOfAnyFile) {
  RawTable table;
  table.columns = {column("Time", "ms", series(50, 1000, 5)),      column("DAQ.Fx (kN)", "", series(50, 0.02, 1e-4)),
                   column("Fz", "N", series(50, 50, 0)),           column("vibrometer", "mm/s", series(50, 6, 0.1)),
                   column("Temperature", "K", series(50, 300, 0)), column("remark", "", {})};
  table.columns.back().is_text = true;
  const Trace trace = read(write_binary(table));
  ASSERT_EQ(trace.size(), 50U);
  EXPECT_NEAR(trace.rate(), 200, 1e-9);
  EXPECT_EQ(trace.time.front(), 0);
  for (std::size_t i = 0; i < 50; ++i) {
    const double k = static_cast<double>(i);
    EXPECT_NEAR(trace.friction[i], (20 + 0.1 * k) / 50, 1e-12);
    EXPECT_NEAR(trace.velocity[i], 1e-3 * (6 + 0.1 * k), 1e-15);
    EXPECT_NEAR(trace.temperature[i], 26.85, 1e-12);
  }
  EXPECT_EQ(trace.velocity_kind, VelocityKind::block);
  EXPECT_THAT(trace.notes, Contains("columns not used: remark"));
  EXPECT_TRUE(trace.warnings.empty());
}

TEST_F(Readers, TheContentTellsTheFormatNotTheName) {
  RawTable table;
  table.columns = {column("time", "s", series(20, 0, 0.1)), column("mu", "", series(20, 0.3, 0)),
                   column("v_r", "m/s", series(20, 0.5, 0))};
  const std::array readers = {binary_format::reader, all_readers().back()};
  EXPECT_EQ(read_trace(write_binary(table, "binary.csv"), {}, readers).size(), 20U);
  const std::string text = write("time_s,mu,v_r [m/s]\n0,0.3,1\n1,0.3,1\n2,0.3,1\n", "text.bin");
  EXPECT_EQ(read_trace(text, {}, readers).size(), 3U);
  EXPECT_THAT(error_of(text).problem(), HasSubstr("no known format"));
  EXPECT_THAT(error_of(text).advice(), HasSubstr("LABREC"));
  EXPECT_THAT(error_of(write("PK\x03\x04", "x.bin")).problem(), HasSubstr("Excel workbook"));
}

TEST_F(Readers, TheSameNumbersGiveTheSameTraceFromCsv) {
  RawTable table;
  table.columns = {column("time", "s", {}), column("mu", "", {}), column("v_b", "mm/s", {})};
  std::string csv = "time,mu,v_b\ns,,mm/s\n";
  for (int i = 0; i < 300; ++i) {
    const std::array values = {0.001 * i, 0.3 + 0.1 * std::sin(0.1 * i), 6 * std::cos(0.1 * i)};
    csv += fmt::format("{:.17g},{:.17g},{:.17g}\n", values[0], values[1], values[2]);
    for (std::size_t k = 0; k < 3; ++k) table.columns[k].numbers.push_back(values[k]);
  }
  const Trace binary = read(write_binary(table)), text = read_trace(write(csv));
  EXPECT_EQ(binary.time, text.time);
  EXPECT_EQ(binary.friction, text.friction);
  EXPECT_EQ(binary.velocity, text.velocity);
  EXPECT_EQ(binary.notes, text.notes);
  EXPECT_NE(binary.checksum, 0U);
  table.columns[1].numbers[7] += 1e-9;
  EXPECT_NE(read(write_binary(table)).checksum, binary.checksum);
}

TEST_F(Readers, ScalarsStateTheRate) {
  RawTable table;
  table.columns = {column("COF", "", series(30, 0.3, 0)), column("v_b", "mm/s", series(30, 5, 0))};
  EXPECT_THAT(error_of(write_binary(table)).problem(), HasSubstr("no time column among: COF, v_b"));
  EXPECT_THAT(error_of(write_binary(table)).advice(), HasSubstr("rate"));
  for (const auto& [name, value] :
       {std::pair{"fs", "2000"}, {"dt", "0.0005"}, {"Sampling rate", "2 kHz"}, {"Sample interval (ms)", "0,5"}}) {
    table.facts = {{"operator", "nobody"}, {name, value}};
    const Trace trace = read(write_binary(table));
    EXPECT_NEAR(trace.rate(), 2000, 1e-6) << name;
    EXPECT_THAT(trace.notes, Contains(HasSubstr(name)));
  }
  ReadOptions options;
  options.rate = 100;
  EXPECT_NEAR(read(write_binary(table), options).rate(), 100, 1e-9) << "the user beats the file";
}

TEST_F(Readers, ChannelsOfOtherRatesAndBlocksMeetOnTheClockOfTheFile) {
  RawTable table;
  table.rows.resize(2);
  table.rows[0].interval = 0.01;
  table.rows[0].start = 5;
  table.rows[1].interval = 0.004;
  table.rows[1].start = 5.02;
  table.columns = {column("mu", "", series(200, 0.3, 0.001)), column("v_b", "mm/s", series(300, 1, 0.04), 1)};
  table.columns[1].place = "block 2";
  const Trace trace = read(write_binary(table));
  // Both overlap from 5.02 s to 6.216 s; the velocity is 1 mm/s + 10 mm/s^2 (t - 5.02 s), and straight between samples.
  ASSERT_EQ(trace.size(), 120U);
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const double t = 0.01 * static_cast<double>(i);
    EXPECT_NEAR(trace.time[i], t, 1e-12);
    EXPECT_NEAR(trace.friction[i], 0.302 + 0.1 * t, 1e-12);
    EXPECT_NEAR(trace.velocity[i], 1e-3 * (1 + 10 * t), 1e-12);
  }
  EXPECT_THAT(trace.notes, Contains(HasSubstr("v_b of block 2 (250 Hz) were interpolated linearly at 100 Hz")));
  // With time columns of their own, of which the file names both alike.
  table.rows[0].interval.reset();
  table.rows[1].interval.reset();
  table.columns.push_back(column("Time", "s", series(200, 5, 0.01)));
  table.columns.push_back(column("Time", "s", series(300, 5.02, 0.004), 1));
  const Trace timed = read(write_binary(table));
  ASSERT_EQ(timed.size(), trace.size());
  for (std::size_t i = 0; i < timed.size(); ++i) EXPECT_NEAR(timed.velocity[i], trace.velocity[i], 1e-12);
  EXPECT_TRUE(timed.warnings.empty());
}

TEST_F(Readers, StepsBringTheirConditions) {
  RawTable table;
  table.facts = {{"fs", "10 Hz"}};
  table.rows[0].steps = {{0, "inner", {{0.006, "file"}, {}, {}}}, {30, "outer", {{0.012, "file"}, {}, {}}}};
  table.columns = {column("torque", "Nm", series(60, 0.06, 0)), column("load", "N", series(60, 50, 0)),
                   column("rpm", "", series(60, 30, 0))};
  const std::string file = write_binary(table);
  const Trace trace = read(file);
  ASSERT_EQ(trace.steps.size(), 2U);
  EXPECT_EQ(trace.steps[1].label, "outer");
  EXPECT_EQ(trace.steps[1].begin, 30U);
  EXPECT_EQ(trace.steps[1].conditions.radius.value, 0.012);
  EXPECT_EQ(trace.steps[1].conditions.radius.source, "file");
  EXPECT_FALSE(trace.conditions.radius.known()) << "the steps differ";
  EXPECT_NEAR(trace.friction[0], 0.06 / 0.006 / 50, 1e-12);
  EXPECT_NEAR(trace.friction[59], 0.06 / 0.012 / 50, 1e-12);
  EXPECT_NEAR(trace.time[59], 5.9, 1e-12);
  ReadOptions options;
  options.conditions.radius = {0.01, "command line"};
  EXPECT_NEAR(read(file, options).friction[59], 0.06 / 0.01 / 50, 1e-12) << "the user beats the file";
}

TEST_F(Readers, FilesContinueARun) {
  RawTable table;
  table.columns = {column("time", "s", series(40, 0, 0.1)), column("mu", "", series(40, 0.3, 0)),
                   column("v_r", "mm/s", series(40, 5, 0))};
  const std::string first = write_binary(table, "a.bin");
  table.columns[0].numbers = series(40, 4, 0.1);
  ReadOptions options;
  options.continued_in = {write_binary(table, "b.bin")};
  const Trace trace = read(first, options);
  ASSERT_EQ(trace.size(), 80U);
  for (std::size_t i = 0; i < 80; ++i) EXPECT_NEAR(trace.time[i], 0.1 * static_cast<double>(i), 1e-9);
  EXPECT_EQ(trace.steps[1].label, "b.bin");
}

/// A block that is carried along by the disc and slips back at irregular times, and a spring that pulls it: friction is
/// the spring's pull, in stick and (without mass) in slip.
struct Carried {
  std::vector<double> velocity, friction;  ///< v_b [mm/s] and mu at `rate`

  explicit Carried(double duration, double rate) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> pause(0.7, 1.3);
    constexpr double carried = 4, slip_time = 0.04;  // mm/s, s
    double last = 0, next = 0.5, x = 0;
    for (double t = 0; t < duration; t += 1 / rate) {
      if (t > next + slip_time) {
        last = next;
        next = t + pause(random);
      }
      const double back = carried * (next - last) * std::numbers::pi / 2 / slip_time;  // as far as it was carried
      const double slip = t > next ? back * std::sin(std::numbers::pi * (t - next) / slip_time) : 0;
      velocity.push_back(carried - slip);
      friction.push_back(0.2 + 0.02 * x);
      x += velocity.back() / rate;
    }
  }
};

TEST_F(Readers, TwoInstrumentsAreJoinedByTheirBreakAways) {
  constexpr double rate = 2000, offset = 0.35;  // s that the second clock is behind
  const Carried truth(30, rate);
  RawTable friction, velocity;
  friction.facts = {{"fs", "2 kHz"}};
  friction.columns = {column("COF", "", truth.friction)};
  const std::size_t skipped = 3000;
  velocity.rows[0].interval = 1 / rate;
  velocity.rows[0].start = static_cast<double>(skipped) / rate - offset;
  velocity.columns = {column("Velocity", "mm/s", {truth.velocity.begin() + skipped, truth.velocity.end()})};
  ReadOptions options;
  options.second_file = write_binary(velocity, "velocity.bin");
  options.clock_offset = estimate_clock_offset;
  const Trace trace = read(write_binary(friction, "friction.bin"), options);
  EXPECT_THAT(trace.notes, Contains(HasSubstr("clock offset from")));
  ASSERT_GT(trace.size(), truth.velocity.size() - skipped - 10);
  double worst = 0;
  for (std::size_t i = 0; i + 4 < trace.size(); ++i) {
    // within one sample of the truth: the friction says where the trace begins
    const std::size_t at = i + truth.velocity.size() - trace.size();
    const auto [low, high] = std::minmax_element(truth.velocity.begin() + static_cast<std::ptrdiff_t>(at) - 2,
                                                 truth.velocity.begin() + static_cast<std::ptrdiff_t>(at) + 3);
    worst = std::max({worst, *low - 1e3 * trace.velocity[i], 1e3 * trace.velocity[i] - *high});
  }
  EXPECT_LT(worst, 0.5);
}

TEST_F(Readers, DefectsAreNamedByColumnAndValue) {
  RawTable table;
  table.columns = {column("time", "s", series(40, 0, 0.1)), column("mu", "", series(40, 0.3, 0)),
                   column("v_r", "mm/s", series(40, 5, 0))};
  table.columns[1].place = "group DAQ";
  RawTable wrong = table;
  wrong.columns[1].numbers[11] = nan;
  const InputError no_number = error_of(write_binary(wrong));
  EXPECT_EQ(no_number.where().column, "mu of group DAQ");
  EXPECT_EQ(no_number.where().value, 12U);
  EXPECT_EQ(no_number.where().line, 0U);
  EXPECT_THAT(std::string(no_number.what()), HasSubstr("trace.bin: column mu of group DAQ, value 12: 'nan' is not a"));
  wrong = table;
  wrong.columns[0].numbers[20] = wrong.columns[0].numbers[19];
  EXPECT_THAT(error_of(write_binary(wrong)).problem(), HasSubstr("time repeats"));
  EXPECT_EQ(error_of(write_binary(wrong)).where().value, 21U);
  wrong = table;
  wrong.columns[2].numbers.pop_back();
  EXPECT_THAT(error_of(write_binary(wrong)).problem(),
              HasSubstr("holds 39 values where the columns beside it hold 40"));
  EXPECT_EQ(error_of(write_binary(wrong)).where().column, "v_r");
  wrong = table;
  wrong.columns[2].unit = "mm/q";
  EXPECT_THAT(error_of(write_binary(wrong)).problem(), HasSubstr("unknown unit 'mm/q'"));
  wrong = table;
  wrong.columns[1].numbers.clear();
  wrong.columns[1].is_text = true;
  EXPECT_THAT(error_of(write_binary(wrong)).problem(), HasSubstr("holds text, not numbers"));
  const std::string bytes = binary_format::bytes_of(table);
  EXPECT_THAT(error_of(write(bytes.substr(0, bytes.size() / 2), "cut.bin")).problem(), HasSubstr("is cut off at byte"));
  table.columns[0].numbers[30] += 0.5;
  for (std::size_t i = 31; i < 40; ++i) table.columns[0].numbers[i] += 0.5;
  EXPECT_THAT(read(write_binary(table)).warnings,
              Contains(HasSubstr("1 gap in time, the first of 0.6 s before value 31")));
}

TEST_F(Readers, ColumnsAreNamedByTheUser) {
  RawTable table;
  table.facts = {{"fs", "100"}};
  table.columns = {column("ch1", "V", series(40, 1, 0)), column("ch2", "mV", series(40, 300, 0))};
  ReadOptions options;
  options.columns = {{"mu", "#2"}, {"v_r", "ch1"}};
  options.units = {{"v_r", "5 mm/s/V"}, {"mu", "%"}};
  const Trace trace = read(write_binary(table), options);
  EXPECT_DOUBLE_EQ(trace.velocity[3], 5e-3);
  EXPECT_DOUBLE_EQ(trace.friction[3], 3);
  options.columns["mu"] = "ch3";
  EXPECT_THAT(error_of(write_binary(table), options).problem(), HasSubstr("no column 'ch3' for mu (did you mean ch"));
}

}  // namespace
}  // namespace tribofit
