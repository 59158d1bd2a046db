/// Creep in stick: the motion at which a model's friction balances the spring.
#include "tribofit/friction/creep.hpp"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace tribofit;

const double kOmega = 0.419;

FrictionModel with(const char* key) {
  return FrictionModel(ExponentialLaw{}, {make_effect(key)});
}

Slip slip_in(double direction) {
  Slip slip;
  slip.direction = direction;
  slip.stick_time = 0.2;
  return slip;
}

/// Friction of a contact that turns on the disc, sliding at v.
double friction_at(const FrictionModel& model, const std::vector<double>& p, double v) {
  SlidingState<double> at;
  at.velocity = v;
  at.disc_speed = kOmega;
  return steady_friction(model, p.data(), law_for(model, p.data(), slip_in(1)), at);
}

TEST(Creep, OfAContactThatTurnsIsWhereItsFrictionBalancesTheSpring) {
  const FrictionModel model = with("contact-spin");
  for (const double pad : {0.2e-3, 1e-3, 4e-3}) {
    const std::vector<double> p = {0.509, 0.318, 52.14, pad};
    double before = 0;
    for (const double v : {0.1, 0.3, 0.6, 0.9, 1.1}) {
      const double mu = friction_at(model, p, v * pad * kOmega);
      ASSERT_GT(mu, before);  // the branch that rises
      before = mu;
      const double creep = creep_in_stick(model, p.data(), slip_in(1), StickMoment{mu, 2, kOmega});
      EXPECT_NEAR(creep / (v * pad * kOmega), 1, 1e-5) << pad << " " << v;
    }
  }
}

/// Friction in newtons is a coefficient times the load: the block creeps at the same speed.
TEST(Creep, OfAForceIsThatOfItsCoefficient) {
  const FrictionModel model = with("contact-spin");
  const double load = 5e4;
  const std::vector<double> p = {0.509, 0.318, 52.14, 1e-3}, in_newtons = {0.509 * load, 0.318 * load, 52.14, 1e-3};
  for (const double v : {0.1, 0.6, 1.1}) {
    const double mu = friction_at(model, p, v * 1e-3 * kOmega);
    const double creep = creep_in_stick(model, p.data(), slip_in(1), StickMoment{mu, 2, kOmega});
    const double of_force =
        creep_in_stick(model, in_newtons.data(), slip_in(1), StickMoment{mu * load, 2 * load, kOmega});
    EXPECT_NEAR(of_force / creep, 1, 1e-6) << v;
    EXPECT_NEAR(of_force / (v * 1e-3 * kOmega), 1, 1e-5) << v;
  }
}

TEST(Creep, StaysFiniteBeyondThePeakAndTurnsWithFriction) {
  const FrictionModel model = with("contact-spin");
  const std::vector<double> p = {0.509, 0.318, 52.14, 1e-3};
  const double beyond = creep_in_stick(model, p.data(), slip_in(1), StickMoment{0.6, 2, kOmega});
  EXPECT_GT(beyond, 0.8e-3 * kOmega);
  EXPECT_LT(beyond, 40e-3 * kOmega);
  EXPECT_LT(creep_in_stick(model, p.data(), slip_in(1), StickMoment{-0.1, 2, kOmega}), 0);
}

TEST(Creep, OfBristlesIsTheRateOfTheSpringOverTheirStiffness) {
  const FrictionModel model = with("bristle");
  const std::vector<double> p = {0.5, 0.3, 50, 60e3, 0};
  EXPECT_NEAR(creep_in_stick(model, p.data(), slip_in(1), StickMoment{0.25, 2, kOmega}), 2 / 60e3 / 0.5, 1e-15);
  EXPECT_EQ(creep_law(model).first_part, 3u);
  EXPECT_EQ(creep_law(with("contact-spin")).inaccuracy, 0);
}

TEST(Creep, OfRigidContactsIsNil) {
  for (const char* key : {"rate-state", "frictional-lag", "runout"}) {
    const FrictionModel model = with(key);
    std::vector<double> p = {0.5, 0.3, 50};
    for (std::size_t k = 3; k < model.parameters().size(); ++k) {
      const Parameter& q = model.parameters()[k].parameter;
      p.push_back(q.start * q.si);
    }
    EXPECT_EQ(creep_in_stick(model, p.data(), slip_in(1), StickMoment{0.4, 2, kOmega}), 0) << key;
  }
}

TEST(Creep, DerivativesAreThoseOfDifferences) {
  using Dual = ceres::Jet<double, 5>;
  for (const char* key : {"contact-spin", "bristle"}) {
    const FrictionModel model = with(key);
    std::vector<double> p = {0.509, 0.318, 52.14, 1e-3};
    if (std::string(key) == "bristle") p = {0.509, 0.318, 52.14, 60e3, 1};
    const StickMoment moment{0.42, 2, kOmega};
    std::vector<Dual> dual;
    for (std::size_t k = 0; k < p.size(); ++k) dual.emplace_back(p[k], static_cast<int>(k));
    const Dual creep = creep_in_stick(model, dual.data(), slip_in(1), moment);
    for (std::size_t k = 0; k < p.size(); ++k) {
      std::vector<double> up = p, down = p;
      const double step = 1e-4 * p[k];
      up[k] += step;
      down[k] -= step;
      const double slope = (creep_in_stick(model, up.data(), slip_in(1), moment) -
                            creep_in_stick(model, down.data(), slip_in(1), moment)) /
                           (2 * step);
      const double scale = creep.a / p[k];
      EXPECT_NEAR(creep.v[static_cast<Eigen::Index>(k)] / scale, slope / scale, 1e-3) << key << " " << k;
    }
  }
}

TEST(Bristle, CreepInStickFollowsTheRampOfTheSpring) {
  // near d mu/dt / sigma0 while mu is small against mu_s
  const Bristle bristle;
  const double p[] = {36.7e3, 0};
  EXPECT_NEAR(bristle.creep(p, 0.5, 0.0, 2.0), 2.0 / 36.7e3, 1e-12);
  EXPECT_NEAR(bristle.creep(p, 0.5, 0.25, 2.0), 4.0 / 36.7e3, 1e-12);
}

}  // namespace
