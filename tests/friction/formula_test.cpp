/// Formulas of users, and how a model holds its effects.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "samples.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace {

using namespace tribofit;
using samples::run;
using samples::Steady;

TEST(Formula, FollowsItsExpressionInTheUnitsOfThePage) {
  const FrictionModel model(CoulombLaw{}, {Formula("hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=0.025m/s, w=6mm/s")});
  EXPECT_EQ(model.parameters()[3].parameter.name, "v0");
  EXPECT_DOUBLE_EQ(model.parameters()[3].parameter.start, 25);
  EXPECT_EQ(model.parameters()[3].parameter.unit, "mm/s");
  EXPECT_DOUBLE_EQ(model.parameters()[3].parameter.si, 1e-3);
  const Steady at(0.031, 1e-3, 1);
  EXPECT_NEAR(run(model, {0.5, 0.3, 0.02, 0.025, 0.006}, at.slip)[0], 0.3 + 0.02 * std::exp(-1.0), 1e-12);
  const Steady back(-0.031, 1e-3, 1);
  EXPECT_NEAR(run(model, {0.5, 0.3, 0.02, 0.025, 0.006}, back.slip)[0], -0.3 - 0.02 * std::exp(-1.0), 1e-12);
}

TEST(Formula, SeesEveryVariable) {
  const samples::ExampleSlip example(10);
  const FrictionModel model(CoulombLaw{}, {Formula("all = k*(acceleration + t + angle + distance + reversal_distance + "
                                                   "stick_time + load + temperature); k=1")});
  const double mu = run(model, {0.5, 0.0, 1.0}, example.slip)[3];
  EXPECT_NEAR(mu,
              1e3 * example.acceleration[3] + example.time[3] + example.angle[3] + 1e3 * example.distance[3] +
                  1e3 * example.reversal_distance[3] + 0.1 + example.load[3] + example.temperature[3],
              1e-9);
  EXPECT_TRUE(model.needs().acceleration && model.needs().load && model.needs().temperature);
  EXPECT_TRUE(model.needs().angle && model.needs().distance && model.needs().reversal_distance);
  EXPECT_TRUE(model.needs().stick_time && model.needs().time);
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
  // 300 K is 26.85 degC, but 5 K may be a width.
  EXPECT_NE(problem("h = a*(temperature-T0); a=1, T0=300K").find("in degC"), std::string::npos);
  EXPECT_EQ(problem("h = a*(temperature-T0); a=1, T0=26.85degC"), "accepted");
  EXPECT_NE(problem("hump = a*v; a=").find("needs a number as its start value"), std::string::npos);
  EXPECT_NE(problem("hump = a*v; a=5[0,1]").find("bounds"), std::string::npos);
  EXPECT_NE(problem("hump = a*v; a=5[0,10garbage]").find("bounds"), std::string::npos);
  EXPECT_NE(problem("hump = a*v; a=5[0,inf]").find("bounds"), std::string::npos);
  EXPECT_NE(problem("hump = v=3").find("assignment"), std::string::npos);
  EXPECT_NE(problem("hump = a*v, 3; a=1").find("more than one"), std::string::npos);
  EXPECT_EQ(problem("hump = a*(v>=3); a=1"), "accepted");
  EXPECT_EQ(problem("hump = a*v; a=5[0,10]"), "accepted");
}

TEST(Model, RefusesTwiceTheSameAndUnknownEffects) {
  EXPECT_THROW(FrictionModel(ExponentialLaw{}, {make_effect("viscous"), make_effect("viscous")}), InputError);
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
    const FrictionModel model(FractionalLaw{}, effects);
    ASSERT_EQ(model.parameters().size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(model.parameters()[k].parameter.name, expected[k]);
    EXPECT_EQ(model.offset(1), 4u);
    EXPECT_EQ(model.name(), "fractional + viscous + rate-state + bristle");
  }
}

}  // namespace
