#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "command.hpp"

namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

using Lines = std::vector<std::string>;

/// A good trace with one defect, and what the message must say about it.
struct Defect {
  std::string name;
  std::function<void(Lines&)> damage;  ///< lines[0] is the header, lines[n] is line n + 1 of the file
  std::vector<std::string> says;
};

/// The cells of a line: time, mu, v_b.
void set_cell(std::string& line, std::size_t index, const std::string& text) {
  std::size_t begin = 0;
  for (std::size_t k = 0; k < index; ++k) begin = line.find(',', begin) + 1;
  line.replace(begin, std::min(line.find(',', begin), line.size()) - begin, text);
}

/// Four rows in a row: one alone is left out.
void set_cells(Lines& lines, std::size_t index, const std::string& text) {
  for (std::size_t line = 99; line < 103; ++line) set_cell(lines[line], index, text);
}

class BadTrace : public ::testing::TestWithParam<Defect> {};

TEST_P(BadTrace, IsRefusedWithPlaceAndAdvice) {
  const Workshop shop;
  Lines lines = lines_of(good_trace());
  ASSERT_GT(lines.size(), 1000u);
  GetParam().damage(lines);
  shop.write("trace.csv", joined(lines));
  const Outcome outcome = shop.identify("--radius 15mm --json r.json --csv r trace.csv");
  EXPECT_EQ(outcome.status, 3) << outcome.out;
  EXPECT_THAT(outcome.err, StartsWith("identify: error: trace.csv:"));
  EXPECT_THAT(outcome.err, HasSubstr("; "));  // problem; advice
  for (const std::string& part : GetParam().says) EXPECT_THAT(outcome.err, HasSubstr(part));
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(shop.names(), ::testing::ElementsAre("trace.csv"));  // nothing half-written
}

const std::string kHeader = "time_s,mu,v_b_mm_s";

INSTANTIATE_TEST_SUITE_P(
    Defects, BadTrace,
    ::testing::Values(
        Defect{"Empty", [](Lines& l) { l.clear(); }, {"empty"}},
        Defect{"HeaderOnly", [](Lines& l) { l.resize(1); }, {"header", "no rows"}},
        Defect{"NoColumns", [](Lines& l) { l[0] = "a,b,c"; }, {"no recognisable columns", "a, b, c", "--columns"}},
        Defect{"UnknownUnit",
               [](Lines& l) { l[0] = "time [s],mu,v_b [furlong/s]"; },
               {"unknown unit", "furlong/s", "--units"}},
        Defect{
            "TextInANumber", [](Lines& l) { set_cells(l, 1, "abc"); }, {":100:", "column mu", "'abc' is not a number"}},
        Defect{"EmptyCell", [](Lines& l) { set_cells(l, 1, ""); }, {":100:", "column mu", "empty"}},
        Defect{"RaggedRow", [](Lines& l) { l[99].erase(l[99].rfind(',')); }, {":100:", "2 cells", "3 columns"}},
        Defect{"NaN", [](Lines& l) { set_cells(l, 2, "NaN"); }, {":100:", "column v_b_mm_s", "not a finite number"}},
        Defect{
            "Infinite", [](Lines& l) { set_cells(l, 2, "-inf"); }, {":100:", "column v_b_mm_s", "not a finite number"}},
        Defect{"TimeBackwards", [](Lines& l) { std::swap(l[99], l[100]); }, {":101:", "column time_s", "backwards"}},
        Defect{"TimeRepeats", [](Lines& l) { l.insert(l.begin() + 99, l[99]); }, {":101:", "column time_s", "repeats"}},
        Defect{"Binary",
               [](Lines& l) {
                 l = {std::string("\x7f"
                                  "ELF\0\0\1\2\0\0",
                                  10) +
                      std::string(5000, '\0')};
               },
               {"binary"}},
        Defect{"OneEndlessLine", [](Lines& l) { l = {std::string(5 << 20, '1')}; }, {"line", "longer"}}),
    [](const auto& param_info) { return param_info.param.name; });

TEST(BadInput, Utf16IsNamedWithTheWayOut) {
  const Workshop shop;
  std::string wide = "\xff\xfe";
  for (const char c : good_trace().substr(0, 5000)) wide += {c, '\0'};
  shop.write("trace.csv", wide);
  const Outcome outcome = shop.identify("--radius 15mm trace.csv");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("UTF-16"), HasSubstr("UTF-8")));
}

TEST(BadInput, MissingFilesAndEmptyFolders) {
  const Workshop shop;
  Outcome outcome = shop.identify("--radius 15mm missing.csv");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("missing.csv"), HasSubstr("No such file")));
  std::filesystem::create_directory(shop / "runs");
  outcome = shop.identify("--radius 15mm runs");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("runs"), HasSubstr("no traces"), HasSubstr(".csv")));
  outcome = shop.identify("--radius 15mm --instruments lab.json runs");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("lab.json"));
}

TEST(BadInput, APipeIsNotATrace) {
  const Workshop shop;
  EXPECT_EQ(shop.shell("echo time,mu | identify --radius 15mm /dev/stdin").status, 3);
}

struct Value {
  std::string name, arguments;
  std::vector<std::string> says;
};

class BadValue : public ::testing::TestWithParam<Value> {};

TEST_P(BadValue, IsRefusedWithAnExample) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  const Outcome outcome = shop.identify(GetParam().arguments + " trace.csv");
  EXPECT_EQ(outcome.status, 3) << outcome.out;
  for (const std::string& part : GetParam().says) EXPECT_THAT(outcome.err, HasSubstr(part));
}

INSTANTIATE_TEST_SUITE_P(
    Values, BadValue,
    ::testing::Values(
        Value{"WrongKind", "--radius 15N", {"--radius", "'15N' is a force, not a length", "15mm"}},
        Value{"UnknownUnit", "--radius 15mn", {"--radius", "unknown unit 'mn'", "mm"}},
        Value{"Zero", "--radius 0mm", {"--radius", "not greater than zero"}},
        Value{"Negative", "--radius -15mm", {"--radius", "not greater than zero"}},
        Value{"NoNumber", "--radius big", {"--radius", "not a number"}},
        Value{"OneOfTheSteps", "--radius 6mm,-9mm", {"--radius", "'-9mm'"}},
        Value{"NegativeLoad", "--radius 15mm --load -5N", {"--load", "not greater than zero"}},
        Value{"SpeedAsLength", "--radius 15mm --speed 4mm", {"--speed", "angular velocity", "rpm"}},
        Value{"NoSuchChannel", "--radius 15mm --columns vb=v_b_mm_s", {"--columns", "no channel 'vb'", "'v_b'"}},
        Value{"NoSuchColumn", "--radius 15mm --columns mu=COF", {"COF", "mu"}},
        Value{"NoPair", "--radius 15mm --columns mu", {"--columns", "'mu' is not CHANNEL=COLUMN"}},
        Value{"BadFormula", "--radius 15mm --formula 'x = a*w; a=1'", {"'w'", "neither a variable nor a parameter"}}),
    [](const auto& param_info) { return param_info.param.name; });

TEST(BadInput, AFullDiscLeavesNothingHalfWritten) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  Outcome outcome = shop.shell("ulimit -f 16; identify --radius 15mm --csv out trace.csv");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("out/"), HasSubstr("cannot be written")));
  EXPECT_THAT(shop.names(), ::testing::ElementsAre("trace.csv"));
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  for (const char* full : {"--json /dev/full trace.csv", "trace.csv > /dev/full"}) {
    outcome = shop.identify(std::string("--radius 15mm ") + full);
    EXPECT_EQ(outcome.status, 3) << full;
    EXPECT_THAT(outcome.err, HasSubstr("No space left")) << full;
  }
}

/// Valid data that cannot carry the analysis: status 1, and what can be said of them is said.
TEST(NoAnalysis, TooFewCycles) {
  const Workshop shop;
  Lines lines = lines_of(good_trace());
  lines.resize(2001);
  shop.write("trace.csv", joined(lines));
  const Outcome outcome = shop.identify("--radius 15mm --json r.json trace.csv");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("fewer than three cycles"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("2 000 samples"), HasSubstr("Stick-slip")));
  EXPECT_TRUE(std::filesystem::exists(shop / "r.json"));
}

TEST(NoAnalysis, NothingSlips) {
  const Workshop shop;
  std::string text = kHeader + "\n";
  for (int i = 0; i < 10000; ++i) {
    text += std::to_string(i * 2e-4) + "," + std::to_string(0.4 + 0.003 * std::sin(1.7 * i * i)) + "," +
            std::to_string(6.28 + 0.02 * std::sin(2.3 * i * i)) + "\n";
  }
  shop.write("trace.csv", text);
  const Outcome outcome = shop.identify("--radius 15mm trace.csv");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("never slips"));
}

TEST(NoAnalysis, ConstantSignals) {
  const Workshop shop;
  std::string text = kHeader + "\n";
  for (int i = 0; i < 10000; ++i) text += std::to_string(i * 2e-4) + ",0.4,3.0\n";
  shop.write("trace.csv", text);
  EXPECT_EQ(shop.identify("--radius 15mm trace.csv").status, 1);
  EXPECT_EQ(shop.identify("--radius 15mm --speed 4rpm trace.csv").status, 1);
}

}  // namespace
