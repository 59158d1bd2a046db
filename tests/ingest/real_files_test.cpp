#include <cmath>
#include <numbers>
#include <numeric>

#include "../real_data.hpp"
#include "temp_files.hpp"
#include "tribofit/ingest/list_columns.hpp"

namespace tribofit {
namespace {

constexpr double revolution = 2 * std::numbers::pi;

double mean(const std::vector<double>& values, std::size_t begin = 0, std::size_t end = 0) {
  if (end == 0) end = values.size();
  return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(begin),
                         values.begin() + static_cast<std::ptrdiff_t>(end), 0.0) /
         static_cast<double>(end - begin);
}

/// Files that are not in the repository; without them the tests say so.
class RealFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(real_data("measured"))) GTEST_SKIP() << real_data("measured") << " is absent";
  }
};

TEST_F(RealFiles, DrillString) {
  ReadOptions options;
  options.columns = {{"v_r", "bit_speed_rpm"}, {"torque", "torque_on_bit_Nm"}, {"load", "weight_on_bit_N"}};
  options.conditions.radius = {0.05, "command line"};
  const Trace trace = read_trace(real_data("measured/drill-string/drillstring_175.csv").string(), options);
  ASSERT_EQ(trace.size(), 59000U);
  EXPECT_NEAR(trace.rate(), 1000, 1e-6);
  EXPECT_EQ(trace.velocity_kind, VelocityKind::relative);
  EXPECT_EQ(trace.friction_kind, FrictionKind::coefficient);
  EXPECT_NEAR(trace.friction[0], 0.54625 / 0.05 / 539.867, 1e-12);
  EXPECT_NEAR(trace.velocity[0], 148.1578 * revolution / 60 * 0.05, 1e-12);
  const auto [low, high] = std::minmax_element(trace.load.begin(), trace.load.end());
  EXPECT_NEAR(*low, 340, 1);
  EXPECT_NEAR(*high, 743, 1);
}

TEST_F(RealFiles, RotaryTribometer) {
  struct Recipe {
    const char* file;
    std::array<double, 4> radii, velocity;
    std::array<double, 4> cof;  // means stated beside the data; 0: only a range is
  };
  const std::array<double, 4> up = {0.075, 0.15, 0.225, 0.3}, down = {0.3, 0.225, 0.15, 0.075},
                              radii = {0.006, 0.009, 0.012, 0.015};
  for (const Recipe& recipe :
       {Recipe{"013_FX2_316SS_0.25in_Rotary_3N_4tests_75-300mm-s_6-15mm-radius_3min-each.csv",
               radii,
               up,
               {0.170, 0.194, 0.204, 0.210}},
        Recipe{"014_FX2_316SS_0.25in_Rotary_3N_4tests_300-75mm-s_6-15mm-radius_3min-each.csv",
               radii,
               down,
               {0.218, 0.203, 0.187, 0.161}},
        Recipe{"017_FX2_316SS_0.25in_Rotary_9N_4tests_75-300mm-s_6-15mm-radius_3min-each.csv", radii, up, {}},
        Recipe{"019_FX2_Polyimide_0.25in_Rotary_3N_4tests_75-300mm-s_6-15mm-radius_3min-each.csv", radii, up, {}}}) {
    ReadOptions options;
    options.step_radii.assign(recipe.radii.begin(), recipe.radii.end());
    const Trace trace = read_trace((real_data("measured/rotary-tribometer") / recipe.file).string(), options);
    EXPECT_NEAR(static_cast<double>(trace.size()), 7197, 2);
    EXPECT_EQ(trace.velocity_kind, VelocityKind::fixed_block);
    ASSERT_EQ(trace.steps.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      const Step& step = trace.steps[i];
      EXPECT_EQ(step.conditions.radius.value, recipe.radii[i]);
      EXPECT_NEAR(mean(trace.disc_speed, step.begin, step.end) * recipe.radii[i], recipe.velocity[i],
                  0.01 * recipe.velocity[i])
          << recipe.file;
      if (recipe.cof[i] > 0) {
        EXPECT_NEAR(mean(trace.friction, step.begin, step.end), recipe.cof[i], 0.002) << recipe.file;
      }
    }
    EXPECT_NEAR(trace.duration(), 0.1 * static_cast<double>(trace.size() - 1), 0.2);
    for (std::size_t i = 1; i < trace.size(); ++i) ASSERT_GT(trace.time[i], trace.time[i - 1]);
    EXPECT_THROW(read_trace(trace.path), InputError) << "without a radius there is no sliding velocity";
  }
}

TEST_F(RealFiles, EmpsHasNoLoad) {
  ReadOptions options;
  options.columns = {{"v_r", "dq_f_m_per_s"}, {"force", "Force1_N"}};
  const Trace trace = read_trace(real_data("measured/emps/emps_training_measured.csv").string(), options);
  EXPECT_EQ(trace.size(), 24841U);
  EXPECT_EQ(trace.friction_kind, FrictionKind::force);
  EXPECT_DOUBLE_EQ(trace.friction[0], 89.2344322);
  EXPECT_DOUBLE_EQ(trace.velocity[0], 0.00715773501);
}

TEST_F(RealFiles, EveryDevelopmentTrace) {
  const auto folder = real_data("hidden-effects/dev");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv" || entry.path().filename() == "manifest.csv") continue;
    if (++count > 12) break;  // they are alike
    const Trace trace = read_trace(entry.path().string());
    EXPECT_GE(trace.size(), 1000U) << entry.path();
    EXPECT_EQ(trace.velocity_kind, VelocityKind::block);
    EXPECT_LT(mean(trace.friction), 1);
    EXPECT_EQ(trace.steps.size(), 1U);
    EXPECT_TRUE(trace.warnings.empty());
  }
  EXPECT_GT(count, 0U);
  const Trace load = read_trace((folder / "loaddep.csv").string());
  EXPECT_DOUBLE_EQ(load.load[0], 50.042);
  const Trace temperature = read_trace((folder / "tempdep.csv").string());
  EXPECT_DOUBLE_EQ(temperature.temperature[0], 24);
  const Trace speed = read_trace((folder / "asym.csv").string());
  EXPECT_NEAR(speed.disc_speed[0], 0.00063 * revolution / 60, 1e-15);
}

/// Files as laboratories have them.
class LaboratoryFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(real_data("lab-files"))) GTEST_SKIP() << real_data("lab-files") << " is absent";
  }
  std::string file(const char* name) const { return (real_data("lab-files") / name).string(); }
  /// Read with these columns, at a stated speed and radius.
  Trace read(const char* name, std::map<std::string, std::string> columns) const {
    ReadOptions options;
    options.columns = std::move(columns);
    options.conditions.speed = {1, "command line"};
    return read_trace(file(name), options);
  }
};

TEST_F(LaboratoryFiles, TextOfInstruments) {
  const Trace umt = read("cetr_umt.csv", {{"v_b", "none"}});
  EXPECT_EQ(umt.size(), 217U);
  ASSERT_EQ(umt.steps.size(), 2U);
  EXPECT_NEAR(umt.steps[1].conditions.radius.value, 3.9493e-3, 1e-12);
  EXPECT_NEAR(umt.steps[1].conditions.load.value, 0.2 * 9.80665, 1e-9);
  EXPECT_NEAR(mean(umt.load), 0.2 * 9.80665, 0.01);
  const Trace mtm = read("pcs_mtm_5.txt", {});
  EXPECT_EQ(mtm.size(), 1000U);
  EXPECT_EQ(mtm.velocity_kind, VelocityKind::relative);
  EXPECT_NEAR(mtm.conditions.radius.value, 21.232e-3, 1e-12);
  EXPECT_NEAR(mean(mtm.load), 20, 0.1);
  EXPECT_EQ(list_columns(file("pcs_mtm_1.txt")).columns.size(), 8U) << "a map of a film, no trace";
}

TEST_F(LaboratoryFiles, OneRunOnTwoClocks) {
  ReadOptions options;
  options.columns = {{"force", "Force:100N/V"}};
  options.second_file = file("konrad_a3MR.csv");
  options.second_columns = {{"v_r", "Servo motor speed:mm/s"}};
  const Trace trace = read_trace(file("konrad_a3NI.csv"), options);
  EXPECT_NEAR(trace.rate(), 2000, 1e-6);
  EXPECT_EQ(trace.friction_kind, FrictionKind::force);
  EXPECT_GT(trace.size(), 1000U);
}

TEST_F(LaboratoryFiles, Binary) {
  ReadOptions pull;
  pull.columns = {{"mu", "Fnorm"}, {"v_b", "none"}};
  pull.conditions = {{0.01, "command line"}, {0.11, "command line"}, {}};
  const Trace paper = read_trace(file("npusteln_k168Nm_v1100.mat"), pull);
  EXPECT_EQ(paper.size(), 28721U);
  EXPECT_NEAR(paper.rate(), 2000, 1e-6);
  const ColumnListing frame = list_columns(file("marino_s_b_250g_x.mat"));
  EXPECT_EQ(frame.columns.size(), 2U);
  EXPECT_EQ(frame.columns[1].count, 2501U);
  const ColumnListing text = list_columns(file("pyuff_58_ascii.uff")),
                      binary = list_columns(file("pyuff_58b_binary.uff"));
  EXPECT_EQ(text.columns[0].count, 79292U);
  EXPECT_EQ(binary.columns[0].count, 79292U);
  EXPECT_NEAR(text.columns[0].highest, binary.columns[0].highest, 1e-6);
  EXPECT_EQ(text.columns[0].unit, "Pa");
  EXPECT_EQ(list_columns(file("nptdms_big_endian.tdms")).columns[1].count, 3500U);
  EXPECT_EQ(list_columns(file("nptdms_raw_timestamps.tdms")).columns[0].count, 128U);
  EXPECT_THROW(list_columns(file("nptdms_raw1.tdms")), InputError) << "raw values of DAQmx";
}

}  // namespace
}  // namespace tribofit
