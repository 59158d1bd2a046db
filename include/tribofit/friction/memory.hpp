#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "tribofit/friction/hooks.hpp"
#include "tribofit/friction/slip.hpp"

namespace tribofit::detail {

/// Carries one memory through a slip, in place: steady[i] becomes the friction after the memory.
///
/// Over each interval the exponent A (the mean rate times the interval) and a target linear in A give the exact
/// solution phi+ = e phi + (1-e) g0 + (1 - (1-e)/A) (g1 - g0), e = exp(-A). steady_at(instant): friction before any
/// memory, for samples of the lead.
template <class E, class T, class Steady>
void remember(const E& effect, const T* q, const Slip& slip, const T& at_rest, const Steady& steady_at,
              std::span<const T> velocity, std::span<T> steady) {
  using std::exp;
  if (slip.size() == 0) return;
  constexpr bool in_stick = hooks::ActsInStick<E>;
  const bool begins_at_rest = slip.from_stick && !in_stick;
  Relaxation<T> before = effect.relaxation(q, slip.at(0, velocity[0]), steady[0]);
  T phi = before.target;
  double previous = slip.time[0];
  if (begins_at_rest) {
    phi = at_rest;
    previous = slip.break_away_time;
    before = effect.relaxation(q, slip.at(0, T(0.0 * velocity[0])), at_rest);
  }
  const auto advance = [&](double time, const Relaxation<T>& now) {
    const double interval = time - previous;
    if (interval > 0) {
      const T a = 0.5 * interval * (before.rate + now.rate);
      const T e = exp(-a);
      // (1-e)/A loses its digits for small A, where it is 1 - A/2.
      const T mean = scalar_part(a) > 1e-5 ? T((1.0 - e) / a) : T(1.0 - 0.5 * a);
      phi = e * phi + (1.0 - e) * before.target + (1.0 - mean) * (now.target - before.target);
    }
    previous = time;
    before = now;
  };
  if (in_stick && !slip.lead_time.empty()) {
    SlidingState<T> at = slip.at(0, T(0.0 * velocity[0]));
    for (std::size_t i = 0; i < slip.lead_time.size(); ++i) {
      at.velocity = T(slip.lead_velocity[i] + 0.0 * velocity[0]);
      at.direction = slip.lead_velocity[i] < 0 ? -1 : 1;
      const Relaxation<T> now = effect.relaxation(q, at, steady_at(at));
      if (i == 0) {
        phi = std::isfinite(slip.lead_friction) ? T(slip.lead_friction + 0.0 * velocity[0]) : now.target;
        previous = slip.lead_time[0];
        before = now;
      }
      advance(slip.lead_time[i], now);
    }
  }
  for (std::size_t i = 0; i < slip.size(); ++i) {
    const SlidingState<T> at = slip.at(i, velocity[i]);
    advance(slip.time[i], effect.relaxation(q, at, steady[i]));
    if constexpr (hooks::Outputs<E, T>) {
      steady[i] = effect.output(q, at, steady[i], phi);
    } else {
      steady[i] = phi;
    }
  }
}

}  // namespace tribofit::detail
