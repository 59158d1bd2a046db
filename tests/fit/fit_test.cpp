#include "tribofit/fit/fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "synthetic.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace {

using namespace tribofit;

Fit fit_record(const FrictionModel& model, const synthetic::Record& record, const FitOptions& options = {},
               std::size_t values_per_slip = 80) {
  const Observations observations = observe(record.motion, record.segmentation, model.needs(), values_per_slip);
  return fit_model(model, record.motion, record.segmentation, observations, {}, options);
}

/// Every model returns the parameters it was simulated with.
struct Case {
  const char* name;
  Law law;
  std::vector<Effect> effects;
  std::vector<double> extra;
};

class Recovers : public testing::TestWithParam<Case> {};

TEST_P(Recovers, ParametersOfNoiseFreeData) {
  const Case& c = GetParam();
  const FrictionModel model(c.law, c.effects);
  std::vector<double> truth = synthetic::table4_15mm(c.law);
  if (c.law == Law(CoulombLaw{})) truth.pop_back();
  truth.insert(truth.end(), c.extra.begin(), c.extra.end());
  for (const double direction : {1.0, -1.0}) {
    synthetic::Options options;
    options.direction = direction;
    options.cycles = 12;
    const Fit fit = fit_record(model, synthetic::make(model, truth, options), {}, 0);
    ASSERT_EQ(fit.parameters.size(), truth.size());
    EXPECT_TRUE(fit.converged);
    for (std::size_t k = 0; k < truth.size(); ++k) {
      EXPECT_NEAR(fit.parameters[k].value, truth[k], 1e-5 * std::abs(truth[k]) + 1e-9)
          << fit.parameters[k].parameter.name;
    }
    EXPECT_LT(fit.error.rmse, 1e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, Recovers,
    testing::Values(Case{"exponential", Law(ExponentialLaw{}), {}, {}},
                    Case{"fractional", Law(FractionalLaw{}), {}, {}}, Case{"coulomb", Law(CoulombLaw{}), {}, {}},
                    Case{"viscous", Law(ExponentialLaw{}), {make_effect("viscous")}, {1.2}},
                    Case{"rate_state", Law(ExponentialLaw{}), {make_effect("rate-state")}, {60e-6, 0.004}},
                    Case{"healing", Law(ExponentialLaw{}), {make_effect("rate-state:healing")}, {60e-6, 0.004}},
                    Case{"formula",
                         Law(ExponentialLaw{}),
                         {Formula("hump = a*exp(-((v-v0)/w)^2); a=0.01, v0=30mm/s, w=8mm/s")},
                         {0.02, 0.025, 0.006}}),
    [](const auto& c) { return std::string(c.param.name); });

TEST(Fit, WhatTheDataDoNotDetermineHasNoFiniteInterval) {
  synthetic::Options options;
  options.noise = 0.003;
  options.cycles = 40;
  const FrictionModel law(ExponentialLaw{});
  const synthetic::Record record = synthetic::make(law, synthetic::table4_15mm(ExponentialLaw{}), options);
  const Fit product = fit_record(FrictionModel(ExponentialLaw{}, {Formula("x = a*b*v; a=0.01, b=0.02")}), record);
  ASSERT_EQ(product.parameters.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    const FitParameter& p = product.parameters[k];
    EXPECT_EQ(p.determined, k < 3) << p.parameter.name;
    EXPECT_EQ(std::isfinite(p.std_error), k < 3) << p.parameter.name;
    EXPECT_EQ(std::isfinite(p.upper95 - p.lower95), k < 3) << p.parameter.name;
  }
  EXPECT_THAT(product.messages, testing::Contains(testing::HasSubstr("x a and x b are not determined")));
  // The rest is what it is beside the one term that the two make.
  const Fit one = fit_record(FrictionModel(ExponentialLaw{}, {Formula("x = a*v; a=0.0002")}), record);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(product.parameters[k].std_error / one.parameters[k].std_error, 1, 1e-3) << k;
  }
  EXPECT_TRUE(std::all_of(one.parameters.begin(), one.parameters.end(), [](const auto& p) { return p.determined; }));
  // A constant is what mu_s and mu_k hold already.
  const Fit constant = fit_record(FrictionModel(ExponentialLaw{}, {Formula("c = a; a=0.01")}), record);
  EXPECT_FALSE(constant.parameters[0].determined);
  EXPECT_FALSE(constant.parameters[1].determined);
  EXPECT_TRUE(constant.parameters[2].determined);
  EXPECT_FALSE(constant.parameters[3].determined);
}

TEST(Fit, MeansOverAFewSamplesDoNotMoveTheBareLaws) {
  for (const Law& law : {Law(ExponentialLaw{}), Law(FractionalLaw{})}) {
    const std::vector<double> truth = synthetic::table4_15mm(law);
    synthetic::Options options;
    options.rate = 100e3;
    options.cycles = 10;
    const Fit fit = fit_record(FrictionModel(law), synthetic::make(FrictionModel(law), truth, options));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(fit.parameters[k].value / truth[k], 1, 1e-5) << k;
  }
}

TEST(Fit, ReportsTheNoiseAsItsErrorAndItsFloor) {
  const FrictionModel model(ExponentialLaw{});
  for (const double colour : {0.0, 0.9}) {
    synthetic::Options options;
    options.noise = 0.003;
    options.colour = colour;
    options.cycles = 60;
    const Fit fit = fit_record(model, synthetic::make(model, synthetic::table4_15mm(ExponentialLaw{}), options));
    EXPECT_NEAR(fit.error.rmse, 0.003, 0.0001) << colour;
    EXPECT_NEAR(fit.floor.noise, 0.003, 0.0001) << colour;
    EXPECT_NEAR(fit.error.held_out_rmse, fit.error.rmse, 0.00003) << colour;
    EXPECT_GT(fit.error.held_out_rmse, fit.error.rmse) << colour;
    EXPECT_GT(fit.explained, 0.99);
  }
}

TEST(Fit, FloorHoldsBreakAwayScatter) {
  const FrictionModel model(ExponentialLaw{});
  const std::vector<double> truth = synthetic::table4_15mm(ExponentialLaw{});
  synthetic::Options options;
  options.noise = 0.003;
  options.scatter = 0.01;
  options.cycles = 200;
  const Fit fit = fit_record(model, synthetic::make(model, truth, options));
  EXPECT_NEAR(fit.floor.scatter, 0.01, 0.0015);
  EXPECT_NEAR(fit.floor.rmse, fit.error.rmse, 0.03 * fit.error.rmse);
}

TEST(Fit, PublishedProtocolCarriesTheBiasTheLawPredicts) {
  // Without noise the minimum in slip is the law at the fastest slip, not mu_k: physics of [D] Eq 2.
  const FrictionModel model(ExponentialLaw{});
  const std::vector<double> truth = synthetic::table4_15mm(ExponentialLaw{});
  synthetic::Options options;
  options.peak = 0.03;
  const synthetic::Record record = synthetic::make(model, truth, options);
  FitOptions published;
  published.protocol = Protocol::published;
  const Fit fit = fit_record(model, record, published);
  double minimum = 0;
  for (const Cycle& cycle : record.segmentation.cycles) {
    minimum += (truth[1] + (truth[0] - truth[1]) * std::exp(-truth[2] * cycle.peak_velocity)) / 40;
  }
  EXPECT_NEAR(fit.parameters[0].value, truth[0], 5e-4);  // the last sample of the ramp is half a step before break-away
  EXPECT_NEAR(fit.parameters[1].value, minimum, 1e-4);
  EXPECT_GT(fit.parameters[2].value, 1.1 * truth[2]);
}

TEST(Fit, ComparisonPrefersTheGeneratingLaw) {
  for (const Law& law : {Law(ExponentialLaw{}), Law(FractionalLaw{})}) {
    synthetic::Options options;
    options.noise = 0.003;
    options.colour = 0.9;
    options.scatter = 0.004;
    const synthetic::Record record = synthetic::make(FrictionModel(law), synthetic::table4_15mm(law), options);
    const Fit right = fit_record(FrictionModel(law), record);
    const Fit wrong =
        fit_record(FrictionModel(law == Law(ExponentialLaw{}) ? Law(FractionalLaw{}) : Law(ExponentialLaw{})), record);
    const Comparison comparison = compare_held_out(right, wrong);
    EXPECT_TRUE(comparison.first_better);
    EXPECT_LT(comparison.p_value, 0.01);
  }
}

TEST(Fit, SaysWhatTheDataDoNotSay) {
  synthetic::Options options;
  options.noise = 0.001;
  const auto has = [](const Fit& fit, const std::string& text) {
    for (const std::string& message : fit.messages) {
      if (message.find(text) != std::string::npos) return true;
    }
    return false;
  };
  // Slips that end far from mu_k leave it to extrapolation and tie it to the decay factor.
  options.peak = 0.01;
  const FrictionModel model(ExponentialLaw{});
  const Fit slow = fit_record(model, synthetic::make(model, synthetic::table4_15mm(ExponentialLaw{}), options));
  EXPECT_TRUE(has(slow, "mu_k is extrapolated"));
  EXPECT_TRUE(has(slow, "strongly correlated"));
  // A viscous term beyond its plausible bound ends there.
  const FrictionModel viscous(ExponentialLaw{}, {make_effect("viscous")});
  options.peak = 0.08;
  const Fit bound = fit_record(viscous, synthetic::make(viscous, {0.509, 0.318, 52.14, -3.0}, options));
  EXPECT_TRUE(bound.parameters[3].at_bound);
  EXPECT_TRUE(has(bound, "sigma is at its lower bound of"));
}

TEST(Fit, FewerThanThreeCyclesIsAReasonNotAnException) {
  synthetic::Options options;
  options.cycles = 2;
  const FrictionModel model(ExponentialLaw{});
  const Fit fit = fit_record(model, synthetic::make(model, synthetic::table4_15mm(ExponentialLaw{}), options));
  EXPECT_FALSE(fit.converged);
  ASSERT_FALSE(fit.messages.empty());
  EXPECT_NE(fit.messages[0].find("fewer than three cycles"), std::string::npos);
}

TEST(Fit, FrictionThatRisesWithSpeedIsNotForcedToFall) {
  const FrictionModel model(ExponentialLaw{});
  const std::vector<double> truth = {0.15, 0.21, 40};
  synthetic::Options options;
  options.noise = 0.002;
  const Fit fit = fit_record(model, synthetic::make(model, truth, options));
  EXPECT_LT(fit.parameters[0].value, fit.parameters[1].value);
  EXPECT_NEAR(fit.parameters[0].value, truth[0], 0.001);
  EXPECT_NEAR(fit.parameters[1].value, truth[1], 0.001);
}

TEST(Fit, RobustLossStandsBadSamples) {
  const FrictionModel model(ExponentialLaw{});
  const std::vector<double> truth = synthetic::table4_15mm(ExponentialLaw{});
  synthetic::Options options;
  options.noise = 0.003;
  synthetic::Record record = synthetic::make(model, truth, options);
  for (std::size_t i = 0; i < record.motion.size(); i += 97) record.motion.friction[i] += 0.5;
  const Observations every = observe(record.motion, record.segmentation, {}, 0);
  const auto error_with = [&](Loss loss) {
    FitOptions with;
    with.loss = loss;
    return std::abs(fit_model(model, record.motion, record.segmentation, every, {}, with).parameters[1].value -
                    truth[1]);
  };
  EXPECT_GT(error_with(Loss::squares), 0.004);
  EXPECT_LT(error_with(Loss::huber), 0.002);
  EXPECT_LT(error_with(Loss::soft_l1), 0.002);
}

TEST(Fit, ProfileAgreesWithTheSymmetricIntervalWhereTheModelIsNearlyLinear) {
  const FrictionModel model(ExponentialLaw{});
  synthetic::Options options;
  options.noise = 0.003;
  options.cycles = 60;
  FitOptions with;
  with.profile = true;
  const Fit fit = fit_record(model, synthetic::make(model, synthetic::table4_15mm(ExponentialLaw{}), options), with);
  for (const FitParameter& p : fit.parameters) {
    const double width = p.upper95 - p.lower95;
    EXPECT_NEAR(p.profile_lower95, p.lower95, 0.05 * width) << p.parameter.name;
    EXPECT_NEAR(p.profile_upper95, p.upper95, 0.05 * width) << p.parameter.name;
  }
}

/// The record without the cycles of one fold.
synthetic::Record without_fold(const synthetic::Record& record, const Fit& fit, std::size_t fold) {
  synthetic::Record kept = record;
  kept.segmentation.cycles.clear();
  for (std::size_t c = 0; c < record.segmentation.cycles.size(); ++c) {
    if (fit.fold_of(c) != fold) kept.segmentation.cycles.push_back(record.segmentation.cycles[c]);
  }
  return kept;
}

TEST(Fit, HeldOutParametersAreThoseOfRefits) {
  const FrictionModel model(ExponentialLaw{});
  synthetic::Options options;
  options.noise = 0.003;
  options.scatter = 0.01;
  const synthetic::Record record = synthetic::make(model, synthetic::table4_15mm(ExponentialLaw{}), options);
  for (const Protocol protocol : {Protocol::joint, Protocol::published}) {
    FitOptions with;
    with.protocol = protocol;
    const Fit fit = fit_record(model, record, with);
    for (std::size_t fold = 0; fold < fit.fold_parameters.size(); ++fold) {
      const Fit refit = fit_record(model, without_fold(record, fit, fold), with);
      for (std::size_t k = 0; k < 3; ++k) {
        // to a small part of what leaving the fold out changes
        EXPECT_NEAR(fit.fold_parameters[fold][k], refit.parameters[k].value, 0.1 * fit.parameters[k].std_error + 1e-9)
            << to_string(protocol) << " fold " << fold << " " << k;
      }
    }
  }
}

TEST(Fit, MeansOverAFewSamplesDoNotChangeTheErrors) {
  const FrictionModel model(ExponentialLaw{});
  synthetic::Options options;
  options.noise = 0.003;
  options.rate = 40e3;
  options.scatter = 0.01;
  const synthetic::Record record = synthetic::make(model, synthetic::table4_15mm(ExponentialLaw{}), options);
  const Fit reduced = fit_record(model, record), every = fit_record(model, record, {}, 0);
  EXPECT_NEAR(reduced.error.held_out_rmse / every.error.held_out_rmse, 1, 1e-4);
  EXPECT_NEAR(reduced.error.rmse / every.error.rmse, 1, 1e-4);
}

TEST(Fit, AnEffectThatIsNotThereDoesNotMakeTheFitWorse) {
  synthetic::Options options;
  options.noise = 0.003;
  const FrictionModel bare(ExponentialLaw{});
  const synthetic::Record record = synthetic::make(bare, synthetic::table4_15mm(ExponentialLaw{}), options);
  const double error = fit_record(bare, record).error.rmse;
  EXPECT_LT(fit_record(FrictionModel(ExponentialLaw{}, {make_effect("viscous")}), record).error.rmse, 1.001 * error);
  // The least memory within bounds still shows where these slips come to rest as gently as no rig does.
  const FrictionModel memory(ExponentialLaw{}, {make_effect("rate-state")});
  EXPECT_LT(fit_record(memory, record, {}, 1000).error.rmse, 1.06 * error);
}

TEST(Fit, AFormulaThatIsNotFiniteIsAReason) {
  synthetic::Options options;
  const FrictionModel bare(ExponentialLaw{});
  const synthetic::Record record = synthetic::make(bare, synthetic::table4_15mm(ExponentialLaw{}), options);
  for (const char* text :
       {"x = a/0; a=0.1", "x = a*log(v-500); a=0.001", "x = a*sqrt(v-50); a=1", "x = a*1e308*1e308; a=1"}) {
    const Fit fit = fit_record(FrictionModel(ExponentialLaw{}, {Formula(text)}), record);
    EXPECT_FALSE(fit.converged) << text;
    ASSERT_FALSE(fit.messages.empty()) << text;
    EXPECT_NE(fit.messages[0].find("not finite"), std::string::npos) << fit.messages[0];
  }
}

TEST(Fit, PublishedCoulombFrictionHasNothingLeftToFit) {
  const FrictionModel model(CoulombLaw{});
  synthetic::Options options;
  options.noise = 0.002;
  FitOptions published;
  published.protocol = Protocol::published;
  const Fit fit = fit_record(model, synthetic::make(model, {0.5, 0.3}, options), published);
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.parameters[0].value, 0.5, 0.01);
}

TEST(Fit, CurveIsTheModelInSteadySliding) {
  synthetic::Options options;
  options.cycles = 8;
  const std::vector<Effect> every[] = {{make_effect("viscous")},
                                       {make_effect("rate-state")},
                                       {make_effect("bristle")},
                                       {Formula("hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=25mm/s, w=6mm/s")}};
  for (const auto& effects : every) {
    const FrictionModel model(ExponentialLaw{}, effects);
    const Fit fit = fit_record(
        model, synthetic::make(FrictionModel(ExponentialLaw{}), synthetic::table4_15mm(ExponentialLaw{}), options));
    const double speed = 0.031;
    const Curve curve = law_curve(fit, std::vector<double>{speed});
    const std::vector<double> time = {0, 0.5, 1}, velocity(3, speed);
    Slip slip;
    slip.time = time;
    slip.velocity = velocity;
    std::vector<double> mu(3);
    const std::vector<double> p = fit.values();
    evaluate<double>(model, p.data(), slip, slip.velocity, mu);
    EXPECT_NEAR(curve.mu[0], mu[2], 1e-12) << model.name();
    EXPECT_LE(curve.lower95[0], curve.mu[0]);
  }
}

TEST(Fit, EffectsScaleWithAForce) {
  // The same record in newtons: levels and viscous coefficient times the load, same decay factor.
  const FrictionModel model(ExponentialLaw{}, {make_effect("viscous")});
  synthetic::Options options;
  options.noise = 0.001;
  synthetic::Record record = synthetic::make(model, {0.509, 0.318, 52.14, 1.0}, options);
  const double load = 50;
  for (double& mu : record.motion.friction) mu *= load;
  for (Cycle& cycle : record.segmentation.cycles) cycle.break_away_friction *= load;
  record.motion.friction_kind = FrictionKind::force;
  const Fit fit = fit_record(model, record);
  EXPECT_NEAR(fit.parameters[0].value, 50 * 0.509, 0.05);
  EXPECT_NEAR(fit.parameters[3].value, 50, 2);
  EXPECT_EQ(fit.parameters[0].parameter.unit, "N");
  EXPECT_EQ(fit.parameters[3].parameter.unit, "N s/mm");
  EXPECT_FALSE(fit.parameters[3].at_bound);
}

/// Coverage of a mean's 95 % interval on 4000 series: white, and first-order autoregressive.
TEST(Uncertainty, MeanErrorCovers) {
  boost::random::mt19937_64 engine(7);
  for (const double correlation : {0.0, 0.5, 0.7}) {
    int covered = 0;
    constexpr int kSeries = 4000;
    for (int s = 0; s < kSeries; ++s) {
      synthetic::ColouredNoise noise(correlation, engine);
      std::vector<double> x(100);
      double mean = 0;
      for (double& value : x) {
        value = noise();
        mean += value / 100;
      }
      const Estimate error = standard_error_of_mean(x);
      covered += std::abs(mean) <= t_quantile_95(error.degrees_of_freedom) * error.std_error ? 1 : 0;
    }
    const double rate = covered / double(kSeries);
    EXPECT_GE(rate, 0.935) << correlation;
    EXPECT_LE(rate, 0.965) << correlation;
  }
}

}  // namespace
