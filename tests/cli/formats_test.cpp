#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../ingest/record_files.hpp"
#include "command.hpp"

namespace {

using ::testing::HasSubstr;
namespace files = tribofit::record_files;

/// The columns of a trace in CSV with names that hold the units.
files::Columns columns_of(const std::string& text) {
  std::istringstream lines(text);
  std::string line, cell;
  files::Columns columns;
  std::getline(lines, line);
  for (std::istringstream header(line); std::getline(header, cell, ',');) columns.push_back({cell, "", {}});
  while (std::getline(lines, line)) {
    std::istringstream row(line);
    for (files::Column& column : columns) {
      std::getline(row, cell, ',');
      column.values.push_back(std::stod(cell));
    }
  }
  return columns;
}

std::string in_blanks(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  return text;
}

TEST(FormatsOfFiles, OneRecordGivesOneResult) {
  const Workshop shop;
  const files::Columns columns = columns_of(good_trace());
  ASSERT_EQ(columns.size(), 3u);
  ASSERT_GT(columns[0].values.size(), 1000u);
  shop.write("trace.csv", good_trace());
  shop.write("blanks.txt", in_blanks(good_trace()));
  shop.write("v5.mat", files::mat5_of(columns));
  shop.write("packed.mat", files::mat5_of(columns, false, true));
  shop.write("big-endian.mat", files::mat5_of(columns, true));
  files::write_mat73((shop / "v73.mat").string(), columns);
  shop.write("text.uff", files::uff_of(columns));
  shop.write("binary.uff", files::uff_binary_of(columns));
  shop.write("trace.tdms", files::tdms_of(columns));
  shop.write("interleaved.tdms", files::tdms_of(columns, true, true));
  const auto result_of = [&](const std::string& name) {
    const Outcome outcome = shop.identify("--radius 15mm --quiet --json r.json " + name);
    EXPECT_EQ(outcome.status, 0) << name << ": " << outcome.err;
    auto result = json_in(shop / "r.json");
    EXPECT_EQ(result["trace"]["path"], name);
    result["trace"].erase("path");
    return result;
  };
  const auto expected = result_of("trace.csv");
  for (const char* name : {"blanks.txt", "v5.mat", "packed.mat", "big-endian.mat", "v73.mat", "text.uff", "binary.uff",
                           "trace.tdms", "interleaved.tdms"}) {
    EXPECT_EQ(result_of(name), expected) << name;
  }
}

TEST(FormatsOfFiles, ColumnsListsWhatAFileHolds) {
  const Workshop shop;
  shop.write("trace.mat",
             files::mat5_of({{"t", "", {0, 1, 2}}, {"cof", "", {0.1, 0.2, 0.4}}, {"laser", "", {5, 6, 7}}}));
  Outcome outcome = shop.identify("columns trace.mat");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("trace.mat: MATLAB, 3 columns"));
  EXPECT_THAT(outcome.out, HasSubstr("cof               3     0.1      0.4  mu"));
  EXPECT_THAT(outcome.out, HasSubstr("Not recognised here: velocity (v_b, v_r, x_b or speed)"));
  outcome = shop.identify("trace.mat");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("'identify columns trace.mat' lists what it holds"));
  outcome = shop.identify("columns missing.mat");
  EXPECT_EQ(outcome.status, 3);
  outcome = shop.identify("columns");
  EXPECT_EQ(outcome.status, 2);
}

TEST(FormatsOfFiles, DamagedOnesAreRefusedWithAPlace) {
  const Workshop shop;
  const files::Columns columns = columns_of(good_trace());
  for (const auto& [name, bytes] :
       {std::pair{"a.mat", files::mat5_of(columns)}, std::pair{"b.mat", files::mat5_of(columns, false, true)},
        std::pair{"a.uff", files::uff_of(columns)}, std::pair{"b.uff", files::uff_binary_of(columns)},
        std::pair{"a.tdms", files::tdms_of(columns)}}) {
    shop.write(name, bytes.substr(0, bytes.size() / 4 * 3));
    const Outcome outcome = shop.identify(std::string("--radius 15mm ") + name);
    EXPECT_EQ(outcome.status, 3) << name;
    EXPECT_THAT(outcome.err, HasSubstr(std::string(name) + ": byte ")) << name;
  }
  files::write_mat73((shop / "c.mat").string(), columns);
  const std::string whole = contents(shop / "c.mat");
  shop.write("c.mat", whole.substr(0, whole.size() / 2));
  const Outcome outcome = shop.identify("--radius 15mm c.mat");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("cannot be read; the file is damaged"));
}

TEST(FormatsOfFiles, ColumnsOfTheSecondFileNeedOne) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  const Outcome outcome = shop.identify("--radius 15mm --with-columns v_b=v_b_mm_s trace.csv");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("name it with --with"));
}

}  // namespace
