/// What every effect of the catalogue must satisfy; a new effect is covered as soon as it is in the list.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "samples.hpp"
#include "tribofit/friction/dynamics.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/units.hpp"

namespace {

using namespace tribofit;

std::vector<std::string> catalogue_keys() {
  std::vector<std::string> keys;
  for (const Effect& effect : effect_catalogue()) keys.push_back(describe(effect).key);
  return keys;
}

class EveryEffect : public testing::TestWithParam<std::string> {
 protected:
  FrictionModel model_{BaseLaw::exponential, {make_effect(GetParam())}};

  /// Base law of [D] at 15 mm; effects a third of the way between their bounds, so that each of them acts.
  std::vector<double> example() const {
    std::vector<double> p = {0.509, 0.318, 52.14};
    for (std::size_t k = 3; k < model_.parameters().size(); ++k) {
      const Parameter& q = model_.parameters()[k].parameter;
      const double value =
          q.lower > 0 ? q.lower * std::pow(q.upper / q.lower, 0.3) : q.lower + 0.3 * (q.upper - q.lower);
      p.push_back(value * q.si);
    }
    return p;
  }
};

TEST_P(EveryEffect, DescribesItself) {
  const EffectInfo info = describe(model_.effects()[0]);
  EXPECT_GT(info.statement.size(), 20u);
  EXPECT_NE(info.equation.find('='), std::string::npos);
  EXPECT_FALSE(info.source.empty());
  EXPECT_FALSE(info.experiment.empty());
  EXPECT_FALSE(info.parameters.empty());
  std::set<std::string> names;
  for (const Parameter& p : info.parameters) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
    EXPECT_LT(p.lower, p.upper) << p.name;
    EXPECT_GE(p.start, p.lower) << p.name;
    EXPECT_LE(p.start, p.upper) << p.name;
    const auto unit = find_unit(p.unit);
    ASSERT_TRUE(unit) << p.name << " [" << p.unit << "]";
    EXPECT_DOUBLE_EQ(unit->factor, p.si) << p.name << " [" << p.unit << "]";
  }
}

TEST_P(EveryEffect, DerivativesAreThoseOfTheValues) {
  using Dual = ceres::Jet<double, 8>;
  for (const double direction : {1.0, -1.0}) {
    const samples::ExampleSlip example_slip(400, 0.08, 0.1, direction);
    const Slip& slip = example_slip.slip;
    const std::vector<double> p = example();
    ASSERT_LE(p.size(), 8u);
    std::vector<Dual> dual, mu(slip.size()), velocity;
    for (std::size_t k = 0; k < p.size(); ++k) dual.emplace_back(p[k], static_cast<int>(k));
    for (const double v : slip.velocity) velocity.emplace_back(v);
    evaluate<Dual>(model_, dual.data(), slip, velocity, mu);
    const Dual level = break_away_level(model_, dual.data(), slip);
    for (std::size_t k = 0; k < p.size(); ++k) {
      std::vector<double> high = p, low = p, mu_high(slip.size()), mu_low(slip.size());
      const double h = 1e-5 * std::max(std::abs(p[k]), 1e-4);
      high[k] += h;
      low[k] -= h;
      evaluate<double>(model_, high.data(), slip, slip.velocity, mu_high);
      evaluate<double>(model_, low.data(), slip, slip.velocity, mu_low);
      double scale = 1e-12;
      for (std::size_t i = 0; i < slip.size(); ++i) scale = std::max(scale, std::abs(mu_high[i] - mu_low[i]) / (2 * h));
      for (std::size_t i = 0; i < slip.size(); i += 7) {
        const double slope = (mu_high[i] - mu_low[i]) / (2 * h);
        EXPECT_NEAR(mu[i].v[static_cast<Eigen::Index>(k)], slope, 1e-4 * scale + 1e-9 / h)
            << "parameter " << k << " sample " << i;
      }
      const double slope =
          (break_away_level(model_, high.data(), slip) - break_away_level(model_, low.data(), slip)) / (2 * h);
      EXPECT_NEAR(level.v[static_cast<Eigen::Index>(k)], slope, 1e-6 * std::abs(slope) + 1e-9 / h);
      EXPECT_EQ(mu[5].a, mu[5].a);  // finite: NaN is not equal to itself
    }
  }
}

TEST_P(EveryEffect, IsFiniteAtRestAndAtHighSpeed) {
  for (const double peak : {1e-9, 1e-6, 10.0}) {
    const samples::ExampleSlip example_slip(50, peak);
    const std::vector<double> p = example();
    std::vector<double> mu(example_slip.slip.size());
    evaluate<double>(model_, p.data(), example_slip.slip, example_slip.slip.velocity, mu);
    for (const double value : mu) EXPECT_TRUE(std::isfinite(value)) << peak;
    EXPECT_TRUE(std::isfinite(break_away_level(model_, p.data(), example_slip.slip)));
  }
}

TEST_P(EveryEffect, MirrorsWithTheDirection) {
  // A contact has no preferred direction unless the effect says so, and then by name.
  const std::set<std::string> one_sided = {"asymmetry", "sensor-offset", "crosstalk"};
  if (one_sided.contains(GetParam())) return;
  const samples::ExampleSlip forward(100, 0.08, 0.1, 1), backward(100, 0.08, 0.1, -1);
  const std::vector<double> p = example();
  std::vector<double> a(100), b(100);
  evaluate<double>(model_, p.data(), forward.slip, forward.slip.velocity, a);
  evaluate<double>(model_, p.data(), backward.slip, backward.slip.velocity, b);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_NEAR(a[i], -b[i], 1e-12);
}

TEST_P(EveryEffect, IsTheSameInASimulationAndInAFit) {
  // The instant-by-instant form, integrated finely, must meet the whole-slip form.
  const samples::ExampleSlip example_slip(4000);
  const Slip& slip = example_slip.slip;
  const std::vector<double> p = example();
  std::vector<double> whole(slip.size());
  evaluate<double>(model_, p.data(), slip, slip.velocity, whole);
  FrictionDynamics dynamics(model_, p);
  dynamics.begin_slip(slip.stick_time, slip.direction);
  std::vector<double> state(dynamics.state_count()), rate(state.size());
  dynamics.states_at_break_away(state);
  double worst = 0;
  const std::size_t settle =
      model_.acts_in_stick() ? slip.size() / 4 : 0;  // its start is the spring's, not tested here
  for (std::size_t i = 0; i + 1 < slip.size(); ++i) {
    const Instant<double> now = slip.at(i, slip.velocity[i]);
    if (i >= settle) worst = std::max(worst, std::abs(dynamics.friction(now, state) - whole[i]));
    const int parts = 200;
    const double dt = (slip.time[i + 1] - slip.time[i]) / parts;
    for (int k = 0; k < parts; ++k) {
      const double u = (k + 0.5) / parts;
      Instant<double> at = now;
      at.velocity = (1 - u) * slip.velocity[i] + u * slip.velocity[i + 1];
      dynamics.rates(at, state, rate);
      for (std::size_t s = 0; s < state.size(); ++s) state[s] += dt * rate[s];
    }
  }
  EXPECT_LT(worst, 2e-4);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffect, testing::ValuesIn(catalogue_keys()), [](const auto& key) {
  std::string name = key.param;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
});

}  // namespace
