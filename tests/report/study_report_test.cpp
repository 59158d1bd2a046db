// Reports of studies against what is known of the machines: circles, resonances, one large cell among many.
#include "tribofit/report/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "../study/machines.hpp"

namespace {

using namespace tribofit;
using ::testing::HasSubstr;

template <class Item>
std::vector<const Item*> items_of(const Report& report) {
  std::vector<const Item*> out;
  for (const ReportSection& section : report.sections) {
    for (const ReportItem& item : section.items) {
      if (const auto* one = std::get_if<Item>(&item)) out.push_back(one);
    }
  }
  return out;
}

const Chart& chart_of(const Report& report, const std::string& id) {
  for (const Chart* chart : items_of<Chart>(report)) {
    if (chart->id == id) return *chart;
  }
  throw std::runtime_error("no chart " + id);
}

const ChartLine& line_of(const Chart& chart, const std::string& name) {
  for (const ChartLine& line : chart.lines) {
    if (line.name == name) return line;
  }
  throw std::runtime_error("no line " + name + " in " + chart.id);
}

StudiedMachine studied(const Machine& machine) {
  StudiedMachine out;
  out.machine = machine;
  out.source = "given values";
  return out;
}

/// What every chart must keep: names used once, series of one length, a unit on every axis that counts nothing.
void expect_sound(const Report& report) {
  std::set<std::string> ids;
  for (const Chart* chart : items_of<Chart>(report)) {
    EXPECT_TRUE(ids.insert(chart->id).second) << chart->id;
    EXPECT_EQ(chart->id.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-"),
              std::string::npos)
        << chart->id;
    EXPECT_FALSE(chart->title.empty()) << chart->id;
    EXPECT_TRUE(!chart->x.unit.empty() || !chart->x.names.empty()) << chart->id;
    for (const ChartAxis& axis : chart->panels) {
      EXPECT_TRUE(!axis.unit.empty() || !axis.names.empty()) << chart->id;
    }
    for (const ChartLine& line : chart->lines) {
      EXPECT_EQ(line.x.size(), line.y.size()) << chart->id << " " << line.name;
      EXPECT_LT(line.panel, chart->panels.size()) << chart->id << " " << line.name;
      for (const double x : line.x) {
        EXPECT_FALSE(x < chart->x.low - 1e-9) << chart->id << " " << line.name;  // NaN: the range is that of the data
        EXPECT_FALSE(x > chart->x.high + 1e-9) << chart->id << " " << line.name;
      }
    }
  }
  EXPECT_FALSE(report.lead.empty());
}

TEST(StudyReport, CoulombPortraitIsAnArcAndAStraightLine) {
  Machine machine = tribofit::studies::published_machine();
  machine.model = FrictionModel(CoulombLaw{});
  machine.parameters = {0.5, 0.3};
  machine.rig.damping = 0;
  const double k = machine.rig.stiffness, omega = machine.rig.natural_frequency(), v = machine.disc_velocity();
  const double x_k = machine.load * 0.3 / k, x_s = machine.load * 0.5 / k;
  const double radius = std::hypot(x_s - x_k, v / omega);  // of the slip in the plane of x and x'/omega
  const Report report = report_of(studied(machine), study_phase(machine, {v}));
  expect_sound(report);
  const Chart& chart = chart_of(report, "phase-1");
  const ChartLine& cycle = line_of(chart, "settled cycle");
  std::size_t sticking = 0, slipping = 0;
  double least = 0;
  for (std::size_t i = 0; i < cycle.x.size(); ++i) {
    const double x = 1e-3 * cycle.x[i], speed = 1e-3 * cycle.y[i];
    if (std::abs(speed / v - 1) < 1e-9) {
      ++sticking;
      EXPECT_LE(x, x_s * (1 + 1e-6));
      EXPECT_GE(x, 2 * x_k - x_s - 1e-6 * x_s);  // re-stick: as far on the other side of the arc
      continue;
    }
    ++slipping;
    EXPECT_NEAR(std::hypot(x - x_k, speed / omega), radius, 1e-5 * radius);
    least = std::min(least, speed);
  }
  EXPECT_GT(sticking, 20u);
  EXPECT_GT(slipping, 100u);
  EXPECT_NEAR(least, -omega * radius, 1e-3 * omega * radius);  // the peak survives the drawing
  ASSERT_EQ(chart.marks.size(), 1u);
  EXPECT_NEAR(chart.marks[0].at, 1e3 * v, 1e-9);
}

TEST(StudyReport, TheBlockThatIsDrawnMovesAsItIsSimulated) {
  const Machine machine = tribofit::studies::published_machine();
  const Report report = report_of(studied(machine), study_phase(machine, {machine.disc_velocity()}));
  const auto animations = items_of<Animation>(report);
  ASSERT_EQ(animations.size(), 1u);
  EXPECT_NEAR(animations[0]->disc_velocity, 1e3 * machine.disc_velocity(), 1e-9);
  ASSERT_EQ(animations[0]->blocks.size(), 1u);
  const Animation::Block& block = animations[0]->blocks[0];
  const Settled settled = settle(machine);
  EXPECT_NEAR(block.time.back() - block.time.front(), 1 / settled.frequency, 2e-3 / settled.frequency);
  const auto [low, high] = std::minmax_element(block.displacement.begin(), block.displacement.end());
  EXPECT_NEAR(*high - *low, 1e3 * settled.peak_to_peak, 1e-3 * *high);
  double stuck = 0;
  for (std::size_t i = 0; i + 1 < block.time.size(); ++i) {
    if (block.sticks[i]) stuck += block.time[i + 1] - block.time[i];
  }
  EXPECT_NEAR(stuck, settled.stick_time, 0.01 * settled.stick_time);
}

TEST(StudyReport, ResponseHasItsPeakAtTheResonance) {
  Machine machine = tribofit::studies::published_machine();
  constexpr double kRatio = 0.2;
  machine.rig = rig_with_damping_ratio(machine.rig.mass, machine.rig.stiffness, kRatio);
  const Response study = study_response(machine);
  const Report report = report_of(studied(machine), study);
  expect_sound(report);
  const ChartLine& curve = line_of(chart_of(report, "response-curve"), "A(omega)");
  const auto peak = std::max_element(curve.y.begin(), curve.y.end());
  const double expected = study.force / (2 * machine.rig.stiffness * kRatio * std::sqrt(1 - kRatio * kRatio));
  EXPECT_NEAR(*peak, 1e3 * expected, 1e-3 * 1e3 * expected);
  const double at = curve.x[static_cast<std::size_t>(peak - curve.y.begin())];
  EXPECT_NEAR(at, study.natural_frequency * std::sqrt(1 - 2 * kRatio * kRatio), 0.02 * at);
  // Stems stand on the multiples of the response frequency.
  const ChartLine& ends = chart_of(report, "spectrum-force").lines.back();
  ASSERT_EQ(ends.x.size(), study.harmonics.size());
  EXPECT_NEAR(ends.x[2], 3 * study.settled.frequency, 1e-9);
  EXPECT_NEAR(ends.y[0], study.force, 1e-12);
}

TEST(StudyReport, CriticalSpeedsAreMarkedWhereTheyAre) {
  const Machine machine = tribofit::studies::uradnicek_machine(330, 0.5e-3);
  SpeedStudyOptions options;
  options.points = 12;
  options.draws = 0;
  const SpeedStudy study = study_speed(machine, options);
  const Report report = report_of(studied(machine), study);
  expect_sound(report);
  EXPECT_EQ(items_of<Chart>(report).size(), 3u);
  const Chart& chart = chart_of(report, "speed-motion");
  std::vector<double> upright;
  for (const ChartMark& mark : chart.marks) {
    if (mark.upright) upright.push_back(mark.at);
  }
  ASSERT_FALSE(study.critical.linear.empty());
  EXPECT_THAT(upright, ::testing::Contains(::testing::DoubleNear(1e3 * study.critical.linear.back(), 1e-9)));
  EXPECT_THAT(upright, ::testing::Contains(::testing::DoubleNear(1e3 * study.critical.stick_vanishes, 1e-9)));
  const ChartLine& up = line_of(chart, "begun in stick (way up)");
  // Where the motion jumps, the line is drawn on from the next speed on: two further points stand beside each jump.
  ASSERT_EQ(up.y.size(), study.up.size() + 2);
  EXPECT_DOUBLE_EQ(up.y[3], study.up[3].frequency);
  EXPECT_THAT(report.lead, HasSubstr("stick vanishes"));
}

TEST(StudyReport, ElasticitiesAreRankedBySize) {
  const Machine machine = tribofit::studies::published_machine();
  const std::vector<Sensitivity> study = study_sensitivity(machine, {.variables = {}, .factor = 1.5, .count = 5});
  const Report report = report_of(studied(machine), study);
  expect_sound(report);
  for (const MeasureInfo& measure : measures()) {
    const Chart& chart = chart_of(report, "elasticity-" + measure.name);
    ASSERT_EQ(chart.lines.size(), 1u);
    const std::vector<double>& e = chart.lines[0].x;  // from below
    EXPECT_EQ(e.size(), chart.panels[0].names.size());
    for (std::size_t k = 1; k < e.size(); ++k) EXPECT_GE(std::abs(e[k]), std::abs(e[k - 1]));
    EXPECT_FALSE(chart_of(report, "sweep-" + measure.name).lines.empty());
  }
  // Force and stiffness scale the displacement: with the load peak-to-peak rises in proportion, sum rule of dimensions:
  // twice load, mass, stiffness and damping leave the motion as it is.
  const Chart& chart = chart_of(report, "elasticity-peak-to-peak");
  double sum = 0;
  for (std::size_t k = 0; k < chart.panels[0].names.size(); ++k) {
    const std::string& name = chart.panels[0].names[k];
    if (name == "load" || name == "mass" || name == "stiffness" || name == "damping") sum += chart.lines[0].x[k];
  }
  EXPECT_NEAR(sum, 0, 2e-3);
}

TEST(StudyReport, ASingleLargeCellOfALargeMapIsDrawn) {
  const Machine machine = tribofit::studies::published_machine();
  MapRequest request{machine,
                     {variable_named(machine, "stiffness"), evenly_spaced(8e3, 20e3, 700)},
                     {variable_named(machine, "mass"), evenly_spaced(0.5, 1.5, 500)},
                     {}};
  MapCell cell{Regime::stick_slip, std::vector<double>(measures().size(), 1e-3)};
  std::vector<std::vector<MapCell>> rows(500, std::vector<MapCell>(700, cell));
  const auto k = static_cast<std::size_t>(&measure_named("peak-to-peak") - measures().data());
  rows[311][423].values[k] = 7e-3;
  const Report report = report_of(studied(machine), request, rows, measure_named("peak-to-peak"));
  expect_sound(report);
  const Chart& chart = chart_of(report, "map-peak-to-peak");
  ASSERT_TRUE(chart.map);
  EXPECT_LE(chart.map->x.size() * chart.map->y.size(), 25000u);
  std::size_t large = 0;
  for (std::size_t j = 0; j < chart.map->y.size(); ++j) {
    for (std::size_t i = 0; i < chart.map->x.size(); ++i) {
      if (chart.map->z[j][i] < 5) continue;
      ++large;
      EXPECT_NEAR(chart.map->x[i], 1e-3 * request.x.values[423], 0.1);
      EXPECT_NEAR(chart.map->y[j], request.y.values[311], 0.01);
    }
  }
  EXPECT_EQ(large, 1u);
  EXPECT_EQ(items_of<Chart>(report).size(), measures().size());
}

TEST(StudyReport, ManyPortraitsStaySmall) {
  const Machine machine = tribofit::studies::published_machine();
  const std::vector<double> velocities = evenly_spaced(1e-3, 8e-3, 30);
  const Report report = report_of(studied(machine), study_phase(machine, velocities));
  std::size_t points = 0;
  for (const Chart* chart : items_of<Chart>(report)) {
    for (const ChartLine& line : chart->lines) points += line.x.size();
  }
  EXPECT_LT(points, 120000u);
  bool all = false;
  for (const ReportTable* table : items_of<ReportTable>(report)) all |= table->rows.size() == velocities.size();
  EXPECT_TRUE(all);
}

}  // namespace
