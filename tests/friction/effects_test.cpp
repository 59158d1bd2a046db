/// Each law and effect against what its equation says in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "samples.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace {

using namespace tribofit;

using samples::run;
using samples::Steady;

TEST(Laws, FollowTheirEquations) {
  // [D] Eq 2 and 3 at 20 mm/s with the 15 mm row of Table 4.
  const Steady at(0.020, 1e-3, 1);
  EXPECT_NEAR(run(FrictionModel(ExponentialLaw{}), {0.509, 0.318, 52.14}, at.slip)[0],
              0.318 + 0.191 * std::exp(-0.05214 * 20), 1e-12);
  EXPECT_NEAR(run(FrictionModel(FractionalLaw{}), {0.509, 0.318, 95.33}, at.slip)[0],
              0.318 + 0.191 / (1 + 0.09533 * 20), 1e-12);
  EXPECT_NEAR(run(FrictionModel(CoulombLaw{}), {0.509, 0.318}, at.slip)[0], 0.318, 1e-12);
  const Steady back(-0.020, 1e-3, 1);
  EXPECT_NEAR(run(FrictionModel(ExponentialLaw{}), {0.509, 0.318, 52.14}, back.slip)[0],
              -(0.318 + 0.191 * std::exp(-0.05214 * 20)), 1e-12);
}

TEST(Laws, ReadmeNumberOfThePublishedMinimum) {
  // At 9 mm the fastest slip (56.5 mm/s) reaches 0.409, not mu_k = 0.388.
  const Steady at(0.0565, 1e-3, 1);
  EXPECT_NEAR(run(FrictionModel(ExponentialLaw{}), {0.521, 0.388, 32.37}, at.slip)[0], 0.409, 5e-4);
}

TEST(RateState, RelaxesOverItsLength) {
  // From break-away at mu_s to the steady value at constant speed: exp(-distance/D_c).
  const double speed = 0.01, length = 50e-6, step = 1e-4;
  Steady at(speed, step, 200);
  const FrictionModel model(CoulombLaw{}, {make_effect("rate-state")});
  const std::vector<double> mu = run(model, {0.5, 0.3, length, 0.0}, at.slip);
  EXPECT_NEAR(mu[0], 0.3, 1e-12);  // not from stick: starts in steady state
  at.slip.from_stick = true;
  at.slip.break_away_time = 0;
  const std::vector<double> after = run(model, {0.5, 0.3, length, 0.0}, at.slip);
  for (std::size_t i = 20; i + 1 < after.size(); i += 10) {
    EXPECT_NEAR((after[i + 1] - 0.3) / (after[i] - 0.3), std::exp(-speed * step / length), 1e-6);
  }
}

TEST(RateState, DirectTermFollowsTheLogarithmOfSpeed) {
  const FrictionModel model(CoulombLaw{}, {make_effect("rate-state")});
  const double a = 0.01;
  const Steady slow(0.01, 1e-3, 50), fast(0.1, 1e-3, 50);
  const double difference =
      run(model, {0.5, 0.3, 1e-6, a}, fast.slip)[49] - run(model, {0.5, 0.3, 1e-6, a}, slow.slip)[49];
  EXPECT_NEAR(difference, a * (std::asinh(50.0) - std::asinh(5.0)), 1e-9);
}

TEST(Bristle, IsElasticBelowBreakAwayAndSteadyFarFromIt) {
  // dF/dx = sigma0 (1 - F/f) at constant f: F = f (1 - exp(-sigma0 x/f)) from F = 0.
  const double stiffness = 60e3, level = 0.3, speed = 1e-3, step = 1e-4;
  Steady at(speed, step, 100);
  const double lead_time[] = {0}, lead_velocity[] = {speed};  // F = 0 one step before the first sample
  at.slip.from_stick = true;
  at.slip.lead_time = lead_time;
  at.slip.lead_velocity = lead_velocity;
  const FrictionModel model(CoulombLaw{}, {make_effect("bristle")});
  const std::vector<double> mu = run(model, {level, level, stiffness, 0.0}, at.slip);
  for (std::size_t i = 0; i < mu.size(); i += 10) {
    EXPECT_NEAR(mu[i], level * (1 - std::exp(-stiffness * speed * at.time[i] / level)), 1e-9);
  }
  const Steady far(0.05, 1e-3, 100);
  EXPECT_NEAR(run(model, {0.5, level, stiffness, 0.0}, far.slip)[99], level, 1e-9);
}

/// One instant of sliding, with every channel.
struct OneInstant {
  double time = 2, velocity = 0.05, acceleration = 0, angle = 0, distance = 0, load = 50, temperature = 20;
  double stick_time = 0, since_break_away = -1, disc_speed = 0.4;
  double reversal_distance = std::numeric_limits<double>::infinity();
  std::vector<double> earlier_strokes = {};
};

double read_at(const FrictionModel& model, const std::vector<double>& p, const OneInstant& x) {
  const auto one = [](const double& value) { return std::span<const double>(&value, 1); };
  Slip slip;
  slip.time = one(x.time);
  slip.velocity = one(x.velocity);
  slip.acceleration = one(x.acceleration);
  slip.angle = one(x.angle);
  slip.distance = one(x.distance);
  slip.reversal_distance = one(x.reversal_distance);
  slip.earlier_strokes = x.earlier_strokes;
  slip.load = one(x.load);
  slip.temperature = one(x.temperature);
  slip.stick_time = x.stick_time;
  slip.from_stick = x.since_break_away >= 0;
  slip.break_away_time = x.time - x.since_break_away;
  slip.direction = x.velocity < 0 ? -1 : 1;
  slip.mean_load = 50;
  slip.mean_temperature = 20;
  slip.disc_speed = x.disc_speed;
  return run(model, p, slip)[0];
}

/// What an effect makes of friction 0.3 (coulomb) at one instant, parameters in SI.
struct Point {
  const char* key;
  std::vector<double> p;
  OneInstant at;
  double expected;
};

void expect_points(const std::vector<Point>& points, double mu) {
  for (const Point& point : points) {
    const FrictionModel model(CoulombLaw{}, {make_effect(point.key)});
    std::vector<double> p = {0.5, mu};
    p.insert(p.end(), point.p.begin(), point.p.end());
    EXPECT_NEAR(read_at(model, p, point.at), point.expected, 1e-8) << point.key << " " << &point - points.data();
  }
}

TEST(Effects, SayWhatTheirEquationSaysAtAPoint) {
  const double mu = 0.3, turn = 2 * std::numbers::pi;
  const std::vector<Point> points = {
      {"viscous", {1.0}, {.velocity = 0.05}, mu + 0.05},
      {"viscous", {1.0}, {.velocity = 1e-12}, mu},
      {"asymmetry", {0.8}, {.velocity = -0.05}, -0.8 * mu},
      {"asymmetry", {0.8}, {.velocity = 0.05}, mu},
      {"heating", {0.1, 20}, {.time = 0}, mu},
      {"heating", {0.1, 20}, {.time = 20}, mu * (1 - 0.1 * (1 - std::exp(-1)))},
      {"heating", {0.1, 20}, {.time = 1e6}, mu * 0.9},
      {"run-in", {0.2, 0.3}, {.distance = 0}, mu * 1.2},
      {"run-in", {0.2, 0.3}, {.distance = 0.3}, mu * (1 + 0.2 * std::exp(-1))},
      {"run-in", {0.2, 0.3}, {.distance = 1e3}, mu},
      {"drift", {0.002}, {.time = 10}, mu * 1.02},
      {"drift", {0.002}, {.time = 10, .velocity = -0.05}, -mu * 1.02},
      {"step", {0.04, 10}, {.time = 9.9}, mu},
      {"step", {0.04, 10}, {.time = 10.1}, mu + 0.04},
      {"step", {0.04, 10}, {.time = 10.1, .velocity = -0.05}, -mu - 0.04},
      {"load-dependence", {0.2}, {.load = 100}, mu * std::pow(2, -0.2)},
      {"load-dependence", {0.2}, {.load = 50}, mu},
      {"temperature-dependence", {0.005}, {.temperature = 40}, mu * 1.1},
      {"runout", {0.05, 1}, {.angle = -1}, mu * 1.05},
      {"runout", {0.05, 1}, {.angle = turn / 2 - 1}, mu * 0.95},
      {"disc-pattern", {0.05, 0, 0, 0}, {.angle = turn / 4}, mu * 0.95},
      {"disc-pattern", {0, 0, 0.05, 0}, {.angle = turn / 3}, mu * 1.05},
      {"load-coupling", {0.1}, {}, mu / (1 - 0.1 * mu)},
      {"load-coupling", {0.1}, {.velocity = -0.05}, -mu / (1 + 0.1 * mu)},
      {"ringing", {0.01, 200, 0.02, 0}, {.since_break_away = 0.005}, mu + 0.01 * std::exp(-turn * 0.02)},
      {"ringing", {0.01, 200, 0.02, 0}, {.since_break_away = 0.0075}, mu - 0.01 * std::exp(-1.5 * turn * 0.02)},
      {"ringing", {0.01, 200, 0.02, 0}, {}, mu},  // no break-away was recorded
      {"sensor-inertia", {0.5}, {.acceleration = 2}, mu - 0.02},
      {"sensor-offset", {0.01}, {.velocity = -0.05}, -mu + 0.01},
      {"zero-drift", {0.001}, {.time = 20, .velocity = -0.05}, -mu + 0.02},
      {"crosstalk", {0.02}, {.velocity = -0.05, .load = 75}, -mu + 0.03},
      {"interference", {0.01, 50, 1}, {.time = 0.02}, mu + 0.01 * std::cos(1)},
      {"interference", {0.01, 50, 0}, {.time = 0.03, .velocity = -0.05}, -mu - 0.01},
      {"speed-ripple", {0.1, 2, 0}, {}, mu},  // of the motion: no term in mu
      {"radius-offset", {1.05}, {}, mu},
      {"velocity-gain", {0.95}, {}, mu},
      {"velocity-highpass", {0.1}, {}, mu},
      {"velocity-offset", {1e-3}, {}, mu},
      {"velocity-bandwidth", {500}, {}, mu},
      {"velocity-compression", {0.1}, {}, mu},
      {"friction-compression", {0.1}, {}, mu},
      {"clock-drift", {1e-4}, {}, mu},
  };
  expect_points(points, mu);
}

TEST(Effects, SayWhatTheirEquationSaysAfterAReversal) {
  const double mu = 0.3;
  const std::vector<Point> points = {
      {"hysteresis", {0.1, 0.01}, {}, mu},  // no reversal is known
      {"hysteresis", {0.1, 0.01}, {.reversal_distance = 0, .earlier_strokes = {10}}, mu - 0.2},
      {"hysteresis", {0.1, 0.01}, {.reversal_distance = 0.01}, mu - 0.2 * std::exp(-1)},
      {"hysteresis",
       {0.1, 0.01},
       {.velocity = -0.05, .reversal_distance = 0.01, .earlier_strokes = {10}},
       -mu + 0.2 * std::exp(-1)},
      // Strokes of 10 mm about one middle, from where friction ended to where it will.
      {"hysteresis", {0.1, 0.01}, {.reversal_distance = 0, .earlier_strokes = {0.01}}, mu - 0.1 * (2 - std::exp(-1))},
      {"hysteresis", {0.1, 0.01}, {.reversal_distance = 0.01, .earlier_strokes = {0.01}}, mu - 0.1 * std::exp(-1)},
      // A stroke that outgrows them, and one of 4 mm beside one of 10: closed after 4 mm, which is 11 mm of the latter.
      {"hysteresis", {0.1, 0.01}, {.reversal_distance = 0.02, .earlier_strokes = {0.01}}, mu - 0.1 * std::exp(-3)},
      {"hysteresis",
       {0.1, 0.01},
       {.reversal_distance = 0.005, .earlier_strokes = {0.03, 0.01, 0.004}},
       mu - 0.1 * (2 * std::exp(-1.1) - std::exp(-3))},
      {"backlash", {0.2, 0.01}, {}, mu},
      {"backlash", {0.2, 0.01}, {.reversal_distance = 0.008}, 0.8 * mu},
      {"backlash", {0.2, 0.01}, {.velocity = -0.05, .reversal_distance = 0.008}, -0.8 * mu},
      {"backlash", {0.2, 0.01}, {.reversal_distance = 0.013}, mu},
      // Turned within the play, and back: the other side is as far as it was.
      {"backlash", {0.2, 0.01}, {.reversal_distance = 0.005, .earlier_strokes = {0.05, 0.004}}, mu},
  };
  expect_points(points, mu);
}

TEST(StribeckExponent, BendsTheFallAndKeepsItsEnds) {
  const double drop = 0.191, level = 0.318;
  const FrictionModel exponential(ExponentialLaw{}, {make_effect("stribeck-exponent")});
  const FrictionModel fractional(FractionalLaw{}, {make_effect("stribeck-exponent")});
  const std::vector<double> p = {level + drop, level, 50, 2};  // decay in s/m
  EXPECT_NEAR(read_at(exponential, p, {.velocity = 0.01}), level + drop * std::exp(-0.25), 1e-12);
  EXPECT_NEAR(read_at(fractional, p, {.velocity = 0.01}), level + drop / 1.25, 1e-12);
  EXPECT_NEAR(read_at(exponential, p, {.velocity = 1e-9}), level + drop, 1e-9);
  EXPECT_NEAR(read_at(exponential, p, {.velocity = 10}), level, 1e-9);
}

TEST(Ageing, RaisesBreakAwayWithTheLogarithmOfStick) {
  const FrictionModel model(CoulombLaw{}, {make_effect("ageing")});
  const std::vector<double> p = {0.5, 0.3, 0.01, 0.1};
  Steady at(0.05, 1e-3, 3);
  at.slip.from_stick = true;
  for (const double stick : {0.0, 0.1, 10.0}) {
    at.slip.stick_time = stick;
    EXPECT_NEAR(break_away_level(model, p.data(), at.slip), 0.5 + 0.01 * std::log(1 + stick / 0.1), 1e-12);
  }
  at.slip.stick_time = std::nan("");  // not recorded
  EXPECT_NEAR(break_away_level(model, p.data(), at.slip), 0.5, 1e-12);
}

TEST(FrictionalLag, ForgetsBreakAwayInItsTime) {
  const double tau = 2e-3, step = 1e-4;
  const FrictionModel model(CoulombLaw{}, {make_effect("frictional-lag")});
  Steady at(0.05, step, 200);
  at.slip.from_stick = true;
  // The steady value falls from mu_s at rest to mu_k at the first sample; after that phi decays exactly.
  const std::vector<double> mu = run(model, {0.5, 0.3, tau}, at.slip);
  EXPECT_GT(mu[0], 0.48);
  for (std::size_t i = 0; i + 1 < 100; i += 9) {
    EXPECT_NEAR((mu[i + 1] - 0.3) / (mu[i] - 0.3), std::exp(-step / tau), 1e-9);
  }
  EXPECT_NEAR(mu[199], 0.3, 0.2 * std::exp(-9.5));
}

TEST(ChannelDelay, ShiftsTheChannel) {
  // mu falls along 0.5 - 2 t from break-away at t = 0, after a rise along 0.5 + 3 t.
  std::vector<double> time, velocity, late, early;
  for (int i = 1; i <= 100; ++i) time.push_back(1e-3 * i);
  velocity.assign(time.size(), 0.05);
  for (const double t : time) late.push_back(0.5 - 2 * t);
  early = late;
  Slip slip;
  slip.time = time;
  slip.velocity = velocity;
  slip.from_stick = true;
  slip.stick_slope = 3;
  const double delay = 10.3e-3, back = -2.2e-3;
  ChannelDelay{}.filter_reading(&delay, slip, 0.5, std::span<double>(late));
  ChannelDelay{}.filter_reading(&back, slip, 0.5, std::span<double>(early));
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double then = time[i] - delay;
    EXPECT_NEAR(late[i], then < 0 ? 0.5 + 3 * then : 0.5 - 2 * then, 1e-12);
    EXPECT_NEAR(early[i], 0.5 - 2 * (time[i] - back), 1e-12);
  }
  EXPECT_NEAR(ChannelDelay{}.filter_break_away_reading(&delay, slip, 0.5), 0.5 - 3 * delay, 1e-12);
}

TEST(ChannelDelay, ShowsTheJumpOfReStickAsOneRampAboutItsTime) {
  std::vector<double> time, velocity(50, 0.05), early(50, 0.4);
  for (int i = 0; i < 50; ++i) time.push_back(1e-3 * i);
  Slip slip;
  slip.time = time;
  slip.velocity = velocity;
  slip.tail_friction = -0.2;
  slip.restick_time = 49.9e-3;  // nine tenths of an interval after the last sample
  const double back = -9.5e-3;  // the samples lie half an interval off the grid
  ChannelDelay{}.filter_reading(&back, slip, 0.5, std::span<double>(early));
  EXPECT_NEAR(early[39], 0.4, 1e-12);              // of 48.5 ms
  EXPECT_NEAR(early[40], 0.4 - 0.6 * 0.1, 1e-12);  // of 49.5 ms, the ramp is from 49.4 to 50.4 ms
  EXPECT_NEAR(early[41], -0.2, 1e-12);             // of 50.5 ms
}

/// The level that stands for break-away is read off a straight line through the second half of the stick.
TEST(Interference, ReachesTheLevelOfBreakAwayAsThroughALineFit) {
  for (const double f : {0.5, 5.0, 13.0, 50.0}) {
    const double p[] = {0.01, f, 0.7};
    Slip slip;
    slip.stick_time = 0.18;
    slip.break_away_time = 1.234;
    const int n = 20000;  // least squares of a line over the half stick, taken at its end
    double y0 = 0, y1 = 0, u2 = 0;
    for (int i = 0; i < n; ++i) {
      const double u = (i + 0.5) / n - 1;  // of the half, from -1 to 0
      const double y = 0.01 * std::cos(2 * std::numbers::pi * f * (1.234 + 0.09 * u) + 0.7);
      y0 += y / n;
      y1 += (u + 0.5) * y / n;
      u2 += (u + 0.5) * (u + 0.5) / n;
    }
    EXPECT_NEAR(Interference{}.filter_break_away_reading(p, slip, 0.5), 0.5 + y0 + 0.5 * y1 / u2, 1e-7) << f;
  }
}

TEST(ForceBandwidth, FollowsARampLateAndAnswersAStepInClosedForm) {
  const double corner = 200, zeta = 0.6, w = 2 * std::numbers::pi * corner, wd = w * std::sqrt(1 - zeta * zeta);
  const double p[] = {corner, zeta};
  const auto answer = [&](double before, double step, double slope) {
    std::vector<double> time, mu;
    for (int i = 0; i < 2000; ++i) time.push_back(1e-5 * i);
    for (const double t : time) mu.push_back(before + (t > 0 ? step : 0) + slope * t);
    Slip slip;
    slip.time = time;
    ForceBandwidth{}.filter_reading(p, slip, 0.0, std::span<double>(mu));
    return mu;
  };
  const std::vector<double> step = answer(0.5, -0.2, 0), ramp = answer(0.5, 0, 2);
  for (std::size_t i = 10; i < 2000; i += 50) {
    const double t = 1e-5 * static_cast<double>(i) - 0.5e-5;  // the step takes one interval
    const double rest = std::exp(-zeta * w * t) * (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t));
    EXPECT_NEAR(step[i], 0.5 - 0.2 * (1 - rest), 2e-5);
  }
  EXPECT_NEAR(ramp[1999], 0.5 + 2 * (1999e-5 - 2 * zeta / w), 1e-6);
}

/// A channel of first order, which kinematics/ has found, reads every law late.
TEST(FrictionLowPass, FollowsARampLateAndAStepWithinItsTime) {
  const double tau = 2e-3, step = 1e-4;
  const FrictionModel model(CoulombLaw{}, {});
  Steady at(0.05, step, 200);
  at.slip.from_stick = true;
  at.slip.stick_slope = 3;
  at.slip.friction_low_pass = tau;
  const double p[] = {0.5, 0.3};
  EXPECT_NEAR(break_away_level(model, p, at.slip), 0.5 - 3 * tau, 1e-12);
  Slip unknown = at.slip;
  unknown.stick_slope = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(break_away_level(model, p, unknown), 0.5);
  unknown.friction_low_pass = 0;
  EXPECT_EQ(break_away_level(model, p, unknown), 0.5);
  // From mu_s at break-away the steady value falls to mu_k at the first sample, on a straight line.
  const std::vector<double> mu = run(model, {0.5, 0.3}, at.slip);
  const double e = std::exp(-(at.time[0] - at.slip.break_away_time) / tau);
  const double lag = 0.2 / (at.time[0] - at.slip.break_away_time) * tau;
  EXPECT_NEAR(mu[0], 0.3 + lag - (3 * tau + lag) * e, 1e-9);
  for (std::size_t i = 0; i + 1 < 100; i += 9)
    EXPECT_NEAR((mu[i + 1] - 0.3) / (mu[i] - 0.3), std::exp(-step / tau), 1e-9);
}

/// Mean of f(|v|) v_t/|v| over a pad of radius R_c by quadrature on rings.
double pad_mean(double v, double rim, double alpha) {
  constexpr int kRings = 400, kAngles = 800;
  double sum = 0, area = 0;
  for (int i = 0; i < kRings; ++i) {
    const double rho = (i + 0.5) / kRings;
    for (int j = 0; j < kAngles; ++j) {
      const double angle = (j + 0.5) * std::numbers::pi / kAngles;
      const double along = v + rim * rho * std::cos(angle), across = rim * rho * std::sin(angle);
      const double speed = std::hypot(along, across);
      sum += rho * (0.318 + 0.191 * std::exp(-alpha * speed)) * along / speed;
      area += rho;
    }
  }
  return sum / area;
}

TEST(ContactSpin, IsTheMeanOverThePad) {
  const double omega = 0.4, pad = 5e-3, rim = omega * pad;
  const FrictionModel model(ExponentialLaw{}, {make_effect("contact-spin")});
  for (const auto& [alpha, tolerance] : {std::pair(0.0, 2e-4), std::pair(50.0, 4e-4), std::pair(125.0, 1.2e-3)}) {
    for (const double u : {0.05, 0.3, 0.7, 0.98, 1.02, 1.5, 3.0, 10.0}) {
      EXPECT_NEAR(read_at(model, {0.509, 0.318, alpha, pad}, {.velocity = u * rim, .disc_speed = omega}),
                  pad_mean(u * rim, rim, alpha), tolerance)
          << "alpha " << alpha << " u " << u;
    }
  }
  const std::vector<double> p = {0.509, 0.318, 50, pad};
  const LawValues<double> law = model.law_values(p.data());
  EXPECT_NEAR(steady_friction(model, p.data(), law, {.velocity = 0, .disc_speed = omega}), 0, 1e-12);
  EXPECT_NEAR(read_at(model, p, {.velocity = 0, .disc_speed = omega}), 0, 1e-5);  // noise about rest
  EXPECT_NEAR(read_at(model, p, {.velocity = 10, .disc_speed = omega}), 0.318, 1e-6);
  EXPECT_NEAR(read_at(model, {0.509, 0.318, 50, 0}, {.velocity = 0.02, .disc_speed = omega}),
              0.318 + 0.191 * std::exp(-1), 1e-6);
  for (const double u : {0.1, 0.5, 0.85}) {  // creep undoes it: mu_s g(u) -> u omega R_c
    const double mu = read_at(model, {0.5, 0.5, 50, pad}, {.velocity = u * rim, .disc_speed = omega});
    EXPECT_NEAR(ContactSpin{}.creep(&pad, 0.5, mu, 1.0, omega), u * rim, 2e-3 * rim);
  }
}

TEST(ContactSpin, WithoutSpinReadingsAtRestHaveTheFrictionOfTheLaw) {
  samples::ExampleSlip made(200);
  for (std::size_t i = 0; i < made.velocity.size(); i += 3) made.velocity[i] = i % 2 == 0 ? -1e-5 : 1e-5;
  const FrictionModel spinning(ExponentialLaw{}, {make_effect("contact-spin")}), rigid(Law(ExponentialLaw{}));
  const std::vector<double> with = run(spinning, {0.509, 0.318, 52.14, 0}, made.slip);
  const std::vector<double> without = run(rigid, {0.509, 0.318, 52.14}, made.slip);
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_NEAR(with[i], without[i], 4e-3) << made.velocity[i];
}

}  // namespace
