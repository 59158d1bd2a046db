#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "rigs.hpp"

namespace tribofit {
namespace {

constexpr double kDiscVelocity = 0.015 * 4 * 2 * std::numbers::pi / 60;

double exponential_law(const Case& c, double speed) {
  return c.p[1] + (c.p[0] - c.p[1]) * std::exp(-c.p[2] * speed);
}

Case with_effect(const char* key, std::vector<double> values) {
  Case c = published_case(0.015, ExponentialLaw{});
  c.model = FrictionModel(ExponentialLaw{}, {make_effect(key)});
  c.p.insert(c.p.end(), values.begin(), values.end());
  return c;
}

/// Velocity of the block [m/s] and mu after whole milliseconds.
struct BristleValue {
  std::size_t milliseconds;
  double velocity, mu;
};

void expect_bristle(double sigma0, const std::vector<BristleValue>& values) {
  const SimulatedMotion motion = simulate(with_effect("bristle", {sigma0, 10}), {.duration = 0.6, .rate = 1000});
  for (const BristleValue& value : values) {
    SCOPED_TRACE(value.milliseconds);
    EXPECT_NEAR(motion.velocity.at(value.milliseconds), value.velocity, 1e-7);
    EXPECT_NEAR(motion.friction.at(value.milliseconds), value.mu, 2e-6);
  }
}

// The LuGre equations x'' = (N mu - c x' - k x)/m, z' = v_r - sigma_0 |v_r| z/f(|v_r|), mu = sigma_0 z + sigma_1 z'
// from x = z = 0, x' = v_disc, through two slips and the sticks around them. The values were computed by SUNDIALS 6.4
// (CVODE, BDF, relative tolerance 1e-13; those of 1e-12 differ by 3e-10 m/s and 2e-8).
TEST(Presliding, SoftBristleAgreesWithCvode) {
  expect_bristle(1e5, {{100, 0.006249478, 0.20331814},
                       {200, 0.006184557, 0.40507683},
                       {252, 0.003495307, 0.49036077},
                       {256, -0.005132003, 0.43050707},
                       {260, -0.031847958, 0.34404463},
                       {268, -0.071828850, 0.32124878},
                       {276, -0.032983389, 0.34280096},
                       {280, 0.008278401, 0.03431694},
                       {284, 0.005230844, 0.19449544},
                       {400, 0.006179861, 0.40981199},
                       {447, 0.004842303, 0.49558686},
                       {451, 0.001980470, 0.48043116},
                       {455, -0.012385236, 0.39305232},
                       {463, -0.066268223, 0.32229745},
                       {471, -0.054445320, 0.32617634},
                       {475, -0.018349019, 0.36947820},
                       {480, 0.007581719, 0.17164334},
                       {590, 0.006193625, 0.39451840}});
}

TEST(Presliding, StiffBristleAgreesWithCvode) {
  expect_bristle(2e6, {{100, 0.006281486, 0.20412243},
                       {200, 0.006278078, 0.40760498},
                       {250, 0.005999124, 0.50627640},
                       {255, -0.000509997, 0.45276560},
                       {259, -0.026609814, 0.35237713},
                       {267, -0.075849858, 0.32063692},
                       {275, -0.043457617, 0.33229025},
                       {279, 0.007402481, 0.30032622},
                       {284, 0.006292774, 0.14952421},
                       {400, 0.006278427, 0.40016934},
                       {450, 0.006213865, 0.50143376},
                       {459, -0.001863619, 0.44351145},
                       {463, -0.029563059, 0.34746435},
                       {471, -0.076297078, 0.32057634},
                       {479, -0.040235500, 0.33490289},
                       {484, 0.006476969, 0.08998847},
                       {590, 0.006279395, 0.37238947}});
}

// While mu << mu_s the contact is a spring of sigma0 behind that of the rig: v_r = (d mu/dt)/sigma0.
TEST(Presliding, BristleCreepsInStick) {
  const double sigma0 = 1e5;
  const Case c = with_effect("bristle", {sigma0, 0});
  const double rate = 20000;
  const SimulatedMotion motion = simulate(c, {.duration = 0.06, .rate = rate});
  const auto k = static_cast<std::size_t>(0.05 * rate);
  ASSERT_GT(motion.size(), k);
  const double slid = motion.distance[k], mu = motion.friction[k];
  // dz = v_r (1 - sigma0 z/f) dt integrates to -ln(1 - mu/f)/sigma0 f at constant f = mu_s.
  EXPECT_NEAR(slid / (-c.p[0] * std::log1p(-mu / c.p[0]) / sigma0), 1, 0.05);
  for (std::size_t i = 0; i < motion.size(); ++i) EXPECT_TRUE(motion.sticks[i]);
}

TEST(Presliding, BristleSlipsAreFoundAndScatter) {
  const Case c = with_effect("bristle", {1e5, 10});
  const SimulatedMotion motion =
      simulate(c, {.duration = 6, .rate = 20000, .settle = 3, .scatter = {0.01, 0}, .seed = 3});
  // About the rhythm of the rigid contact (4.88 Hz), with every slip seen once.
  EXPECT_NEAR(static_cast<double>(motion.break_away_count()), 6 * 4.88, 3);
  const double n = static_cast<double>(motion.slips.size());
  double mean_friction = 0, mean_offset = 0, product = 0, offsets = 0, levels = 0;
  for (const SimulatedSlip& slip : motion.slips) {
    mean_friction += slip.break_away_friction / n;
    mean_offset += slip.mu_s_offset / n;
  }
  for (std::size_t i = 0; i < motion.slips.size(); ++i) {
    const SimulatedSlip& slip = motion.slips[i];
    const double level = slip.break_away_friction - mean_friction, offset = slip.mu_s_offset - mean_offset;
    product += level * offset;
    offsets += offset * offset;
    levels += level * level;
    if (i + 1 == motion.slips.size()) break;
    EXPECT_LT(slip.break_away_time, slip.restick_time);
    EXPECT_LT(slip.restick_time, motion.slips[i + 1].break_away_time);
  }
  // A contact with more static friction breaks away at more friction: by its offset, less what the law loses up to half
  // the disc's speed.
  EXPECT_GT(product / std::sqrt(offsets * levels), 0.999);
  EXPECT_GT(product / offsets, std::exp(-c.p[2] * 0.5 * kDiscVelocity));
  EXPECT_LT(product / offsets, 1);
}

// Where the disc stands still the bristles hold the block, and friction the spring: what is left of the motion dies out
// to rounding, in which the block moves against either direction.
TEST(Presliding, BristleRestsWithADiscThatStandsStill) {
  Case c = with_effect("bristle", {7e4, 10});
  c.drive.speed = stepped_speed({0}, {4 * 2 * std::numbers::pi / 60}, {{1, 60}});
  const SimulatedMotion motion = simulate(c, {.duration = 60, .rate = 100});
  ASSERT_EQ(motion.size(), 6000U);
  const std::size_t end = motion.size() - 1;
  EXPECT_LT(std::abs(motion.relative_velocity[end]), 1e-9);
  EXPECT_NEAR(motion.friction[end], c.rig.stiffness * motion.displacement[end] / c.drive.mean_load, 1e-6);
}

// A stiff contact is a rigid one.
TEST(Presliding, StiffBristleApproachesRigidStick) {
  const SimulationOptions options{.duration = 4, .rate = 0, .settle = 3, .tolerance = 1e-8};
  const double rigid = mean_period(simulate(published_case(0.015, ExponentialLaw{}), options));
  const auto difference = [&](double sigma0) {
    return std::abs(mean_period(simulate(with_effect("bristle", {sigma0, 1e-4 * sigma0}), options)) / rigid - 1);
  };
  EXPECT_LT(difference(2e6), 0.012);
  EXPECT_LT(difference(2e7), 0.006);
}

// d phi/ds = (f - phi)/D_c along the slip, from the samples.
TEST(Memory, RateStateFollowsItsDistance) {
  const double critical_distance = 200e-6, direct = 0.01;
  const Case c = with_effect("rate-state", {critical_distance, direct});
  const SimulatedMotion motion = simulate(c, {.duration = 2, .rate = 200000});
  const auto phi = [&](std::size_t i) {
    return motion.friction[i] - direct * std::asinh(motion.relative_velocity[i] / 2e-3);
  };
  int checked = 0;
  for (std::size_t i = 1; i + 1 < motion.size(); ++i) {
    if (motion.sticks[i - 1] || motion.sticks[i + 1] || motion.relative_velocity[i] < 0.01) continue;
    const double slope = (phi(i + 1) - phi(i - 1)) / (motion.distance[i + 1] - motion.distance[i - 1]);
    const double expected = (exponential_law(c, motion.relative_velocity[i]) - phi(i)) / critical_distance;
    EXPECT_NEAR(slope, expected, 0.02 + 2e-4 * std::abs(expected));
    ++checked;
  }
  EXPECT_GT(checked, 10000);
}

// d theta/dt = 1 - v theta/D_c through slips and the sticks between them, from the samples, by the mean of v over each.
TEST(Memory, HealingContactsAgeThroughStickAndSlip) {
  const double critical_distance = 100e-6, direct = 0.005;
  const Case c = with_effect("rate-state:healing", {critical_distance, direct});
  const double rate = 1e6;
  const SimulatedMotion motion = simulate(c, {.duration = 0.7, .rate = rate});
  ASSERT_GE(motion.slips.size(), 2u);
  double theta = 0, worst = 0;
  std::size_t slipping = 0, next = 0;
  for (std::size_t i = 1; i < motion.size(); ++i) {
    const double v = 0.5 * (motion.relative_velocity[i - 1] + motion.relative_velocity[i]) / critical_distance,
                 h = 1 / rate;
    const double before = theta;
    theta = v > 0 ? theta * std::exp(-v * h) - std::expm1(-v * h) / v : theta + h;
    if (next < motion.slips.size() && motion.time[i] >= motion.slips[next].break_away_time) {
      const double waited = motion.slips[next].break_away_time - motion.time[i - 1];
      const double level = exponential_law(c, critical_distance / (before + waited));
      EXPECT_NEAR(motion.slips[next].break_away_friction, level, 1e-6) << next;
      ++next;
    }
    if (motion.sticks[i - 1] || motion.sticks[i]) continue;
    ++slipping;
    const double expected =
        exponential_law(c, critical_distance / theta) + direct * std::asinh(motion.relative_velocity[i] / 2e-3);
    worst = std::max(worst, std::abs(motion.friction[i] - expected));
  }
  EXPECT_GT(slipping, 40000u);
  EXPECT_LT(worst, 1e-6);
  ASSERT_GE(next, 2u);
}

// Slip begins from v_r = 0, where even a short distance takes time: the limit is reached slowly, but reached.
TEST(Memory, ShortMemoryIsNone) {
  const SimulationOptions options{.duration = 4, .rate = 0, .settle = 3, .tolerance = 1e-8};
  const double without = mean_period(simulate(published_case(0.015, ExponentialLaw{}), options));
  const auto difference = [&](double critical_distance) {
    return mean_period(simulate(with_effect("rate-state", {critical_distance, 0}), options)) / without - 1;
  };
  EXPECT_LT(std::abs(difference(5e-7)), 1e-2);
  EXPECT_LT(std::abs(difference(5e-8)), 2.5e-3);
}

}  // namespace
}  // namespace tribofit
