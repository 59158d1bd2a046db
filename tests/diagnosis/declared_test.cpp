/// What the instruments file declares bounds what may be named.
#include "diagnosis/instrument_limits.hpp"

#include <gtest/gtest.h>

#include "tribofit/friction/effects/all.hpp"

namespace {

using namespace tribofit;
using namespace tribofit::diagnosis;

InstrumentValue declared_by(const char* key) {
  return describe(make_effect(key)).declared_by;
}

TEST(Declared, LeavesThreeOfItsUncertainties) {
  Instruments lab;
  lab.force_sensor.zero = {0.013, 0.001};
  lab.force_sensor.mass_below = {0.1, 0.005};
  lab.vibrometer.delay = {-1e-3, 2e-5};
  const auto left = [&](const char* key) {
    const auto allowed = allowed_beside_declared(lab, declared_by(key), FrictionKind::coefficient, {});
    if (allowed) {
      EXPECT_EQ(allowed->lower, -allowed->upper) << key;
    }
    return allowed ? allowed->upper : -1;
  };
  EXPECT_DOUBLE_EQ(left("sensor-offset"), 0.003);
  EXPECT_DOUBLE_EQ(left("sensor-inertia"), 0.015);
  EXPECT_DOUBLE_EQ(left("channel-delay"), 6e-5);
  EXPECT_EQ(left("crosstalk"), -1) << "not declared";
  EXPECT_EQ(left("asymmetry"), -1) << "no instrument";
}

/// A zero in N shows in a coefficient as zero/N.
TEST(Declared, AZeroInNewtonsIsTakenOverTheLoad) {
  Instruments lab;
  lab.force_sensor.zero = {0.5, 0.05};
  lab.force_sensor.zero_is_force = true;
  const Condition load = {50, "test"};
  EXPECT_DOUBLE_EQ(allowed_beside_declared(lab, declared_by("sensor-offset"), FrictionKind::coefficient, load)->upper,
                   3 * 0.05 / 50);
  EXPECT_DOUBLE_EQ(allowed_beside_declared(lab, declared_by("sensor-offset"), FrictionKind::force, load)->upper,
                   3 * 0.05);
}

TEST(Declared, AFilterIsNotSlowerThanDeclared) {
  Instruments lab;
  lab.force_sensor.bandwidth = {1000, 50};
  const auto allowed = allowed_beside_declared(lab, declared_by("force-bandwidth"), FrictionKind::coefficient, {});
  ASSERT_TRUE(allowed);
  EXPECT_FALSE(allowed->holds(300));
  EXPECT_TRUE(allowed->holds(850));
  EXPECT_TRUE(allowed->holds(2000));
}

TEST(Declared, NoFilterIsBelowABandwidthThatIsKnownToBeAtLeastSo) {
  Instruments lab;
  lab.force_sensor.bandwidth_at_least = {1000, 0};
  const auto allowed = allowed_beside_declared(lab, declared_by("force-bandwidth"), FrictionKind::coefficient, {});
  ASSERT_TRUE(allowed);
  EXPECT_FALSE(allowed->is_uncertainty) << "nothing was corrected";
  EXPECT_FALSE(allowed->holds(990));
  EXPECT_TRUE(allowed->holds(20000));
}

TEST(Declared, AKnownGainLeavesTheRadiusAndAKnownRadiusTheGain) {
  Conditions used;
  used.radius = {0.015, "command line"};
  used.speed = {0.42, "command line"};
  Instruments lab;
  EXPECT_FALSE(plateau_says(lab, used, 0.94).not_the_gain);
  EXPECT_FALSE(plateau_says(lab, used, 0.94).not_the_radius);
  lab.vibrometer.gain = {1.0, 0.002};
  EXPECT_TRUE(plateau_says(lab, used, 0.94).not_the_gain);
  EXPECT_FALSE(plateau_says(lab, used, 0.996).not_the_gain) << "within three of its uncertainties";
  lab.rig.radius = {0.015, 0.0001};
  EXPECT_FALSE(plateau_says(lab, used, 0.94).not_the_radius) << "the speed may be another";
  lab.rig.speed = {0.42, 0.001};
  EXPECT_TRUE(plateau_says(lab, used, 0.94).not_the_radius);
  used.radius.value = 0.016;
  EXPECT_FALSE(plateau_says(lab, used, 0.94).not_the_radius) << "what is declared is not what is used";
}

}  // namespace
