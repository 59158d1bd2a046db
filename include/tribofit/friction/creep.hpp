#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tribofit/friction/evaluate.hpp"

namespace tribofit {

/// One moment of a stick, signed in the direction of the slip that follows.
struct StickMoment {
  double friction = 0;       ///< [1 or N]
  double friction_rate = 0;  ///< d friction/dt [1/s or N/s]
  double disc_speed = 0;     ///< omega [rad/s]
};

namespace detail {

/// Lowest v_r [m/s] at which steady friction reaches `friction`, or its peak where it never does.
///
/// first: about that speed. Found with the parameters alone; one step of Newton then carries their derivatives.
template <class T>
T speed_for(const FrictionModel& model, const T* p, const Slip& slip, double disc_speed, double friction,
            double first) {
  std::vector<double> q(model.parameters().size());
  for (std::size_t k = 0; k < q.size(); ++k) q[k] = scalar_part(p[k]);
  const LawValues<double> law = law_for(model, q.data(), slip);
  SlidingState<double> at;
  at.disc_speed = disc_speed;
  const auto excess = [&](double v) {
    at.velocity = v;
    return steady_friction(model, q.data(), law, at) - friction;
  };
  constexpr double kWidth = 1e-3;
  const double close = 1e-7 * std::max(1.0, std::abs(friction));  // friction may be a force
  const auto slope_at = [&](double v) {
    return (excess(v * (1 + kWidth)) - excess(v * (1 - kWidth))) / (2 * kWidth * v);
  };
  double v = first, slope = 0, off = 1;
  for (int i = 0; i < 6 && std::abs(off) > close; ++i) {
    off = excess(v);
    slope = slope_at(v);
    if (!(slope > 0)) break;
    v = std::clamp(v - off / slope, 0.5 * v, 2 * v);
  }
  if (!(slope > 0) || std::abs(off) > close) {
    // Near the peak: up from rest to the first speed at which friction is reached, or falls again.
    constexpr double kStep = 1.1, kFarthest = 40;
    double low = 0.1 * first, high = low;
    for (double before = -friction; high < kFarthest * first; high *= kStep) {
      const double now = excess(high);
      if (now < before) return T(low + 0.0 * p[0]);
      if (now >= 0) break;
      low = high;
      before = now;
    }
    for (int i = 0; i < 30; ++i) {
      const double middle = 0.5 * (low + high);
      (excess(middle) < 0 ? low : high) = middle;
    }
    v = 0.5 * (low + high);
    slope = slope_at(v);
    if (!(slope > 0)) return T(v + 0.0 * p[0]);
  }
  SlidingState<T> there;
  there.velocity = T(v + 0.0 * p[0]);
  there.disc_speed = disc_speed;
  return v - (steady_friction(model, p, law_for(model, p, slip), there) - friction) / slope;
}

}  // namespace detail

/// Where a model's law of creep holds, and how well.
struct CreepLaw {
  std::size_t first_part = 0;  ///< of StickCreep::parts, from which it holds
  double inaccuracy = 0;       ///< as a part of the creep
};

inline CreepLaw creep_law(const FrictionModel& model) {
  CreepLaw law;
  for (const Effect& effect : model.effects()) {
    std::visit(
        [&]<class E>(const E&) {
          if constexpr (requires { E::first_part_of_creep; }) law = {E::first_part_of_creep, E::inaccuracy_of_creep};
        },
        effect);
  }
  return law;
}

/// v_r [m/s] with which the model lets the block creep at one moment of the stick before `slip`; 0 in rigid stick.
///
/// p: parameters in SI. Motion is taken to be slow: friction is in equilibrium with the spring at each moment.
template <class T>
T creep_in_stick(const FrictionModel& model, const T* p, const Slip& slip, const StickMoment& moment) {
  const T mu_s = law_at_rest(model, law_for(model, p, slip));
  constexpr double kNearest = 0.98;  // of mu_s: beyond it the block breaks away
  T creep = T(0.0 * p[0]);
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (requires { effect.creep(q, mu_s, 0.0, 0.0); }) {
      const double friction = std::min(moment.friction, kNearest * scalar_part(mu_s));
      creep += effect.creep(q, mu_s, friction, moment.friction_rate);
    } else if constexpr (hooks::AveragesOverContact<E, T>) {
      // Constant friction in the contact gives a first value; that it falls with speed moves it by a little.
      const T first = effect.creep(q, mu_s, moment.friction, moment.friction_rate, moment.disc_speed);
      creep += moment.friction <= 0
                   ? T(-first)  // still swinging back: the contact creeps the other way
                   : detail::speed_for(model, p, slip, moment.disc_speed, moment.friction, scalar_part(first));
    }
  });
  return creep;
}

}  // namespace tribofit
