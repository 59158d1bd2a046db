#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "tribofit/friction/slip.hpp"

namespace tribofit::detail {

/// Age theta [s] of contacts that are renewed at the rate r [1/s], d theta/dt = 1 - r theta, after an interval over
/// which r goes evenly from `before` to `now`.
///
/// With A the mean of r times the interval h and d half its change, theta+ = exp(-A) theta + h I, where
/// I = integral_0^1 exp(-A x) exp(-d x (1-x)) dx. With m, b = integral_0^1 exp(-A x) {1, x (1-x)} dx it is taken as
/// m/(1 + d b/m): exact where r is constant, to second order in d elsewhere, and 1/r for long intervals.
template <class T>
T aged_over(const T& theta, double interval, const T& before, const T& now) {
  const T renewals = 0.5 * interval * (before + now);
  const T d = 0.5 * interval * (now - before);
  const double a = scalar_part(renewals), e = std::exp(-a);
  double mean, mean_slope, weighted, weighted_slope;  // slopes: derivatives in A
  constexpr double kSmall = 0.02;                     // below, the closed forms lose their digits
  if (a > kSmall) {
    mean = (1 - e) / a;
    mean_slope = (e - mean) / a;
    weighted = ((a - 2) + (a + 2) * e) / (a * a * a);
    weighted_slope = (1 - (a + 1) * e) / (a * a * a) - 3 * weighted / a;
  } else {
    mean = 1 - a * (1.0 / 2 - a * (1.0 / 6 - a * (1.0 / 24)));
    mean_slope = -1.0 / 2 + a * (1.0 / 3 - a * (1.0 / 8));
    weighted = 1.0 / 6 - a * (1.0 / 12 - a * (1.0 / 40));
    weighted_slope = -1.0 / 12 + a * (1.0 / 20);
  }
  // Each depends on A alone: one product gives it its derivatives.
  const T change = renewals - a;
  const T m = mean + mean_slope * change;
  return (e - e * change) * theta + interval * m * m / (m + d * (weighted + weighted_slope * change));
}

/// Age with which the contacts came to rest before the stick that precedes `slip` [s]; 0 where that was not recorded.
template <class E, class T>
T age_at_rest(const E& effect, const T* q, const Slip& slip) {
  const std::size_t n = slip.earlier_time.size();
  if (n == 0) return T(0.0 * q[0]);
  const auto rate = [&](std::size_t i) { return effect.contact_renewal_rate(q, std::abs(slip.earlier_velocity[i])); };
  const auto interval = [&](std::size_t i) { return slip.earlier_time[i] - slip.earlier_time[i - 1]; };
  constexpr double kForgotten = 20;  // renewals, after which exp(-20) of an age is left
  std::size_t first = n - 1;
  for (double renewals = 0; first > 0 && renewals < kForgotten; --first) {
    renewals += 0.5 * interval(first) * (scalar_part(rate(first)) + scalar_part(rate(first - 1)));
  }
  T before = rate(first);
  // All of a short slip: sticks are about as long as the one that follows.
  T theta = first > 0 && scalar_part(before) > 0 ? T(1.0 / before) : T(slip.stick_time + 0.0 * q[0]);
  for (std::size_t i = first + 1; i < n; ++i) {
    const T now = rate(i);
    theta = aged_over(theta, interval(i), before, now);
    before = now;
  }
  const double rest = slip.earlier_restick_time - slip.earlier_time[n - 1];
  return rest > 0 ? aged_over(theta, rest, before, T(0.0 * before)) : theta;
}

/// Age of the contacts at the break-away that begins `slip`: the time at rest and what was left before it [s].
template <class E, class T>
T age_at_break_away(const E& effect, const T* q, const Slip& slip) {
  constexpr double kUnknown = 1e3;  // s: no stick time was recorded; contacts that have rested for long
  if (std::isnan(slip.stick_time)) return T(kUnknown + 0.0 * q[0]);
  return slip.stick_time + age_at_rest(effect, q, slip);
}

/// Speed at which the law is taken at every sample of a slip [m/s]. Contacts that did not rest before it begin in
/// steady sliding.
template <class E, class T>
void equivalent_speeds(const E& effect, const T* q, const Slip& slip, std::span<const T> velocity, std::span<T> speed) {
  if (slip.size() == 0) return;
  constexpr double kSlowest = 1e-3;  // 1/s, for a slip that begins at v_r = 0 without a stick
  T before = effect.contact_renewal_rate(q, slip.speed(velocity[0])), theta;
  double previous = slip.time[0];
  if (slip.from_stick) {
    before = T(0.0 * before);
    theta = age_at_break_away(effect, q, slip);
    previous = slip.break_away_time;
  } else {
    theta = 1.0 / (scalar_part(before) > kSlowest ? before : T(kSlowest + 0.0 * before));
  }
  for (std::size_t i = 0; i < slip.size(); ++i) {
    const T now = effect.contact_renewal_rate(q, slip.speed(velocity[i]));
    const double interval = slip.time[i] - previous;
    if (interval > 0) theta = aged_over(theta, interval, before, now);
    previous = slip.time[i];
    before = now;
    speed[i] = effect.equivalent_speed(q, theta);
  }
}

}  // namespace tribofit::detail
