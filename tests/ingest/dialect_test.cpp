#include <fmt/format.h>

#include "csv/encoding.hpp"
#include "temp_files.hpp"

namespace tribofit {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// A trace of 30 rows with known numbers, written in a dialect.
struct Writing {
  const char* name;
  std::string before;  // preamble and header
  char separator = ',';
  char decimal = '.';
  std::string line_end = "\n";
  std::string row_end = "";
  bool quoted = false;
};

double true_time(int i) {
  return 0.05 * i;
}
double true_mu(int i) {
  return 0.3 + 0.01 * i;
}
double true_velocity(int i) {
  return 6.25 - 0.5 * i;
}  // mm/s

std::string write_table(const Writing& w) {
  std::string text = w.before;
  for (int i = 0; i < 30; ++i) {
    std::string cells[] = {fmt::format("{:.2f}", true_time(i)), fmt::format("{:.2f}", true_mu(i)),
                           fmt::format("{:.2f}", true_velocity(i))};
    for (int k = 0; k < 3; ++k) {
      if (w.decimal != '.') cells[k][cells[k].find('.')] = w.decimal;
      if (w.quoted) cells[k] = "\"" + cells[k] + "\"";
      text += (k > 0 ? std::string(1, w.separator) : std::string()) + cells[k];
    }
    text += w.row_end + w.line_end;
  }
  return text;
}

class Dialects : public TempFiles, public ::testing::WithParamInterface<Writing> {};

TEST_P(Dialects, AreReadWithoutBeingTold) {
  std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const Trace trace = read_trace(write(write_table(GetParam()), "table.csv"));
  ASSERT_EQ(trace.size(), 30U);
  for (int i = 0; i < 30; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_NEAR(trace.time[k], true_time(i), 1e-12);
    EXPECT_NEAR(trace.friction[k], true_mu(i), 1e-12);
    EXPECT_NEAR(trace.velocity[k], 1e-3 * true_velocity(i), 1e-12);
  }
  EXPECT_EQ(trace.velocity_kind, VelocityKind::block);
  EXPECT_TRUE(trace.warnings.empty()) << trace.warnings.front();
}

const std::string units_below = "Time,COF,Velocity\ns,-,mm/s\n";

INSTANTIATE_TEST_SUITE_P(
    Table, Dialects,
    ::testing::Values(
        Writing{"Comma", "time_s,mu,v_b_mm_s\n"}, Writing{"Semicolon", "time_s;mu;v_b_mm_s\n", ';'},
        Writing{"Tab", "time_s\tmu\tv_b_mm_s\n", '\t'}, Writing{"SemicolonComma", "time_s;mu;v_b_mm_s\n", ';', ','},
        Writing{"TabComma", "time_s\tmu\tv_b_mm_s\n", '\t', ','}, Writing{"Bom", "\xEF\xBB\xBFtime_s,mu,v_b_mm_s\n"},
        Writing{"CrLf", "time_s,mu,v_b_mm_s\r\n", ',', '.', "\r\n"},
        Writing{"TrailingComma", "time_s,mu,v_b_mm_s,\n", ',', '.', "\n", ","},
        Writing{"TrailingInRowsOnly", "time_s,mu,v_b_mm_s\n", ',', '.', "\n", ","},
        Writing{"QuotedHeader", "\"Time [s]\",\"COF\",\"v_b, laser [mm/s]\"\n"},
        Writing{"Quoted", "\"time_s\",\"mu\",\"v_b_mm_s\"\n", ',', '.', "\n", "", true},
        Writing{"QuotedDecimalComma", "\"time_s\";\"mu\";\"v_b_mm_s\"\n", ';', ',', "\n", "", true},
        Writing{"UnitsBelow", units_below}, Writing{"UnitsInBrackets", "Time;COF;v_b\n[s];[-];[mm/s]\n", ';', ','},
        Writing{"Preamble", "Tribometer export\nOperator: none\nSample,316SS,12,\n\ntime_s,mu,v_b_mm_s\n"},
        Writing{"CommentedPreamble", "# file of a rig\n# load 50 N\ntime_s,mu,v_b_mm_s\n"},
        Writing{"CommentedHeader", "# made by a logger\n# time_s,mu,v_b_mm_s\n"},
        Writing{"BlankBelowHeader", "time_s,mu,v_b_mm_s\n\n"},
        Writing{"Latin1", "Zeit [s];\xB5 [-];Geschwindigkeit [mm/s];\n", ';', ',', "\r\n", ";"},
        Writing{"Gbk", "\xCA\xB1\xBC\xE4(s),\xC4\xA6\xB2\xC1\xCF\xB5\xCA\xFD,\xCB\xD9\xB6\xC8(mm/s)\n"},
        Writing{"ChineseUtf8", "\u65f6\u95f4\uff08s\uff09,\u6469\u64e6\u7cfb\u6570,\u901f\u5ea6\uff08mm/s\uff09\n"},
        Writing{"SpacesInHeader", " Time (s) , Friction Coefficient (-) , Block velocity (mm/s) \n"},
        Writing{"Din", "t / s;\u03bc / 1;v_b / mm/s\n", ';', ','},
        Writing{"Dotted", "DAQ.Time (s),DAQ.COF (),Laser.Velocity (mm/s)\n"}),
    [](const auto& param) { return std::string(param.param.name); });

using Dialect_ = TempFiles;

TEST_F(Dialect_, AFileWithoutAHeaderIsReadByColumnNumbers) {
  Writing plain{"", ""};
  ReadOptions options;
  options.columns = {{"time", "#1:s"}, {"mu", "#2"}, {"v_b", "#3:mm/s"}};
  const Trace trace = read_trace(write(write_table(plain)), options);
  ASSERT_EQ(trace.size(), 30U);
  EXPECT_DOUBLE_EQ(trace.friction[1], 0.31);
  EXPECT_DOUBLE_EQ(trace.velocity[1], 5.75e-3);
  options.columns["v_b"] = "#4";
  expect_error(path("trace.csv"), options, "no column #4 for v_b", "#1 to #3");
}

TEST_F(Dialect_, TextAndCommentsBetweenRowsAreDroppedAndCounted) {
  const Trace trace =
      read_trace(write("time_s,mu,v_b_mm_s\n0,0.1,1\n# pause\n1,0.2,2\nTotalTime\n00:12:56.5\n2,0.3,3\n3,0.3,3\n\n\n"));
  EXPECT_THAT(trace.friction, ::testing::ElementsAre(0.1, 0.2, 0.3, 0.3));
  EXPECT_THAT(trace.warnings, Contains(HasSubstr("3 lines of text or comment dropped, the first is line 3")));
}

TEST_F(Dialect_, ALastLineThatIsCutOffIsDroppedAndSaid) {
  for (const char* tail : {"3,0.41", "3,", "3", "3,0.413,6.2"}) {
    const Trace trace =
        read_trace(write(std::string("time_s,mu,v_b_mm_s\n0,0.411,6.28\n1,0.412,6.27\n2,0.413,6.26\n") + tail));
    EXPECT_EQ(trace.size(), 3U) << tail;
    EXPECT_THAT(trace.notes, Contains(HasSubstr("the last line is cut off"))) << tail;
  }
  const Trace whole = read_trace(write("time_s,mu,v_b_mm_s\n0,0.411,6.28\n1,0.412,6.27\n2,0.413,6.26"));
  EXPECT_EQ(whole.size(), 3U);
  const std::string more = write("time_s,mu,v_b_mm_s\n0,0.411,6.28\n1,0.412,6.27\n2,0.413,6.26\n3,0.413,6.26,7,8");
  expect_error(more, {}, "the row has 5 cells where the file has 3 columns", "remove the extra", 5);
}

TEST_F(Dialect_, WithoutATimeColumnTheRateGivesTheTime) {
  const std::string file = write("mu,v_b_mm_s\n0.1,1\n0.2,2\n0.3,3\n");
  expect_error(file, {}, "no time column among: mu, v_b_mm_s", "rate");
  ReadOptions options;
  options.rate = 20000;
  EXPECT_THAT(read_trace(file, options).time, ::testing::ElementsAre(0, 5e-5, 1e-4));
  options.rate = 0;
  expect_error(file, options, "rate must be positive", "rate");
}

TEST_F(Dialect_, ThePreambleMayStateTheRate) {
  const std::string rows = "mu,v_b_mm_s,load_N\n0.1,1,50\n0.2,2,50\n0.3,3,50\n";
  for (const auto& [preamble, interval] : {std::pair{"Axis1\nSampling time interval(ms),0.5\n", 5e-4},
                                           {"# Sampling rate: 2 kHz\n", 5e-4},
                                           {"\"Abtastrate [Hz]\";2000;\n", 5e-4},
                                           {"Interval,0.0005,Interval,0.0005\n", 5e-4},
                                           {"fs = 2000\n", 5e-4}}) {
    const Trace trace = read_trace(write(preamble + rows));
    EXPECT_NEAR(trace.time[2], 2 * interval, 1e-12) << preamble;
    EXPECT_THAT(trace.notes, Contains(HasSubstr("of the file"))) << preamble;
  }
  EXPECT_THROW(read_trace(write("Sampling rate: high\n" + rows)), InputError);
  const Trace timed = read_trace(write("fs = 2000\ntime_s,mu,v_b_mm_s\n0,0.1,1\n1,0.2,2\n2,0.3,3\n"));
  EXPECT_NEAR(timed.rate(), 1, 1e-12) << "a time column comes first";
}

TEST(Encoding, GuessesFromPairsOfHighBytes) {
  EXPECT_EQ(guess_encoding("plain"), Encoding::utf8);
  EXPECT_EQ(guess_encoding("23 \xC2\xB0"
                           "C"),
            Encoding::utf8);
  EXPECT_EQ(guess_encoding("23 \xB0"
                           "C"),
            Encoding::latin1);
  EXPECT_EQ(guess_encoding("\xCA\xB1\xBC\xE4"), Encoding::gbk);
  EXPECT_EQ(to_utf8("\xCA\xB1\xBC\xE4", Encoding::gbk), "\u65f6\u95f4");
  EXPECT_EQ(to_utf8("\xB5m", Encoding::latin1), "\u00b5m");
}

}  // namespace
}  // namespace tribofit
