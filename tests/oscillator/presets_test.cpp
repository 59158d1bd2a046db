#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "rigs.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/sensors.hpp"

namespace tribofit {
namespace {

// The numbers in the code are those of the published table.
TEST(Presets, AreThePublishedTable) {
  std::ifstream file(TRIBOFIT_SOURCE_DIR "/data/published/table4.csv");
  ASSERT_TRUE(file) << "data/published/table4.csv is missing";
  std::string line;
  std::getline(file, line);
  ASSERT_EQ(line.substr(0, 56), "radius_mm,mu_s,mu_k,alpha_s_per_mm,beta_s_per_mm,v_r_amp");
  int rows = 0;
  for (; std::getline(file, line); ++rows) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    ASSERT_GE(row.size(), 5U);
    for (const Law& law : {Law(ExponentialLaw{}), Law(FractionalLaw{})}) {
      const PublishedTest test = published_test(1e-3 * row[0], law);
      EXPECT_DOUBLE_EQ(1e3 * test.radius, row[0]);
      EXPECT_DOUBLE_EQ(test.friction[0], row[1]);
      EXPECT_DOUBLE_EQ(test.friction[1], row[2]);
      EXPECT_DOUBLE_EQ(1e-3 * test.friction[2], law == Law(ExponentialLaw{}) ? row[3] : row[4]);
      EXPECT_NEAR(test.rig.damping_ratio(), 0.02, 1e-15);
    }
  }
  EXPECT_EQ(rows, 4);
}

TEST(Presets, TheNearestRadiusIsTaken) {
  EXPECT_DOUBLE_EQ(published_test(0.001, CoulombLaw{}).radius, 0.009);
  EXPECT_DOUBLE_EQ(published_test(0.0104, CoulombLaw{}).radius, 0.009);
  EXPECT_DOUBLE_EQ(published_test(0.0106, CoulombLaw{}).radius, 0.012);
  EXPECT_DOUBLE_EQ(published_test(1, CoulombLaw{}).radius, 0.018);
}

// The example is what data/README.md says: the same simulation gives every number of it.
TEST(Presets, TheExampleTraceIsMadeAsStated) {
  const Case c = published_case(0.015, ExponentialLaw{});
  const SimulationOptions options{
      .duration = 5, .rate = 20000, .settle = settling_time(c.rig, c.drive, c.p), .scatter = {0.004, 0}, .seed = 1};
  const SimulatedMotion motion = simulate(c, options);
  const Recording made = record(motion, c.model, c.p, {.friction_noise = 0.003, .velocity_noise = 2e-5, .seed = 1});
  std::ifstream file(TRIBOFIT_SOURCE_DIR "/data/example.csv");
  ASSERT_TRUE(file) << "data/example.csv is missing";
  std::string line;
  std::getline(file, line);
  ASSERT_EQ(line, "time_s,mu,v_b_mm_s");
  std::size_t i = 0;
  for (; std::getline(file, line); ++i) {
    ASSERT_LT(i, made.trace.size());
    char* rest = line.data();
    const auto next = [&rest] {
      const double value = std::strtod(rest, &rest);
      ++rest;
      return value;
    };
    ASSERT_NEAR(next(), made.trace.time[i], 1e-9);
    ASSERT_NEAR(next(), made.trace.friction[i], 6e-6);
    ASSERT_NEAR(next(), 1e3 * made.trace.velocity[i], 6e-5);
  }
  EXPECT_EQ(i, made.trace.size());
}

}  // namespace
}  // namespace tribofit
