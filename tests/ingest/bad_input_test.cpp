#include <fmt/format.h>

#include <cmath>

#include "temp_files.hpp"

namespace tribofit {
namespace {

using BadInput = TempFiles;

std::string table(const std::string& rows) {
  return "time_s,mu,v_b_mm_s\n0.0,0.30,6.1\n0.1,0.31,6.2\n0.2,0.32,6.3\n" + rows + "0.4,0.34,6.5\n0.5,0.35,6.6\n";
}

TEST_F(BadInput, FilesThatAreNoTable) {
  expect_error(path("absent.csv"), {}, "cannot be opened: No such file", "path");
  expect_error(folder_.path(), {}, "is a folder", "CSV");
  expect_error(write(""), {}, "is empty", "export");
  expect_error(write("\n\n\n"), {}, "is empty", "export");
  expect_error(write("time_s,mu,v_b_mm_s\n"), {}, "header but no rows of numbers", "export", 1);
  expect_error(write("time_s,mu,v_b_mm_s\n\n \n"), {}, "header but no rows of numbers", "export", 1);
}

TEST_F(BadInput, FilesThatAreNotText) {
  std::string utf16 = "\xFF\xFE";
  for (const char c : table("")) utf16 += {c, '\0'};
  expect_error(write(utf16), {}, "is UTF-16", "iconv -f UTF-16 -t UTF-8");
  expect_error(write(utf16.substr(2)), {}, "is UTF-16", "CSV UTF-8");
  std::string binary(5000, '\0');
  for (std::size_t i = 0; i < binary.size(); ++i) binary[i] = static_cast<char>(i * i * 31 + i / 7);
  expect_error(write(binary), {}, "is a binary file", "text");
  expect_error(write("PK\x03\x04 and more"), {}, "Excel workbook", "save the sheet as CSV");
  expect_error(write("\x1F\x8B\x08 and more"), {}, "compressed with gzip", "gunzip");
}

TEST_F(BadInput, ANulByteInsideIsNamedWithItsLine) {
  std::string text = table("");
  while (text.size() < 8000) text += fmt::format("{:.1f},0.3,6.1\n", 0.6 + 0.1 * static_cast<double>(text.size()));
  const auto line = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  text += std::string("9999.9,0.") + '\0' + "3,6.1\n99999.1,0.3,6.1\n";
  expect_error(write(text), {}, "NUL byte", "damaged", line);
}

TEST_F(BadInput, AHugeLineIsRefusedWithoutBeingHeld) {
  const std::string file = write("");
  std::filesystem::resize_file(file, std::uintmax_t{4} << 30);  // sparse: nothing is written
  expect_error(file, {}, "binary", "text");
  const std::string digits = write("1,2,3,", "digits.csv");
  {
    std::ofstream out(digits, std::ios::app);
    for (int i = 0; i < 3000; ++i) out << std::string(1024, '7');
  }
  expect_error(digits, {}, "a line is longer than 1 MB", "one row", 1);
  std::string inside = table("");
  for (int i = 0; i < 60000; ++i) inside += fmt::format("{},0.3,6.1\n", i + 1);
  const auto line = static_cast<std::size_t>(std::count(inside.begin(), inside.end(), '\n')) + 1;
  expect_error(write(inside + std::string(4 << 20, '5') + "\n", "inside.csv"), {}, "a line is longer than 1 MB",
               "one row", line);
}

TEST_F(BadInput, CellsAndRows) {
  expect_error(write(table("0.3,abc,6.4\n")), {}, "'abc' is not a number", "columns", 5, "mu");
  expect_error(write(table("0.3,0.3x,6.4\n")), {}, "'0.3x' is not a number", "columns", 5, "mu");
  expect_error(write(table("0.3,,6.4\n")), {}, "the cell is empty", "fill it in", 5, "mu");
  expect_error(write(table("0.3,0.33,\n")), {}, "the cell is empty", "fill it in", 5, "v_b_mm_s");
  expect_error(write(table("0.3,0.33\n")), {}, "the row has 2 cells where the file has 3 columns", "complete or remove",
               5);
  expect_error(write(table("0.3,0.33,6.4,7\n")), {}, "the row has 4 cells where the file has 3 columns",
               "remove the extra", 5);
  expect_error(write(table("0.3,nan,6.4\n")), {}, "'nan' is not a finite number", "remove the row", 5, "mu");
  expect_error(write(table("0.3,0.33,-inf\n")), {}, "'-inf' is not a finite number", "remove the row", 5, "v_b_mm_s");
  expect_error(write(table("0.3,1e999,6.4\n")), {}, "'1e999' is not a finite number", "remove the row", 5, "mu");
  expect_error(write(table("0.3,\"0.33,6.4\n")), {}, "a quote is opened and not closed", "close", 5);
  expect_error(write(table("0,3,0,33,6,4\n")), {}, "6 cells where the file has 3 columns", "decimal comma", 5);
}

TEST_F(BadInput, NumbersThatCannotBeASample) {
  expect_error(write(table("0.3,1e200,6.4\n")), {}, "'1e200' is not a finite number", "remove the row", 5, "mu");
  expect_error(write("time_s,Ft_N,Fn_N,v_b_mm_s\n0,1,10,1\n1,1,1e-300,1\n2,1,10,1\n"), {}, "the load is", "load=none",
               3, "Fn_N");
}

TEST_F(BadInput, Clocks) {
  expect_error(write(table("0.2,0.33,6.4\n")), {}, "time repeats", "rate", 5, "time_s");
  expect_error(write(table("0.1,0.33,6.4\n")), {}, "time goes backwards", "sort", 5, "time_s");
  std::string irregular = "time_s,mu,v_b_mm_s\n";
  double t = 0;
  for (int i = 0; i < 2000; ++i) irregular += fmt::format("{:.3f},0.3,6.1\n", t += i % 10 == 9 ? 0.35 : 0.1);
  expect_error(write(irregular), {}, "the clock is irregular", "rate", 11, "time_s");
}

TEST_F(BadInput, UnknownColumnsAreNamedWithThoseThatWereFound) {
  expect_error(write("a,b,c\n1,2,3\n2,3,4\n"), {}, "no recognisable columns among: a, b, c", "columns time=NAME");
  expect_error(write("1,2,3\n2,3,4\n"), {}, "no recognisable columns; the file has no header and 3 columns", "time=#1");
  expect_error(write("time_s,b,v_b_mm_s\n1,2,3\n2,3,4\n"), {},
               "no friction column (mu, force or torque) among: time_s, b, v_b_mm_s", "mu=NAME");
  expect_error(write("time_s,mu,c\n1,2,3\n2,3,4\n"), {}, "no velocity column", "v_b=NAME");
  ReadOptions options;
  options.columns = {{"mu", "CoF"}};
  expect_error(write("time_s,COFF,v_b_mm_s\n1,2,3\n2,3,4\n"), options,
               "there is no column 'CoF' for mu (did you mean COFF?)", "the columns are: time_s, COFF, v_b_mm_s", 1);
  options.columns = {{"muu", "COFF"}};
  EXPECT_THROW(read_trace(path("trace.csv"), options), InputError);
}

TEST_F(BadInput, Units) {
  expect_error(write("time_s,mu,v_b [mm/q]\n1,2,3\n2,3,4\n"), {}, "unknown unit 'mm/q'", "did you mean mm/s?", 1,
               "v_b [mm/q]");
  expect_error(write("time_s,mu,v_b [N]\n1,2,3\n2,3,4\n"), {}, "unit 'N' is a force, not a velocity", "units v_b=mm/s",
               1, "v_b [N]");
  expect_error(write("time,mu,v_b\ns,,mm/q\n1,2,3\n2,3,4\n"), {}, "unknown unit 'mm/q'", "units v_b=mm/s", 2, "v_b");
  expect_error(write("time,mu,v_b\ns,-,rpm\n1,2,3\n2,3,4\n"), {}, "rotational speed needs the friction radius",
               "radius");
  expect_error(write("time_s,mu,v_b\n1,2,3\n2,3,4\n"), {}, "has no unit", "units v_b=mm/s", 1, "v_b");
  expect_error(write("time_s,mu,v_b [V]\n1,2,3\n2,3,4\n"), {}, "is in volts", "5 mm/s/V", 1, "v_b [V]");
}

TEST_F(BadInput, ConditionsThatCannotBe) {
  ReadOptions options;
  options.conditions.radius = {-0.01, "command line"};
  expect_error(write(table("0.3,0.33,6.4\n")), options, "radius of -10 mm", "above zero");
  options.conditions.radius = {0, "command line"};
  expect_error(write(table("0.3,0.33,6.4\n")), options, "radius of 0 mm", "above zero");
  expect_error(write("time_s,Ft_N,Fn_N,v_b_mm_s\n0,1,10,1\n1,1,0,1\n2,1,10,1\n"), {}, "the load is 0 N",
               "columns load=none", 3, "Fn_N");
  expect_error(write("time_s,torque_Nm,v_b_mm_s\n0,1,10\n1,1,2\n"), {},
               "friction from a torque needs the friction radius", "radius");
  expect_error(write("time_s,mu,speed_rpm\n0,1,10\n1,1,2\n"), {}, "fixed block needs the friction radius", "radius");
  expect_error(write("time_s,mu,v_b_mm_s\n0,1,10\n"), {}, "one row only", "two samples");
}

TEST_F(BadInput, ALoneTimeStampInThePastIsNoRestart) {
  const auto with_stamp = [](int row, const char* stamp, int rows) {
    std::string text = "time_s,mu,v_b_mm_s\n";
    for (int i = 0; i < rows; ++i) {
      text += (i == row ? std::string(stamp) : fmt::format("{:.1f}", 0.1 * i)) + ",0.3,6.1\n";
    }
    return text;
  };
  expect_error(write(with_stamp(30, "0.0", 60)), {}, "time goes backwards", "sort", 32, "time_s");
  expect_error(write(with_stamp(59, "0.0", 60)), {}, "time goes backwards", "sort", 61, "time_s");
  std::string restart = with_stamp(-1, "", 30);
  for (int i = 0; i < 30; ++i) restart += fmt::format("{:.1f},0.3,6.1\n", 0.1 * i);
  EXPECT_EQ(read_trace(write(restart)).steps.size(), 2U);
}

TEST_F(BadInput, APartOfTheRunGivenTwice) {
  const std::string file = write(table("0.3,0.33,6.4\n")), next = write(table("0.3,0.33,6.4\n"), "next.csv");
  ReadOptions options;
  options.continued_in = {next};
  EXPECT_NO_THROW(read_trace(file, options)) << "another file that happens to hold the same";
  options.continued_in = {(folder_ / "." / "trace.csv").string()};
  EXPECT_THROW(read_trace(file, options), InputError);
  options.continued_in = {next, next};
  EXPECT_THROW(read_trace(file, options), InputError);
}

TEST(Settings, HaveTheNamesThatTheProgramGivesThem) {
  EXPECT_EQ(setting("radius", "15mm"), "radius 15mm");
  name_settings([](std::string_view key) { return "--" + std::string(key); });
  EXPECT_EQ(setting("radius", "15mm"), "--radius 15mm");
  EXPECT_EQ(setting("kind"), "--kind");
  name_settings(nullptr);
}

}  // namespace
}  // namespace tribofit
