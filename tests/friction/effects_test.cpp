/// Each law and effect against what its equation says in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "samples.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace {

using namespace tribofit;

/// A slip at constant speed.
struct Steady {
  std::vector<double> time, velocity;
  Slip slip;
  Steady(double speed, double step, std::size_t n) : velocity(n, speed) {
    for (std::size_t i = 0; i < n; ++i) time.push_back(step * static_cast<double>(i + 1));
    slip.time = time;
    slip.velocity = velocity;
    slip.direction = speed < 0 ? -1 : 1;
  }
  Steady(const Steady&) = delete;
  Steady& operator=(const Steady&) = delete;
};

std::vector<double> run(const FrictionModel& model, const std::vector<double>& p, const Slip& slip) {
  std::vector<double> mu(slip.size());
  evaluate<double>(model, p.data(), slip, slip.velocity, mu);
  return mu;
}

TEST(Laws, FollowTheirEquations) {
  // [D] Eq 2 and 3 at 20 mm/s with the 15 mm row of Table 4.
  const Steady at(0.020, 1e-3, 1);
  EXPECT_NEAR(run(FrictionModel(BaseLaw::exponential), {0.509, 0.318, 52.14}, at.slip)[0],
              0.318 + 0.191 * std::exp(-0.05214 * 20), 1e-12);
  EXPECT_NEAR(run(FrictionModel(BaseLaw::fractional), {0.509, 0.318, 95.33}, at.slip)[0],
              0.318 + 0.191 / (1 + 0.09533 * 20), 1e-12);
  EXPECT_NEAR(run(FrictionModel(BaseLaw::coulomb), {0.509, 0.318}, at.slip)[0], 0.318, 1e-12);
  const Steady back(-0.020, 1e-3, 1);
  EXPECT_NEAR(run(FrictionModel(BaseLaw::exponential), {0.509, 0.318, 52.14}, back.slip)[0],
              -(0.318 + 0.191 * std::exp(-0.05214 * 20)), 1e-12);
}

TEST(Laws, ReadmeNumberOfThePublishedMinimum) {
  // At 9 mm the fastest slip (56.5 mm/s) reaches 0.409, not mu_k = 0.388.
  const Steady at(0.0565, 1e-3, 1);
  EXPECT_NEAR(run(FrictionModel(BaseLaw::exponential), {0.521, 0.388, 32.37}, at.slip)[0], 0.409, 5e-4);
}

TEST(Viscous, AddsSigmaTimesSpeed) {
  const Steady at(0.050, 1e-3, 1);
  const FrictionModel model(BaseLaw::coulomb, {make_effect("viscous")});
  EXPECT_NEAR(run(model, {0.5, 0.3, 1.0}, at.slip)[0], 0.3 + 0.001 * 50, 1e-12);  // 0.001 s/mm at 50 mm/s
}

TEST(RateState, RelaxesOverItsLength) {
  // From break-away at mu_s to the steady value at constant speed: exp(-distance/D_c).
  const double speed = 0.01, length = 50e-6, step = 1e-4;
  Steady at(speed, step, 200);
  const FrictionModel model(BaseLaw::coulomb, {make_effect("rate-state")});
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
  const FrictionModel model(BaseLaw::coulomb, {make_effect("rate-state")});
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
  const FrictionModel model(BaseLaw::coulomb, {make_effect("bristle")});
  const std::vector<double> mu = run(model, {level, level, stiffness, 0.0}, at.slip);
  for (std::size_t i = 0; i < mu.size(); i += 10) {
    EXPECT_NEAR(mu[i], level * (1 - std::exp(-stiffness * speed * at.time[i] / level)), 1e-9);
  }
  const Steady far(0.05, 1e-3, 100);
  EXPECT_NEAR(run(model, {0.5, level, stiffness, 0.0}, far.slip)[99], level, 1e-9);
}

TEST(Bristle, CreepInStickFollowsTheRampOfTheSpring) {
  // near d mu/dt / sigma0 while mu is small against mu_s
  const Bristle bristle;
  const double p[] = {36.7e3, 0};
  EXPECT_NEAR(bristle.creep(p, 0.5, 0.0, 2.0), 2.0 / 36.7e3, 1e-12);
  EXPECT_NEAR(bristle.creep(p, 0.5, 0.25, 2.0), 4.0 / 36.7e3, 1e-12);
}

TEST(Formula, FollowsItsExpressionInTheUnitsOfThePage) {
  const FrictionModel model(BaseLaw::coulomb, {Formula("hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=0.025m/s, w=6mm/s")});
  EXPECT_EQ(model.parameters()[3].parameter.name, "v0");
  EXPECT_DOUBLE_EQ(model.parameters()[3].parameter.start, 25);
  EXPECT_EQ(model.parameters()[3].parameter.unit, "mm/s");
  const Steady at(0.031, 1e-3, 1);
  EXPECT_NEAR(run(model, {0.5, 0.3, 0.02, 25, 6}, at.slip)[0], 0.3 + 0.02 * std::exp(-1.0), 1e-12);
  const Steady back(-0.031, 1e-3, 1);
  EXPECT_NEAR(run(model, {0.5, 0.3, 0.02, 25, 6}, back.slip)[0], -0.3 - 0.02 * std::exp(-1.0), 1e-12);
}

TEST(Formula, SeesEveryVariable) {
  const samples::ExampleSlip example(10);
  const FrictionModel model(
      BaseLaw::coulomb,
      {Formula("all = k*(acceleration + t + angle + distance + stick_time + load + temperature); k=1")});
  const double mu = run(model, {0.5, 0.0, 1.0}, example.slip)[3];
  EXPECT_NEAR(mu,
              1e3 * example.acceleration[3] + example.time[3] + example.angle[3] + 1e3 * example.distance[3] + 0.1 +
                  example.load[3] + example.temperature[3],
              1e-9);
  EXPECT_TRUE(model.needs().acceleration && model.needs().load && model.needs().temperature);
  EXPECT_TRUE(model.needs().angle && model.needs().distance && model.needs().stick_time);
}

TEST(Formula, RefusesWhatItCannotRead) {
  const auto problem = [](const std::string& text) -> std::string {
    try {
      const Formula formula(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(problem("hump = a*exp(-v; a=1").find("^"), std::string::npos);  // shows where
  EXPECT_NE(problem("hump = a*vv; a=1").find("'vv'"), std::string::npos);
  EXPECT_NE(problem("hump = a*v").find("'a'"), std::string::npos);
  EXPECT_NE(problem("hump = a*v; a=1, b=2").find("'b' is not used"), std::string::npos);
  EXPECT_NE(problem("hump = a*v; a=1 parsec").find("'parsec'"), std::string::npos);
  EXPECT_NE(problem("hump = a*v; v=1, a=1").find("'v' is a variable"), std::string::npos);
  EXPECT_NE(problem("a*v; a=1").find("no '='"), std::string::npos);
  EXPECT_NE(problem("hump = a*v; a=").find("no number"), std::string::npos);
  EXPECT_NE(problem("hump = a*v; a=5[0,1]").find("bounds"), std::string::npos);
  EXPECT_NE(problem("hump = a*v; a=5[0,10garbage]").find("bounds"), std::string::npos);
  EXPECT_NE(problem("hump = a*v; a=5[0,inf]").find("bounds"), std::string::npos);
  EXPECT_NE(problem("hump = v=3").find("assignment"), std::string::npos);
  EXPECT_NE(problem("hump = a*v, 3; a=1").find("more than one"), std::string::npos);
  EXPECT_EQ(problem("hump = a*(v>=3); a=1"), "accepted");
  EXPECT_EQ(problem("hump = a*v; a=5[0,10]"), "accepted");
}

TEST(Model, RefusesTwiceTheSameAndUnknownEffects) {
  EXPECT_THROW(FrictionModel(BaseLaw::exponential, {make_effect("viscous"), make_effect("viscous")}), InputError);
  try {
    make_effect("viscos");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("viscous"), std::string::npos);
  }
}

TEST(Model, LaysParametersOutInOneOrderForAnyOrderGiven) {
  const std::vector<std::string> expected = {"mu_s", "mu_k", "beta", "sigma", "D_c", "a", "sigma0", "sigma1"};
  for (const bool reversed : {false, true}) {
    std::vector<Effect> effects = {make_effect("bristle"), make_effect("rate-state"), make_effect("viscous")};
    if (reversed) std::reverse(effects.begin(), effects.end());
    const FrictionModel model(BaseLaw::fractional, effects);
    ASSERT_EQ(model.parameters().size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(model.parameters()[k].parameter.name, expected[k]);
    EXPECT_EQ(model.offset(1), 4u);
    EXPECT_EQ(model.name(), "fractional + viscous + rate-state + bristle");
  }
}

}  // namespace
