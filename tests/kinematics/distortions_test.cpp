// What channels do to their readings, put upon records of known truth: found, undone, and absent where it is not there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "stick_slip_truth.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::distortions {
namespace {

constexpr double kSlower[] = {1, 30, 0.05};

truth::Rig rig_of(unsigned seed) {
  truth::Rig rig;
  rig.duration = 8;
  rig.scatter = 0.004;
  rig.seed = seed;
  return rig;
}

/// The same record as a rig `s` times slower would have made it.
Trace slowed(Trace trace, double s) {
  for (double& t : trace.time) t *= s;
  for (double& v : trace.velocity) v /= s;
  trace.conditions.speed.value /= s;
  return trace;
}

/// An RC filter, exact for straight lines between samples. tau: [samples].
void filter(std::vector<double>& x, double tau) {
  const double e = std::exp(-1 / tau), mean = tau * (1 - e);
  double y = x[0], before = x[0];
  for (double& value : x) {
    y = e * y + (1 - e) * before + (1 - mean) * (value - before);
    before = value;
    value = y;
  }
}

void add_noise(Trace& trace) {
  std::mt19937_64 random(7);
  const auto mu = truth::noise(trace.size(), 0.003, 0, random), v = truth::noise(trace.size(), 2e-5, 0, random);
  for (std::size_t i = 0; i < trace.size(); ++i) trace.friction[i] += mu[i], trace.velocity[i] += v[i];
}

/// A record without noise, which is added behind the filter.
Trace silent(unsigned seed) {
  truth::Rig rig = rig_of(seed);
  rig.friction_noise = rig.velocity_noise = 0;
  return truth::simulate(rig).trace;
}

const HealthItem& item(const Motion& motion, const std::string& check) {
  return *std::find_if(motion.health.begin(), motion.health.end(),
                       [&](const HealthItem& i) { return i.check == check; });
}

void expect_none(const Motion& motion) {
  EXPECT_FALSE(motion.velocity_zero.any()) << motion.velocity_zero.value;
  EXPECT_FALSE(motion.velocity_low_pass.any()) << motion.velocity_low_pass.value;
  EXPECT_FALSE(motion.friction_low_pass.any()) << motion.friction_low_pass.value;
  EXPECT_FALSE(motion.velocity_response.any()) << motion.velocity_response.response.part;
  EXPECT_FALSE(motion.friction_response.any()) << motion.friction_response.response.part;
  EXPECT_FALSE(motion.clock_drift.any()) << motion.clock_drift.value;
}

TEST(Distortions, ASoundRecordHasNone) {
  for (const double s : kSlower) {
    for (const unsigned seed : {3U, 4U, 5U, 6U})
      expect_none(compute_motion(slowed(truth::simulate(rig_of(seed)).trace, s)));
  }
  for (const double rpm : {1.0, 16.0, 60.0}) {
    truth::Rig rig = rig_of(3);
    rig.rpm = rpm;
    for (const double rate : {20e3, 5e3}) {
      rig.rate = rate;
      expect_none(compute_motion(truth::simulate(rig).trace));
    }
  }
}

/// A wrong radius or gain moves the plateau and not the mean.
TEST(Distortions, ARadiusOrAGainIsNoZero) {
  for (const double ratio : {0.95, 1.03}) {
    Trace radius = truth::simulate(rig_of(3)).trace, gain = radius;
    radius.conditions.radius.value *= ratio;
    for (double& v : gain.velocity) v *= ratio;
    for (Trace& trace : {std::ref(radius), std::ref(gain)}) {
      const Motion motion = compute_motion(std::move(trace));
      expect_none(motion);
      EXPECT_GT(std::abs(motion.plateau_ratio - 1), 0.02);
    }
  }
}

TEST(Distortions, AZeroIsFoundAndTakenOff) {
  for (const double s : kSlower) {
    for (const double zero : {-1e-3, -2e-4, 1e-4, 2e-4, 2e-3}) {
      for (const bool recorded : {false, true}) {  // the speed of the disc
        Trace trace = truth::simulate(rig_of(3)).trace;
        for (double& v : trace.velocity) v += zero;
        trace = slowed(std::move(trace), s);
        if (recorded) trace.disc_speed.assign(trace.size(), trace.conditions.speed.value);
        const Motion motion = compute_motion(std::move(trace));
        const Estimate& found = motion.velocity_zero;
        EXPECT_LT(std::abs(found.value - zero / s), 4 * found.std_error) << s << " " << zero << " " << recorded;
        EXPECT_LT(found.std_error, 2e-5 / s);
        EXPECT_LT(std::abs(motion.plateau_velocity), 4 * found.std_error);
        EXPECT_EQ(item(motion, "plateau-speed").status, HealthItem::Status::warning);
      }
    }
  }
}

/// Root mean square of the distance to the truth where the block slips, over the fastest.
double off(const Motion& motion, const Trace& truth) {
  const double disc = truth.conditions.speed.value * truth.conditions.radius.value;
  double squares = 0, fastest = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const double v = disc - truth.velocity[i + motion.trimmed];
    fastest = std::max(fastest, v);
    if (v < 0.1 * fastest || motion.has_fault(i, SampleFault::velocity)) continue;
    squares += std::pow(motion.relative_velocity[i] - v, 2);
    ++count;
  }
  return std::sqrt(squares / static_cast<double>(count)) / fastest;
}

TEST(Distortions, LowPassesOfFirstOrderAreFoundAndUndone) {
  const Trace sound = silent(3);
  for (const double s : kSlower) {
    for (const double corner : {100.0, 200.0, 500.0, 1000.0, 2000.0}) {
      if (s != 1 && corner != 200 && corner != 1000) continue;     // what is scale-free is so at any corner
      const double tau = 20000 / (2 * std::numbers::pi * corner);  // samples
      for (const bool both : {true, false}) {
        Trace trace = sound;
        filter(trace.velocity, tau);
        if (both) filter(trace.friction, tau);
        add_noise(trace);
        const Motion motion = compute_motion(slowed(std::move(trace), s));
        const double truth = tau * 5e-5 * s;
        const Estimate &v = motion.velocity_low_pass, &mu = motion.friction_low_pass;
        // A slow one is seen in the tail alone, which needs no motion to be known.
        EXPECT_NEAR(v.value, truth, (corner < 600 ? 0.004 : 0.02) * truth + 3 * v.std_error) << corner << " " << s;
        if (both) {
          EXPECT_NEAR(mu.value, truth, 0.02 * truth + 3 * mu.std_error) << corner << " " << s;
        } else {
          EXPECT_FALSE(mu.any()) << corner << " " << s;
        }
        EXPECT_LT(off(motion, slowed(sound, s)), 4e-3) << corner << " " << s;
        EXPECT_EQ(item(motion, "bandwidth").status, HealthItem::Status::warning);
      }
    }
  }
}

/// One that the user states is undone as stated, and is no problem then.
TEST(Distortions, AStatedLowPassIsUndone) {
  const Trace sound = silent(3);
  for (const double corner : {200.0, 500.0, 1500.0}) {
    Trace trace = sound;
    filter(trace.velocity, 20000 / (2 * std::numbers::pi * corner));
    add_noise(trace);
    Instruments lab;
    lab.vibrometer.low_pass = Declared{corner, 0};
    const Motion motion = compute_motion(std::move(trace), lab);
    EXPECT_LT(off(motion, sound), 4e-3) << corner;
    EXPECT_NE(item(motion, "bandwidth").status, HealthItem::Status::problem) << item(motion, "bandwidth").message;
    EXPECT_FALSE(motion.velocity_low_pass.any()) << "it is no finding";
  }
}

/// Behind a filter as slow as a slip nothing comes back, and that is said.
TEST(Distortions, ALowPassThatIsTooSlowIsAProblem) {
  for (const double corner : {40.0, 50.0, 60.0}) {
    Trace trace = silent(3);
    filter(trace.velocity, 20000 / (2 * std::numbers::pi * corner));
    add_noise(trace);
    const Motion motion = compute_motion(std::move(trace));
    EXPECT_FALSE(motion.velocity_low_pass.any()) << corner;
    EXPECT_EQ(item(motion, "bandwidth").status, HealthItem::Status::problem) << corner;
    EXPECT_NE(item(motion, "bandwidth").message.find("is needed"), std::string::npos)
        << item(motion, "bandwidth").message;
  }
}

TEST(Distortions, ALowPassOfFrictionAloneIsFound) {
  for (const double s : kSlower) {
    for (const double corner : {100.0, 200.0, 500.0, 1000.0, 2000.0}) {
      if (s != 1 && corner != 200 && corner != 1000) continue;
      Trace trace = silent(4);
      const double tau = 20000 / (2 * std::numbers::pi * corner), truth = tau * 5e-5 * s;
      filter(trace.friction, tau);
      add_noise(trace);
      const Motion motion = compute_motion(slowed(std::move(trace), s));
      EXPECT_FALSE(motion.velocity_low_pass.any());
      EXPECT_NEAR(motion.friction_low_pass.value, truth, 0.02 * truth + 3 * motion.friction_low_pass.std_error)
          << corner;
    }
  }
}

TEST(Distortions, NoLowPassOfFrictionIsUndoneBelowTheBandwidthThatIsDeclared) {
  Trace trace = silent(4);
  filter(trace.friction, 20000 / (2 * std::numbers::pi * 200));
  add_noise(trace);
  Instruments below, above;
  below.force_sensor.bandwidth_at_least = {100, 0};
  above.force_sensor.bandwidth_at_least = {400, 0};
  EXPECT_TRUE(compute_motion(trace, below).friction_low_pass.any());
  EXPECT_FALSE(compute_motion(trace, above).friction_low_pass.any());
}

/// Friction that is recorded early has jumped before re-stick; what noise with a memory does from there on is no
/// filter.
TEST(Distortions, EarlyFrictionWithSlowNoiseIsNotFiltered) {
  constexpr std::size_t kEarly = 10;
  const Trace sound = silent(4);
  for (const double colour : {0.9, 0.97}) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      Trace trace = sound;
      std::copy(sound.friction.begin() + kEarly, sound.friction.end(), trace.friction.begin());
      std::mt19937_64 random(seed);
      const auto mu = truth::noise(trace.size(), 0.003, colour, random),
                 v = truth::noise(trace.size(), 2e-5, colour, random);
      for (std::size_t i = 0; i < trace.size(); ++i) trace.friction[i] += mu[i], trace.velocity[i] += v[i];
      EXPECT_FALSE(compute_motion(std::move(trace)).friction_low_pass.any()) << colour << " " << seed;
    }
  }
}

TEST(Distortions, ACompressedGainIsFoundAndUndone) {
  const Trace sound = truth::simulate(rig_of(3)).trace;
  double most = 0;
  for (const double v : sound.velocity) most = std::max(most, std::abs(v));
  for (const double s : kSlower) {
    for (const double part : {0.03, 0.1, -0.1}) {
      Trace trace = sound;
      for (double& v : trace.velocity) v *= 1 - part * std::pow(v / most, 2);
      const Motion motion = compute_motion(slowed(std::move(trace), s));
      const UndoneResponse& found = motion.velocity_response;
      EXPECT_EQ(found.response.form, StaticResponse::Form::square) << part << " " << s;
      EXPECT_LT(std::abs(found.response.part - part), 3 * found.std_error) << part << " " << s;
      EXPECT_LT(off(motion, slowed(sound, s)), 5e-3) << part << " " << s;
    }
  }
}

/// The force balance tells it from a gain that falls with the speed: both leave no net displacement.
TEST(Distortions, AGainThatDiffersByDirectionIsFoundAndUndone) {
  const Trace sound = truth::simulate(rig_of(3)).trace;
  for (const double s : kSlower) {
    for (const double gain : {0.97, 0.92, 1.05}) {
      Trace trace = sound;
      for (double& v : trace.velocity) v *= v < 0 ? gain : 1;
      const Motion motion = compute_motion(slowed(std::move(trace), s));
      const UndoneResponse& found = motion.velocity_response;
      EXPECT_EQ(found.response.form, StaticResponse::Form::one_sided) << gain << " " << s;
      EXPECT_LT(std::abs(found.response.part - (1 - gain)), 3 * found.std_error) << gain << " " << s;
      EXPECT_LT(off(motion, slowed(sound, s)), 5e-3) << gain << " " << s;
    }
  }
}

/// Largest difference of friction in stick, where it is known from the spring, over the largest friction.
double friction_off(const Motion& motion, const Trace& sound) {
  double most = 0, largest = 0;
  for (std::size_t i = 0; i + 64 < sound.size(); i += 64) {
    double mean = 0, truth = 0;
    for (std::size_t k = i; k < i + 64; ++k) mean += motion.friction[k] / 64, truth += sound.friction[k] / 64;
    most = std::max(most, std::abs(mean - truth)), largest = std::max(largest, truth);
  }
  return most / largest;
}

TEST(Distortions, ABentFrictionIsFoundInStickAndUndone) {
  const Trace sound = truth::simulate(rig_of(3)).trace;
  double most = 0;
  for (const double mu : sound.friction) most = std::max(most, std::abs(mu));
  for (const double s : kSlower) {
    for (const double part : {0.03, 0.1, 0.2}) {
      Trace square = sound, linear = sound, saturated = sound;
      for (double& mu : square.friction) mu *= 1 - part * std::pow(mu / most, 2);
      for (double& mu : linear.friction) mu *= 1 - part * std::abs(mu) / most;
      const double limit = most / std::sqrt(3 * part);  // tanh x = x (1 - x^2/3 ...)
      for (double& mu : saturated.friction) mu = limit * std::tanh(mu / limit);
      for (const Trace& trace : {square, linear, saturated}) {
        const Motion motion = compute_motion(slowed(trace, s));
        EXPECT_LT(friction_off(motion, sound), 3 * motion.friction_response.std_error) << part << " " << s;
        EXPECT_LT(friction_off(motion, sound), 0.02) << part << " " << s;
        EXPECT_FALSE(motion.velocity_response.any()) << part << " " << s;
      }
      const Motion motion = compute_motion(slowed(std::move(square), s));
      EXPECT_LT(std::abs(motion.friction_response.response.part - part), 3 * motion.friction_response.std_error)
          << part << " " << s;
    }
  }
}

/// A spring that hardens bends friction the other way, and is none of its channel.
TEST(Distortions, FrictionThatRisesEverFasterInStickIsLeft) {
  Trace trace = truth::simulate(rig_of(3)).trace;
  const std::vector<double> sound = trace.friction;
  for (double& mu : trace.friction) mu *= 1 + 0.1 * std::pow(mu / 0.5, 2);
  const std::vector<double> read = trace.friction;
  const Motion motion = compute_motion(std::move(trace));
  EXPECT_FALSE(motion.friction_response.any());
  EXPECT_EQ(motion.friction, read);
}

TEST(Distortions, ClocksThatRunApartAreFoundAndUndone) {
  const Trace sound = truth::simulate(rig_of(3)).trace;
  for (const double s : kSlower) {
    for (const double drift : {5e-5, 1e-4, -2e-4, 1e-3}) {
      Trace trace = sound;
      for (std::size_t i = 0; i < trace.size(); ++i) {
        const double at = std::min(static_cast<double>(i) * (1 + drift), static_cast<double>(trace.size() - 2));
        const auto k = static_cast<std::size_t>(at);
        const double part = at - static_cast<double>(k);
        trace.velocity[i] = (1 - part) * sound.velocity[k] + part * sound.velocity[k + 1];
      }
      const Motion motion = compute_motion(slowed(std::move(trace), s));
      EXPECT_LT(std::abs(motion.clock_drift.value - drift), 4 * motion.clock_drift.std_error) << drift << " " << s;
      EXPECT_LT(motion.clock_drift.std_error, 3e-6);
      EXPECT_LT(off(motion, slowed(sound, s)), 5e-3) << drift << " " << s;
    }
  }
}

}  // namespace
}  // namespace tribofit::distortions
