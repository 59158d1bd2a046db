/// What every law of the list must satisfy; a new law is covered as soon as it is in the list.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "recovery/twin.hpp"
#include "samples.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/units.hpp"

namespace {

using namespace tribofit;

class EveryLaw : public testing::TestWithParam<std::string> {
 protected:
  const Law law_ = make_law(GetParam());
  const LawInfo info_ = describe(law_);
  const FrictionModel model_{law_};
  /// As it describes the test of [D] at 15 mm.
  const std::vector<double> q_ = published_test(0.015, law_).friction;

  double friction(const std::vector<double>& q, double v) const {
    return steady_friction(model_, q.data(), model_.law_values(q.data()), SlidingState<double>{.velocity = v});
  }
  /// Friction of a sample that is a mean over speeds with this standard deviation about v.
  double mean_friction(double v, double deviation) const {
    const std::vector<double> time = {0}, velocity = {v}, variance = {deviation * deviation};
    Slip slip;
    slip.time = time;
    slip.velocity = velocity;
    slip.velocity_variance = variance;
    double mu = 0;
    evaluate<double>(model_, q_.data(), slip, velocity, std::span(&mu, 1));
    return mu;
  }
};

TEST_P(EveryLaw, DescribesItself) {
  EXPECT_EQ(to_string(law_), GetParam());
  EXPECT_GT(info_.statement.size(), 20U);
  EXPECT_EQ(info_.equation.rfind("mu = ", 0), 0U) << info_.equation;
  EXPECT_FALSE(info_.source.empty());
  ASSERT_FALSE(info_.parameters.empty());
  ASSERT_LE(info_.parameters.size(), kMostLawParameters);
  EXPECT_EQ(q_.size(), info_.parameters.size());
  std::set<std::string> names;
  for (const Parameter& p : info_.parameters) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
    EXPECT_NE(info_.equation.find(p.name), std::string::npos) << p.name;
    EXPECT_GT(p.description.size(), 10U) << p.name;
    EXPECT_LT(p.lower, p.upper) << p.name;
    EXPECT_GE(p.start, p.lower) << p.name;
    EXPECT_LE(p.start, p.upper) << p.name;
    const auto unit = find_unit(p.unit);
    ASSERT_TRUE(unit) << p.name << " [" << p.unit << "]";
    EXPECT_DOUBLE_EQ(unit->factor, p.si) << p.name << " [" << p.unit << "]";
  }
  if (info_.two_levels) {
    ASSERT_GE(info_.parameters.size(), 2U);
    EXPECT_EQ(info_.parameters[0].name, "mu_s");
    EXPECT_EQ(info_.parameters[1].name, "mu_k");
  }
}

TEST_P(EveryLaw, DerivativesAreThoseOfTheValues) {
  using Dual = ceres::Jet<double, static_cast<int>(kMostLawParameters)>;
  for (const bool averaged : {false, true}) {
    samples::ExampleSlip example(200);
    const std::vector<double> variance(200, 1e-6);
    if (averaged) example.slip.velocity_variance = variance;
    const Slip& slip = example.slip;
    std::vector<Dual> dual, velocity(slip.velocity.begin(), slip.velocity.end()), mu(slip.size());
    for (std::size_t k = 0; k < q_.size(); ++k) dual.emplace_back(q_[k], static_cast<int>(k));
    evaluate<Dual>(model_, dual.data(), slip, velocity, mu);
    const Dual level = break_away_level(model_, dual.data(), slip);
    for (std::size_t k = 0; k < q_.size(); ++k) {
      const double h = 1e-5 * std::abs(q_[k]);
      std::vector<double> high = q_, low = q_, mu_high(slip.size()), mu_low(slip.size());
      high[k] += h;
      low[k] -= h;
      evaluate<double>(model_, high.data(), slip, slip.velocity, mu_high);
      evaluate<double>(model_, low.data(), slip, slip.velocity, mu_low);
      const auto place = static_cast<Eigen::Index>(k);
      double largest = 0;
      for (std::size_t i = 0; i < slip.size(); ++i) largest = std::max(largest, std::abs(mu[i].v[place]));
      for (std::size_t i = 0; i < slip.size(); ++i) {
        const double slope = (mu_high[i] - mu_low[i]) / (2 * h);
        EXPECT_NEAR(mu[i].v[place], slope, 1e-6 * largest + 1e-11 / h) << "parameter " << k << " sample " << i;
      }
      const double slope =
          (break_away_level(model_, high.data(), slip) - break_away_level(model_, low.data(), slip)) / (2 * h);
      EXPECT_NEAR(level.v[place], slope, 1e-6 * std::abs(slope) + 1e-11 / h) << "parameter " << k;
    }
  }
}

TEST_P(EveryLaw, IsContinuousFromRestToHighSpeed) {
  const double at_rest = friction_at_rest(law_, q_), drop = at_rest - friction(q_, 1.0);
  ASSERT_GT(std::abs(drop), 0.01);
  if (!info_.constant_in_slip) {
    EXPECT_NEAR(friction(q_, 0), at_rest, 1e-12);
    EXPECT_NEAR(friction(q_, 1e-9), at_rest, 1e-3 * std::abs(drop));
  }
  double before = friction(q_, 1e-8);
  for (double v = 1e-8; v < 1e3; v *= 1.02) {
    const double now = friction(q_, v);
    ASSERT_TRUE(std::isfinite(now)) << v;
    EXPECT_LT(std::abs(now - before), 0.03 * std::abs(drop)) << v;
    before = now;
  }
  if (info_.two_levels) {
    EXPECT_NEAR(friction(q_, 1e6), q_[1], 1e-5);
  }
}

TEST_P(EveryLaw, MeanOverASpreadIsThatOfQuadrature) {
  constexpr int kPoints = 20000;
  for (const double v : {2e-3, 0.01, 0.03, 0.08}) {
    const double deviation = 0.05 * v;  // small against the speeds over which laws bend
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
      sum += friction(q_, v + deviation * std::sqrt(3.0) * (2 * (i + 0.5) / kPoints - 1));
    }
    const double exact = sum / kPoints, shift = exact - friction(q_, v);
    EXPECT_NEAR(mean_friction(v, deviation), exact, 0.02 * std::abs(shift) + 1e-6) << v;
  }
  EXPECT_NEAR(mean_friction(0.02, 0), friction(q_, 0.02), 1e-14);
  for (const double v : {0.0, 1e-5, 1e-3}) {  // spreads wider than the speed itself stay within the law
    const double wide = mean_friction(v, 1e-3), scale = std::abs(friction_at_rest(law_, q_) - friction(q_, 0.01));
    EXPECT_NEAR(wide, friction(q_, std::max(v, 1e-3)), 2 * scale + 1e-12) << v;
  }
}

TEST_P(EveryLaw, EffectsActOnItAsTheyDoOnAll) {
  const samples::ExampleSlip forward(50, 0.08, 0.1, 1), backward(50, 0.08, 0.1, -1);
  std::vector<double> with = q_, bare(50), mu(50);
  evaluate<double>(model_, q_.data(), forward.slip, forward.slip.velocity, bare);
  // Asymmetry scales friction at every speed.
  const FrictionModel asymmetry(law_, {make_effect("asymmetry")});
  with.push_back(1.2);
  evaluate<double>(asymmetry, with.data(), backward.slip, backward.slip.velocity, mu);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(mu[i], -1.2 * bare[i], 1e-12);
  EXPECT_NEAR(break_away_level(asymmetry, with.data(), backward.slip), 1.2 * friction_at_rest(law_, q_), 1e-12);
  // Ageing raises break-away.
  const FrictionModel ageing(law_, {make_effect("ageing")});
  with.back() = 0.01;
  with.push_back(0.05);
  EXPECT_NEAR(break_away_level(ageing, with.data(), forward.slip),
              friction_at_rest(law_, q_) + 0.01 * std::log(1 + 0.1 / 0.05), 1e-12);
  // Contacts with an age take the law at D_c over their age, as long as they rest: 10 um in 0.1 s.
  if (!info_.constant_in_slip) {
    const FrictionModel healing(law_, {make_effect("rate-state:healing")});
    std::vector<double> p = q_;
    p.insert(p.end(), {10e-6, 0});
    EXPECT_NEAR(break_away_level(healing, p.data(), forward.slip), friction(q_, 1e-4), 1e-12);
  }
  // What changes the reduced speed needs one.
  const Effect bends = make_effect("stribeck-exponent");
  EXPECT_EQ(model_.acts_with(bends), has_reduced_speed(law_));
  if (!has_reduced_speed(law_)) {
    EXPECT_THROW(FrictionModel(law_, {bends}), InputError);
    EXPECT_NE(obstacle_on(law_, bends).find(GetParam()), std::string::npos);
  }
}

TEST_P(EveryLaw, ComesBackFromASimulatedRecord) {
  recovery::TwinOptions options;
  options.law = law_;
  options.duration = 15;
  options.scatter = 0.002;
  const recovery::Twin twin = recovery::make_twin(options);
  const Fit fit = recovery::fit_twin(twin, law_);
  ASSERT_TRUE(fit.converged);
  ASSERT_EQ(fit.parameters.size(), twin.truth.size());
  for (std::size_t k = 0; k < twin.truth.size(); ++k) {
    const FitParameter& p = fit.parameters[k];
    EXPECT_FALSE(p.at_bound) << p.parameter.name;
    EXPECT_NEAR(p.value, twin.truth[k], 4 * p.std_error) << p.parameter.name;
    EXPECT_LT(p.std_error, 0.05 * std::abs(twin.truth[k])) << p.parameter.name;
  }
  EXPECT_NEAR(fit.error.rmse / fit.floor.rmse, 1, 0.1);
}

INSTANTIATE_TEST_SUITE_P(List, EveryLaw, testing::ValuesIn(law_keys()), [](const auto& key) {
  std::string name(key.param);
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(LawList, RefusesAnUnknownKeyWithTheNearest) {
  EXPECT_FALSE(find_law("exponental"));
  try {
    make_law("exponental");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'exponential'"), std::string::npos);
  }
}

}  // namespace
