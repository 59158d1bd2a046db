#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction is recorded later than velocity (positive) or earlier: reading(t) = mu(t - delay).
struct ChannelDelay {
  static EffectInfo info() {
    return {.key = "channel-delay",
            .statement = "the friction channel is recorded later (positive) or earlier than the velocity channel",
            .equation = "reading(t) = mu(t - delay)",
            .source = "latency of acquisition chains",
            .experiment =
                "tap the block and align the edges; at twice the speed a delay stays the same in ms, also at re-stick",
            .parameters = {{"delay", "ms", 1e-3, -5, 5, 0, 0, false, false, 4}},
            .group = EffectGroup::measurement};
  }

  /// Before break-away friction is the spring's straight line; after re-stick it is what was read there.
  template <class T>
  void filter_reading(const T* p, const Slip& slip, const T& level, std::span<T> mu) const {
    const std::size_t n = mu.size();
    if (n < 2) return;
    const std::vector<T> true_mu(mu.begin(), mu.end());
    const double delay = scalar_part(p[0]);
    std::size_t k = 0;  // true_mu[k] is the last at or before the time looked for
    for (std::size_t i = 0; i < n; ++i) {
      const double at = slip.time[i] - delay;
      while (k + 1 < n && slip.time[k + 1] <= at) ++k;
      while (k > 0 && slip.time[k] > at) --k;
      const T late = slip.time[i] - p[0];
      if (at > slip.time[n - 1] && std::isfinite(slip.tail_friction)) {
        // Friction goes on as it was and jumps at re-stick, which samples show as a ramp over one interval; where the
        // time of re-stick is not known, within the sample after the last of the slip.
        const double step = slip.time[n - 1] - slip.time[n - 2];
        const double known = slip.restick_time - 0.5 * step;
        const double begin = known > slip.time[n - 1] ? known : slip.time[n - 1];  // NaN: not known
        const T part = (late - begin) / step;
        mu[i] = true_mu[n - 1] + (true_mu[n - 1] - true_mu[n - 2]) * ((late - slip.time[n - 1]) / step);
        if (scalar_part(part) >= 1) {
          mu[i] = slip.tail_friction + 0.0 * p[0];
        } else if (scalar_part(part) > 0) {
          mu[i] = (1.0 - part) * mu[i] + part * slip.tail_friction;
        }
        continue;
      }
      if (at >= slip.time[0]) {
        const std::size_t low = std::min(k, n - 2);
        const T slope = (true_mu[low + 1] - true_mu[low]) / (slip.time[low + 1] - slip.time[low]);
        mu[i] = true_mu[low] + slope * (late - slip.time[low]);
      } else if (!slip.from_stick) {
        mu[i] = true_mu[0];
      } else if (at > slip.break_away_time) {
        const T slope = (true_mu[0] - level) / (slip.time[0] - slip.break_away_time);
        mu[i] = level + slope * (late - slip.break_away_time);
      } else {
        mu[i] = level + slip.stick_slope * (late - slip.break_away_time);
      }
    }
  }

  template <class T>
  T filter_break_away_reading(const T* p, const Slip& slip, const T& level) const {
    return scalar_part(p[0]) > 0 ? T(level - p[0] * slip.stick_slope) : level;
  }
};

}  // namespace tribofit
