#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "machines.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/report/study.hpp"
#include "tribofit/study/map.hpp"
#include "tribofit/study/response.hpp"
#include "tribofit/study/sweep.hpp"

namespace tribofit {
namespace {

using studies::published_machine;
using studies::uradnicek_machine;
using ::testing::HasSubstr;

TEST(Response, EveryHarmonicObeysTheForceBalanceOfTheRig) {
  // Of the settled motion, m x'' + c x' + k x = F(t) holds line by line: X = F/|k - m w^2 + i c w|.
  const Machine machine = published_machine();
  const Response response = study_response(machine);
  ASSERT_EQ(response.harmonics.size(), 20U);
  // A jump of friction (at re-stick, at most N mu_s) lies up to a sample off, which is an error of as much on every
  // line.
  const double jump = 2 * machine.load * machine.parameters[0] / 16384;
  for (const ResponseLine& h : response.harmonics) {
    const double w = 2 * std::numbers::pi * h.frequency;
    const double impedance = std::hypot(machine.rig.stiffness - machine.rig.mass * w * w, machine.rig.damping * w);
    EXPECT_NEAR(h.displacement, h.force / impedance, 1e-4 * h.displacement + jump / impedance) << h.frequency;
    EXPECT_NEAR(h.velocity, w * h.displacement, 1e-3 * h.velocity) << h.frequency;
  }
}

TEST(Response, CurveIsThatOfCreakWithItsPeakAtTheResonance) {
  const Response response = study_response(published_machine());
  const auto peak = std::max_element(response.amplitude.begin(), response.amplitude.end());
  const double at = response.frequency[static_cast<std::size_t>(peak - response.amplitude.begin())];
  EXPECT_NEAR(at, response.natural_frequency, 0.02 * response.natural_frequency);
  EXPECT_NEAR(response.damped_natural_frequency, response.natural_frequency * std::sqrt(1 - 0.02 * 0.02), 1e-9);
}

SensitivityOptions sensitivity_of(std::vector<std::string> variables, std::size_t count) {
  SensitivityOptions options;
  options.variables = std::move(variables);
  options.count = count;
  return options;
}

TEST(Sensitivity, MeasuresDoNotChangeWhenAllForcesScaleTogether) {
  // Load, stiffness, mass and damping times one factor leave the motion as it is and scale the energy: their
  // elasticities add up to 0, those of the energy to 1.
  const std::vector<Sensitivity> all =
      study_sensitivity(published_machine(), sensitivity_of({"load", "stiffness", "mass", "damping"}, 3));
  ASSERT_EQ(all.size(), 4U);
  for (std::size_t k = 0; k < measures().size(); ++k) {
    double sum = 0;
    for (const Sensitivity& one : all) sum += one.elasticities[k];
    EXPECT_NEAR(sum, measures()[k].name == "energy" ? 1 : 0, 5e-3) << measures()[k].name;
  }
}

TEST(Sensitivity, RanksBySizeAndPutsTheUnknownLast) {
  const std::vector<Sensitivity> all = study_sensitivity(published_machine(), sensitivity_of({}, 2));
  const std::vector<std::size_t> order = ranked(all, 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    EXPECT_GE(std::abs(all[order[i - 1]].elasticities[0]), std::abs(all[order[i]].elasticities[0]));
  }
  EXPECT_THROW(study_sensitivity(published_machine(), sensitivity_of({"colour"}, 3)), InputError);
  EXPECT_THROW(study_sensitivity(published_machine(), sensitivity_of({"load"}, 1)), InputError);
}

TEST(SpeedStudy, CarriesTheUncertaintyOfTheMachine) {
  // With the decay factor and c exact, the critical speed ln(N (mu_s - mu_k) alpha/c)/alpha moves with mu_s by
  // 1/(alpha (mu_s - mu_k)).
  Machine machine = published_machine();
  const double sigma = 0.002, drop = machine.parameters[0] - machine.parameters[1];
  SpeedStudyOptions options;
  options.velocity = {machine.disc_velocity()};
  options.covariance.friction = {sigma * sigma, 0, 0, 0, 0, 0, 0, 0, 0};
  const SpeedStudy study = study_speed(machine, options);
  const double expected = 2 * 1.96 * sigma / drop / machine.parameters[2];
  EXPECT_NEAR(study.linear_interval.upper - study.linear_interval.lower, expected, 0.2 * expected);
  EXPECT_LT(study.linear_interval.lower, study.critical.linear.back());
  EXPECT_GT(study.linear_interval.upper, study.critical.linear.back());
  EXPECT_LT(study.own_intervals[0].lower, study.own.frequency);
  EXPECT_GT(study.own_intervals[0].upper, study.own.frequency);
}

TEST(SpeedStudy, DoesNotDependOnThreads) {
  SpeedStudyOptions options;
  options.covariance.rig = {1e-4, 0, 0, 0, 1e-2, 0, 0, 0, 1e4};
  options.draws = 20;
  options.threads = 1;
  const Machine machine = published_machine();
  const StudiedMachine studied{machine, options.covariance, "test", {}, 0};
  const std::string one = study_json(studied, study_speed(machine, options));
  options.threads = 4;
  EXPECT_EQ(study_json(studied, study_speed(machine, options)), one);
}

TEST(Portraits, HoldTheStartAndASettledCycle) {
  const std::vector<Portrait> portraits = study_phase(uradnicek_machine(250, 5e-3), {5e-3, 12e-3});
  ASSERT_EQ(portraits.size(), 2U);
  EXPECT_EQ(portraits[0].settled.regime, Regime::stick_slip);
  EXPECT_EQ(portraits[0].cycle.size(), 1000U);
  EXPECT_NEAR(portraits[0].cycle.velocity.front(), 5e-3, 1e-9);  // at break-away the block goes with the disc
  EXPECT_EQ(portraits[1].settled.regime, Regime::sliding);
  EXPECT_EQ(portraits[1].cycle.size(), 0U);
  EXPECT_GT(portraits[1].start.size(), 1000U);
}

MapRequest small_map() {
  const Machine machine = uradnicek_machine(250, 0.5e-3);
  return {machine,
          {variable_named(machine, "velocity"), evenly_spaced(1e-3, 15e-3, 6)},
          {variable_named(machine, "ratio"), evenly_spaced(0.1, 0.9, 4)},
          {}};
}

TEST(Map, CellsAreTheSettledMotionsOfTheirMachines) {
  const MapRequest request = small_map();
  std::vector<std::vector<MapCell>> rows(4);
  compute_map(request, {}, 2, [&](std::size_t row, const std::vector<MapCell>& cells) {
    rows[row] = cells;
    return true;
  });
  for (const std::size_t j : {0U, 3U}) {
    for (std::size_t i = 0; i < 6; ++i) {
      const Settled settled = settle(
          with_value(with_value(request.machine, "velocity", request.x.values[i]), "ratio", request.y.values[j]));
      EXPECT_EQ(rows[j][i].regime, settled.regime);
      if (settled.regime == Regime::stick_slip) {
        EXPECT_EQ(rows[j][i].values[0], settled.frequency);
      }
    }
  }
  // As text and back, to the last bit.
  for (std::size_t j = 0; j < 4; ++j) {
    const std::string text = map_csv_row(request, j, rows[j]);
    EXPECT_EQ(map_csv_row(request, j, map_row_from_csv(request, j, text)), text);
    EXPECT_TRUE(map_row_from_csv(request, j, text.substr(0, text.size() - 5)).empty());
    EXPECT_TRUE(map_row_from_csv(request, (j + 1) % 4, text).empty());
  }
}

TEST(Map, LeavesOutWhatIsKnownAndEndsWhenTold) {
  std::vector<std::size_t> seen;
  compute_map(small_map(), {true, false, true, false}, 1, [&](std::size_t row, const auto&) {
    seen.push_back(row);
    return true;
  });
  EXPECT_THAT(seen, ::testing::ElementsAre(1, 3));
  seen.clear();
  compute_map(small_map(), {}, 1, [&](std::size_t row, const auto&) {
    seen.push_back(row);
    return false;
  });
  EXPECT_THAT(seen, ::testing::ElementsAre(0));
}

TEST(Map, RefusesAxesThatCannotBe) {
  MapRequest request = small_map();
  request.y = request.x;
  EXPECT_THROW(check_map(request), InputError);
  request = small_map();
  request.x = {variable_named(request.machine, "mass"), {-1, 1}};
  try {
    check_map(request);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("mass = -1 kg"));
  }
}

TEST(Smoothed, ComesToTheEventLocatedMotionAsItSharpens) {
  const Machine machine = published_machine();
  const Settled events = settle(machine);
  double before = 1;
  for (const double sharpness : {1e6, 1e7, 1e8}) {  // 1e3 to 1e5 s/mm
    const Settled smooth = settle(machine, {.sharpness = sharpness});
    ASSERT_EQ(smooth.regime, Regime::stick_slip);
    const double off = std::abs(smooth.frequency / events.frequency - 1);
    EXPECT_LT(off, 0.5 * before);
    before = off;
  }
  EXPECT_LT(before, 1e-2);
}

}  // namespace
}  // namespace tribofit
