#include "tribofit/report/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "../folder.hpp"
#include "made_up.hpp"
#include "tribofit/output/whole_file.hpp"

namespace tribofit {
namespace {

using Rows = std::vector<std::vector<std::string>>;

Rows read_rows(const std::string& path) {
  Rows rows;
  std::istringstream in(contents(path));
  for (std::string line; std::getline(in, line);) {
    rows.emplace_back(1);
    for (const char c : line) {
      if (c == ',') {
        rows.back().emplace_back();
      } else {
        rows.back().back() += c;
      }
    }
  }
  return rows;
}

class Csv : public ::testing::Test {
 protected:
  Rows written(const std::string& name) {
    write_csv_folder(folder_.path("out"), result_);
    return read_rows(folder_.path("out/" + name));
  }
  Folder folder_;
  Identification result_ = made_up_result();
};

TEST_F(Csv, SamplesHaveTheAgreedColumnsAndUnits) {
  const Rows rows = written("samples.csv");
  EXPECT_THAT(rows[0], ::testing::ElementsAre("time_s", "relative_velocity_mm_s", "mu", "mu_model", "phase", "cycle",
                                              "held_out_fold"));
  ASSERT_EQ(rows.size(), 13u);
  EXPECT_EQ(rows[1], (std::vector<std::string>{"0", "0", "0.509", "", "stick", "0", "0"}));
  EXPECT_EQ(rows[5][1], "80");  // 0.08 m/s
  EXPECT_EQ(rows[5][4], "slip");
  // The made-up friction is that of the made-up law.
  EXPECT_NEAR(std::stod(rows[5][3]), 0.318 + 0.191 * std::exp(-52.14 * 0.08), 1e-9);
  EXPECT_EQ(rows[12][5], "1");
  EXPECT_EQ(rows[12][6], "1");  // two cycles, two folds
}

TEST_F(Csv, CyclesLeaveUnknownCellsEmpty) {
  const Rows rows = written("cycles.csv");
  ASSERT_EQ(rows.size(), 3u);
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  EXPECT_EQ(rows[0][5], "stick_time_s");
  EXPECT_EQ(rows[1][5], "");
  EXPECT_EQ(rows[2][5], "0.175");
  const auto peak = std::find(rows[0].begin(), rows[0].end(), "peak_velocity_mm_s") - rows[0].begin();
  EXPECT_EQ(rows[1][static_cast<std::size_t>(peak)], "83.9");
}

TEST_F(Csv, CurvesReachBeyondTheDataAndSayWhere) {
  const Rows rows = written("curves.csv");
  ASSERT_EQ(rows.size(), 1u + 3 * 201);
  EXPECT_EQ(rows[1][0], "exponential");
  EXPECT_NEAR(std::stod(rows[1][4]), 0.509, 1e-9);
  EXPECT_EQ(rows[1][7], "1");
  EXPECT_NEAR(std::stod(rows[201][3]), 1.25 * 83.9, 1e-6);
  EXPECT_EQ(rows[201][7], "0");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_LE(std::stod(rows[i][5]), std::stod(rows[i][4]));
    EXPECT_GE(std::stod(rows[i][6]), std::stod(rows[i][4]));
  }
}

TEST_F(Csv, ErrorsAreOverSlipOnly) {
  result_.motion.friction[4] *= 1.25;
  const Rows rows = written("errors.csv");
  EXPECT_EQ(rows[0][2], "residual_1");
  ASSERT_EQ(rows.size(), 1u + 8);
  EXPECT_EQ(rows[3][0], "0.4");
  EXPECT_NEAR(std::stod(rows[3][3]), 0.2, 1e-9);  // |(1.25 - 1) / 1.25|, Eq 5
  EXPECT_NEAR(std::stod(rows[2][3]), 0, 1e-9);
}

TEST_F(Csv, ForcesCarryTheirUnit) {
  result_.motion.friction_kind = FrictionKind::force;
  EXPECT_EQ(written("errors.csv")[0][2], "residual_N");
  EXPECT_THAT(written("cycles.csv")[0], ::testing::Contains("static_friction_N"));
}

TEST_F(Csv, WritesWithoutAFit) {
  result_.fits.clear();
  result_.analysed = false;
  EXPECT_EQ(written("samples.csv").size(), 13u);
  EXPECT_EQ(written("curves.csv").size(), 1u);
}

TEST_F(Csv, AFileInTheWayIsNamedAndNothingAppears) {
  std::ofstream(folder_.path("out")) << "mine";
  EXPECT_THROW(write_csv_folder(folder_.path("out"), result_), WriteError);
  EXPECT_EQ(contents(folder_.path("out")), "mine");
}

TEST_F(Csv, AllOrNothing) {
  std::filesystem::create_directories(folder_.path("out/errors.csv"));  // the last file cannot be written
  EXPECT_THROW(write_csv_folder(folder_.path("out"), result_), WriteError);
  EXPECT_THAT(read_rows(folder_.path("out/samples.csv")), ::testing::IsEmpty());
  const Folder other;
  EXPECT_THROW(write_csv_folder(other.path("a/b"), result_), WriteError);
  EXPECT_TRUE(other.names().empty());
}

}  // namespace
}  // namespace tribofit
