#pragma once

#include <cmath>
#include <numbers>
#include <span>

#include "tribofit/friction/effects/sensor_inertia.hpp"

namespace tribofit {

/// The force channel is a second-order low-pass: y'' + 2 zeta w y' + w^2 y = w^2 mu, w = 2 pi f_0.
struct ForceBandwidth {
  static constexpr std::string_view key = "force-bandwidth";
  /// Distinguishes a filter from a lag and from a memory of the contact.
  static constexpr std::string_view tap_the_block =
      "tap the resting block: without sliding only a filter makes the edge slower; where the edge is sharp, give what "
      "it allows as force_sensor.bandwidth_at_least of the instruments file; where it is not, record with a spring "
      "four times as stiff too: slips take half as long, and a lag, a memory and a filter then part";

  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement = "the force sensor or its amplifier is too slow to follow friction",
        .equation = "y'' + 2 zeta w y' + w^2 y = w^2 mu, w = 2 pi f_0",
        .source = "second-order response of any seismic or filtered sensor",
        .experiment = "tap the block: a slower edge is a filter, a shifted edge a delay",
        .parameters =
            {{.name = "f_0",
              .description = "corner frequency of the filter",
              .unit = "Hz",
              .lower = 20,
              .upper = 10000,
              .start = 300,
              .neutral = 10000,
              .bound_scaling = BoundScaling::against_slip_time},
             {.name = "zeta", .description = "damping ratio of the filter", .lower = 0.3, .upper = 1, .start = 0.7}},
        .group = EffectGroup::measurement,
        .declared_by = InstrumentValue::force_bandwidth,
        .sketch = {.view = SketchView::loop, .values = {80, 0.7}},
        .pairs = {looks_like<SensorInertia>(SensorInertia::compare_jumps)},
        .forms = {{"first-order",
                   "one time constant, as an amplifier has; seen at re-stick, where the reading of "
                   "friction decays"}}};
  }

  /// Group delay of the filter far below its corner.
  static double reading_delay(const double* p) { return 2 * p[1] / (2 * std::numbers::pi * p[0]); }

  /// Exact for straight lines between samples: what is left of the ramp response of the filter, its state (y, y'/w),
  /// turns and shrinks by e^(-zeta w dt) over every interval.
  template <class T>
  void filter_reading(const T* p, const Slip& slip, const T& level, std::span<T> mu) const {
    using std::cos;
    using std::exp;
    using std::sin;
    using std::sqrt;
    if (mu.empty()) return;
    const T w = 2 * std::numbers::pi * p[0];
    const T zeta = scalar_part(p[1]) < 0.9999 ? p[1] : T(p[1] - (scalar_part(p[1]) - 0.9999));
    const T root = sqrt(1.0 - zeta * zeta);
    // Deviation of the filter from its answer to the present straight line u + s t: y = u + s (t - 2 zeta/w) + e.
    T e = T(0.0 * w), rate = T(0.0 * w);  // e and e'/w
    T slope = slip.from_stick ? T(slip.stick_slope + 0.0 * w) : T(0.0 * w), before = mu[0];
    double previous = slip.time[0];
    if (slip.from_stick) {
      before = level;
      previous = slip.break_away_time;
    }
    const T lag = 2.0 * zeta / w, period = 1.0 / w;
    double last_dt = 0;  // samples are mostly equally far apart, and the turn over a step is dear
    T c = T(0.0 * w), s = T(0.0 * w);
    for (std::size_t i = 0; i < mu.size(); ++i) {
      const double dt = slip.time[i] - previous;
      if (dt > 0) {
        const T now = (mu[i] - before) / dt;
        // The line bends: e jumps by what its lag changes, e' by its slope.
        e += lag * (now - slope);
        rate -= period * (now - slope);
        slope = now;
        if (std::abs(dt - last_dt) > 1e-9 * dt) {
          const T a = exp(-zeta * w * dt);
          c = a * cos(root * w * dt);
          s = a * sin(root * w * dt) / root;
          last_dt = dt;
        }
        const T next = c * e + s * (rate + zeta * e);
        rate = c * rate - s * (e + zeta * rate);
        e = next;
        previous = slip.time[i];
        before = mu[i];
      }
      mu[i] = before - lag * slope + e;
    }
  }

  /// A ramp comes out 2 zeta/w late.
  template <class T>
  T filter_break_away_reading(const T* p, const Slip& slip, const T& level) const {
    return level - 2.0 * p[1] / (2 * std::numbers::pi * p[0]) * slip.stick_slope;
  }
};

}  // namespace tribofit
