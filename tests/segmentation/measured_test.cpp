// Real rigs and an independent simulator; skipped where the shared data are absent.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "../real_data.hpp"
#include "tribofit/segmentation/cycles.hpp"
#include "tribofit/statistics/spectrum.hpp"

namespace tribofit {
namespace {

using Table = std::map<std::string, std::vector<double>>;
constexpr double rpm = 2 * std::numbers::pi / 60;

// Plain comma-separated numbers under one header line; the ingest module has its own tests.
Table read_plain(const std::filesystem::path& path) {
  std::ifstream file(path);
  Table table;
  std::vector<std::vector<double>*> columns;
  std::string line, cell;
  std::getline(file, line);
  std::istringstream header(line);
  while (std::getline(header, cell, ',')) columns.push_back(&table[cell]);
  while (std::getline(file, line)) {
    const char* at = line.c_str();
    for (auto* column : columns) {
      char* end = nullptr;
      column->push_back(std::strtod(at, &end));
      at = *end == ',' ? end + 1 : end;
    }
  }
  return table;
}

TEST(Measured, DrillString) {
  const auto path = real_data("measured/drill-string/drillstring_175.csv");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent";
  Table table = read_plain(path);
  Trace trace;
  trace.time = table["time_s"];
  trace.load = table["weight_on_bit_N"];
  trace.velocity_kind = VelocityKind::relative;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    trace.velocity.push_back(table["bit_speed_rpm"][i] * rpm * 0.05);
    trace.friction.push_back(table["torque_on_bit_Nm"][i] / 0.05 / trace.load[i]);
  }
  trace.steps = {{0, trace.size(), "", {}}};
  const Motion motion = compute_motion(std::move(trace));
  const Segmentation s = find_cycles(motion);
  EXPECT_EQ(s.kind, MotionKind::stick_slip);
  EXPECT_GE(s.cycles.size(), 100u);
  EXPECT_LE(s.cycles.size(), 150u);
  EXPECT_NEAR(s.frequency.value, 2.7, 0.15);
  EXPECT_NEAR(fundamental(motion.relative_velocity, motion.step).frequency, 2.7, 0.1);
  int long_sticks = 0;
  for (const Cycle& c : s.cycles) long_sticks += c.stick_time > 1 ? 1 : 0;
  EXPECT_EQ(long_sticks, 3);
}

TEST(Measured, PositioningSystemReversesAndNeverDrifts) {
  const auto path = real_data("measured/emps/emps_training_measured.csv");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent";
  Table table = read_plain(path);
  Trace trace;
  trace.time = table["time_s"];
  trace.velocity = table["dq_f_m_per_s"];
  trace.velocity_kind = VelocityKind::relative;
  trace.friction_kind = FrictionKind::force;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    trace.friction.push_back(table["Force1_N"][i] - 95.1 * table["ddq_f_m_per_s2"][i] + 3.16);
  }
  trace.steps = {{0, trace.size(), "", {}}};
  const Segmentation s = find_cycles(compute_motion(std::move(trace)));
  int forward = 0, backward = 0;
  for (const Cycle& c : s.cycles) {
    (c.direction > 0 ? forward : backward) += 1;
    EXPECT_GT(c.peak_velocity, 0.04);
    EXPECT_LT(c.peak_velocity, 0.14);
  }
  EXPECT_EQ(forward, backward);  // the same moves there and back
  EXPECT_GE(forward, 4);
}

TEST(Measured, HiddenEffectsOfAnIndependentSimulator) {
  const auto folder = real_data("hidden-effects/dev");
  if (!std::filesystem::exists(folder / "truth.jsonl")) GTEST_SKIP() << folder << " is absent";
  std::ifstream truth(folder / "truth.jsonl");
  std::string line;
  int checked = 0;
  const auto field = [&line](const std::string& key) {
    return line.substr(line.find("\"" + key + "\":") + key.size() + 3);
  };
  while (std::getline(truth, line)) {
    const std::string name = field("name").substr(2, field("name").find('"', 2) - 2);
    const auto path = folder / (name + ".csv");
    if (!std::filesystem::exists(path)) continue;
    Table table = read_plain(path);
    Trace trace;
    trace.time = table["time_s"];
    trace.friction = table["mu"];
    for (double v : table["v_b_mm_s"]) trace.velocity.push_back(1e-3 * v);
    for (double w : table["speed_rpm"]) trace.disc_speed.push_back(w * rpm);
    trace.conditions.radius = {0.015, "file"};
    if (trace.disc_speed.empty()) trace.conditions.speed = {4 * rpm, "file"};
    trace.steps = {{0, trace.size(), "", {}}};
    const Motion motion = compute_motion(std::move(trace));
    const Segmentation s = find_cycles(motion);
    std::size_t events = 0;
    for (const Cycle& c : s.cycles) events += c.stick.size() > 0 ? 1u : 0u;
    EXPECT_EQ(events, static_cast<std::size_t>(std::stoul(field("events")))) << name;
    EXPECT_EQ(motion.high_pass > 0, name == "highpass") << name;
    if (name == "highpass") {
      EXPECT_NEAR(motion.high_pass / std::stod(field("highpass_hz")), 1, 0.02);
    }
    ++checked;
  }
  EXPECT_GT(checked, 30);
}

}  // namespace
}  // namespace tribofit
