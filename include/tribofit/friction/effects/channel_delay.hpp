#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "tribofit/friction/effects/force_bandwidth.hpp"
#include "tribofit/friction/effects/sensor_inertia.hpp"

namespace tribofit {

/// Friction is recorded later than velocity (positive) or earlier: reading(t) = mu(t - delay).
struct ChannelDelay {
  static constexpr std::string_view key = "channel-delay";
  /// Distinguishes a delay from a lag and from a memory of the contact.
  static constexpr std::string_view tap_the_block =
      "tap the resting block and compare the edges: the shift between them is the delay, for vibrometer.delay of the "
      "instruments file (negative where friction comes late); without sliding there is neither lag nor memory";

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the friction channel is recorded later (positive) or earlier than the velocity channel",
            .equation = "reading(t) = mu(t - delay)",
            .source = "latency of acquisition chains",
            .experiment =
                "tap the block and align the edges; at twice the speed a delay stays the same in ms, also at re-stick",
            .parameters = {{.name = "delay",
                            .description = "how much later than the velocity friction is recorded; negative: earlier",
                            .unit = "ms",
                            .si = 1e-3,
                            .lower = -5,
                            .upper = 5,
                            .neutral = 0,
                            .bound_scaling = BoundScaling::with_slip_time,
                            .search = ParameterSearch::jump_at_restick,
                            .start_grid_points = 4}},
            .excitation = {.changing_speed = true},
            .group = EffectGroup::measurement,
            .declared_by = InstrumentValue::vibrometer_delay,
            .sketch = {.view = SketchView::loop, .values = {2}},
            .pairs = {looks_like<ForceBandwidth>(
                          "tap the block: an edge that is shifted is a delay, for vibrometer.delay of the instruments "
                          "file (negative where friction comes late), one that is slower is a filter"),
                      looks_like<SensorInertia>(tap_the_block)}};
  }

  static double reading_delay(const double* p) { return p[0]; }

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
        const T fraction = (late - begin) / step;
        mu[i] = true_mu[n - 1] + (true_mu[n - 1] - true_mu[n - 2]) * ((late - slip.time[n - 1]) / step);
        if (scalar_part(fraction) >= 1) {
          mu[i] = slip.tail_friction + 0.0 * p[0];
        } else if (scalar_part(fraction) > 0) {
          mu[i] = (1.0 - fraction) * mu[i] + fraction * slip.tail_friction;
        }
        continue;
      }
      if (at >= slip.time[0]) {
        mu[i] = between(slip, true_mu, std::min(k, n - 2), late);
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

  /// Friction between values `low` and `low` + 1. A straight line averages noise of v_r between samples and keeps it at
  /// them, which draws a delay away from whole samples (1 ms to 1.024 ms where v_r has noise of 0.2 mm/s): within a
  /// slip, where values are samples, a cubic B-spline takes means of four that hold nearly the same noise wherever they
  /// are.
  template <class T>
  static T between(const Slip& slip, const std::vector<T>& mu, std::size_t low, const T& time) {
    const double step = slip.time[low + 1] - slip.time[low];
    const double fraction = (scalar_part(time) - slip.time[low]) / step;
    const T change = (1 / step) * (time - scalar_part(time));  // of `fraction`: zero, with its derivatives
    const bool is_spline = slip.from_stick && slip.velocity_variance.empty() && low > 0 && low + 2 < mu.size() &&
                           std::abs(slip.time[low + 2] - slip.time[low - 1] - 3 * step) < 0.1 * step;
    if (!is_spline) {
      const T rise = mu[low + 1] - mu[low];
      return mu[low] + rise * fraction + scalar_part(rise) * change;
    }
    const double rest = 1 - fraction, square = fraction * fraction, cube = square * fraction;
    const std::array<double, 4> weights = {rest * rest * rest / 6, (3 * cube - 6 * square + 4) / 6,
                                           (-3 * cube + 3 * square + 3 * fraction + 1) / 6, cube / 6};
    const std::array<double, 4> slopes = {-0.5 * rest * rest, 1.5 * square - 2 * fraction,
                                          -1.5 * square + fraction + 0.5, 0.5 * square};
    T mean = weights[0] * mu[low - 1];
    double slope = slopes[0] * scalar_part(mu[low - 1]);
    for (std::size_t k = 1; k < 4; ++k) {
      mean += weights[k] * mu[low - 1 + k];
      slope += slopes[k] * scalar_part(mu[low - 1 + k]);
    }
    return mean + slope * change;
  }

  template <class T>
  T filter_break_away_reading(const T* p, const Slip& slip, const T& level) const {
    return scalar_part(p[0]) > 0 ? T(level - p[0] * slip.stick_slope) : level;
  }
};

}  // namespace tribofit
