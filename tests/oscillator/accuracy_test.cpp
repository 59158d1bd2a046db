#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "rigs.hpp"

// How exact the simulation is, against truths that owe nothing to it.

namespace tribofit {
namespace {

constexpr double kRevolutionPerMinute = 2 * std::numbers::pi / 60;

/// Amplitude of the spring's motion: from the lowest to the highest turning point.
double peak_to_peak(const SimulatedMotion& motion) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const TurningPoint& point : motion.turning_points) {
    low = std::min(low, point.displacement);
    high = std::max(high, point.displacement);
  }
  return high - low;
}

// Coulomb friction, no damping, constant disc velocity V. Slip begins at x = mu_s N/k with x' = V. With
// u = x - mu_k N/k and D = (mu_s - mu_k) N/k: u = D cos wt + (V/w) sin wt. It ends when u' = V again:
//   -D w sin wt + V cos wt = V  =>  tan(wt/2) = -D w/V  =>  slip time (2 pi - 2 atan(D w/V))/w,
// and since u'^2 + w^2 u^2 is kept, there u = -D. So the stick after it winds the spring up by 2 D: stick time 2 D/V.
// u swings between +-sqrt(D^2 + V^2/w^2); the block is fastest against the disc at u' = -sqrt(V^2 + D^2 w^2).
TEST(Accuracy, CoulombAgreesWithTheClosedForm) {
  for (const double radius : {0.009, 0.012, 0.015, 0.018}) {
    for (const double speed : {0.2, 1.0, 4.0, 20.0, 60.0}) {
      SCOPED_TRACE(std::to_string(1e3 * radius) + " mm, " + std::to_string(speed) + " rpm");
      Case c = published_case(radius, CoulombLaw{});
      c.rig.damping = 0;
      c.drive.speed = constant_speed(speed * kRevolutionPerMinute);
      const double w = c.rig.natural_frequency(), v = radius * speed * kRevolutionPerMinute;
      const double d = (c.p[0] - c.p[1]) * c.drive.mean_load / c.rig.stiffness;
      const double stick = 2 * d / v, slip = (2 * std::numbers::pi - 2 * std::atan(d * w / v)) / w;
      const double settle = settling_time(c.rig, c.drive, c.p);
      const SimulatedMotion motion = simulate(c, {.duration = 8 * (stick + slip), .rate = 0, .settle = settle});
      ASSERT_GE(motion.slips.size(), 8U);
      for (std::size_t i = 1; i + 1 < motion.slips.size(); ++i) {
        const SimulatedSlip& s = motion.slips[i];
        EXPECT_NEAR(s.stick_time / stick, 1, 1e-8);
        EXPECT_NEAR((s.restick_time - s.break_away_time) / slip, 1, 1e-8);
        EXPECT_NEAR((motion.slips[i + 1].break_away_time - s.break_away_time) / (stick + slip), 1, 1e-8);
        EXPECT_NEAR(s.peak_speed / (v + std::hypot(v, d * w)), 1, 1e-8);
      }
      EXPECT_NEAR(peak_to_peak(motion) / (2 * std::hypot(d, v / w)), 1, 1e-8);
    }
  }
}

/// Work of friction on the block less what the damper takes, over one slip, by Simpson's rule on the samples; the ends
/// of the slip, shorter than two samples, by the trapezoid.
template <class Law>
double work_over_slip(const Case& c, const SimulatedMotion& motion, const SimulatedSlip& slip, double disc, Law&& law) {
  const auto power = [&](double velocity) {
    return (c.drive.mean_load * law(disc - velocity) - c.rig.damping * velocity) * velocity;
  };
  const auto after = std::upper_bound(motion.time.begin(), motion.time.end(), slip.break_away_time);
  const auto end = std::lower_bound(after, motion.time.end(), slip.restick_time);
  const auto first = static_cast<std::size_t>(after - motion.time.begin());
  const std::size_t last = first + 2 * ((static_cast<std::size_t>(end - after) - 1) / 2);
  const double step = 1 / motion.rate;
  double work = 0;
  for (std::size_t i = first; i < last; i += 2) {
    work += step / 3 * (power(motion.velocity[i]) + 4 * power(motion.velocity[i + 1]) + power(motion.velocity[i + 2]));
  }
  work += 0.5 * (motion.time[first] - slip.break_away_time) * (power(disc) + power(motion.velocity[first]));
  double time = motion.time[last], at_time = power(motion.velocity[last]);
  if (motion.time[last + 1] < slip.restick_time) {
    const double next = power(motion.velocity[last + 1]);
    work += 0.5 * step * (at_time + next);
    time = motion.time[last + 1];
    at_time = next;
  }
  return work + 0.5 * (slip.restick_time - time) * (at_time + power(disc));
}

/// A law that the test writes out itself.
struct NamedLaw {
  std::string name;
  Case c;
  std::function<double(double)> mu;
};

std::vector<NamedLaw> laws_with_damping() {
  const auto exponential = published_case(0.012, ExponentialLaw{});
  const auto fractional = published_case(0.018, FractionalLaw{});
  auto viscous = published_case(0.015, ExponentialLaw{});
  viscous.model = FrictionModel(ExponentialLaw{}, {Viscous{}});
  viscous.p.push_back(0.2);  // s/m
  const auto falls = [](const Case& c, double v) { return c.p[1] + (c.p[0] - c.p[1]) * std::exp(-c.p[2] * v); };
  return {{"exponential", exponential, [=](double v) { return falls(exponential, v); }},
          {"fractional", fractional,
           [=](double v) { return fractional.p[1] + (fractional.p[0] - fractional.p[1]) / (1 + fractional.p[2] * v); }},
          {"viscous", viscous, [=](double v) { return falls(viscous, v) + 0.2 * v; }}};
}

// At both ends of a slip the block moves with the disc, so what is left of the work is in the spring alone:
// k (x2^2 - x1^2)/2 = integral of (N mu - c x') x'. Its ends follow from the events: N mu_s = k x1 + c V at break-away,
// and x grows by V t_stick afterwards. Over stick and slip together: what the disc puts in, friction and damper turn
// into heat.
TEST(Accuracy, EnergyBalanceClosesInEveryCycle) {
  for (const NamedLaw& law : laws_with_damping()) {
    SCOPED_TRACE(law.name);
    const Case& c = law.c;
    const double disc = c.drive.radius * c.drive.speed.speed(0), load = c.drive.mean_load;
    const SimulatedMotion motion = simulate(c, {.duration = 3, .rate = 200000, .settle = 2});
    int checked = 0;
    for (std::size_t i = 0; i + 1 < motion.slips.size(); ++i) {
      const SimulatedSlip &slip = motion.slips[i], &next = motion.slips[i + 1];
      if (slip.break_away_time < 0) continue;
      const double x1 = (load * c.p[0] - c.rig.damping * disc) / c.rig.stiffness;
      const double x2 = x1 - disc * next.stick_time;
      const double stored = 0.5 * c.rig.stiffness * (x2 * x2 - x1 * x1);
      EXPECT_NEAR(work_over_slip(c, motion, slip, disc, law.mu) / stored, 1, 1e-8);
      ++checked;
    }
    EXPECT_GT(checked, 7);
  }
}

// With steps of one length only the order of the integrator, and of the landing on v_r = 0, decides about the error.
TEST(Accuracy, EventTimesConvergeAtTheOrderOfTheIntegrator) {
  for (const NamedLaw& law : laws_with_damping()) {
    SCOPED_TRACE(law.name);
    const auto slips = [&](double max_step, double tolerance) {
      return simulate(law.c, {.duration = 1, .rate = 0, .tolerance = tolerance, .max_step = max_step}).slips;
    };
    const auto exact = slips(1e-4, 1e-14);
    const double no_control = 1e6;
    std::vector<double> restick, break_away;
    for (const double step : {5e-4, 2.5e-4, 1.25e-4}) {
      const auto coarse = slips(step, no_control);
      restick.push_back(std::abs(coarse[0].restick_time - exact[0].restick_time));
      break_away.push_back(std::abs(coarse[1].break_away_time - exact[1].break_away_time));
    }
    // The longest step is a fortieth of the slip; the order shows as steps become short.
    for (const auto& error : {restick, break_away}) {
      EXPECT_GT(std::log2(error[0] / error[1]), 4.6);
      EXPECT_GT(std::log2(error[1] / error[2]), 4.8);
      EXPECT_LT(error[2], 1e-10);
    }
  }
}

TEST(Accuracy, PeriodErrorFollowsTheTolerance) {
  const Case c = published_case(0.015, ExponentialLaw{});
  const auto period = [&](double tolerance) {
    return mean_period(simulate(c, {.duration = 20, .rate = 0, .settle = 3, .tolerance = tolerance}));
  };
  const double exact = period(1e-13);
  EXPECT_NEAR(period(1e-6) / exact, 1, 1e-5);
  EXPECT_NEAR(period(1e-8) / exact, 1, 1e-7);
  EXPECT_NEAR(period(SimulationOptions{}.tolerance) / exact, 1, 1e-9);
}

}  // namespace
}  // namespace tribofit
