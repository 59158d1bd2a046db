#pragma once

#include "tribofit/friction/effects/bristle.hpp"
#include "tribofit/friction/effects/channel_delay.hpp"
#include "tribofit/friction/effects/force_bandwidth.hpp"
#include "tribofit/friction/effects/sensor_inertia.hpp"

namespace tribofit {

/// Friction remembers over a sliding distance: d phi/ds = (f(v) - phi)/D_c, mu = phi + a asinh(|v|/(2 v0)).
struct RateState {
  static constexpr std::string_view key = "rate-state";
  static constexpr double reference_velocity = 1e-3;  ///< v0 = 1 mm/s [m/s]

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement =
                "the contacts are renewed over a sliding distance D_c, so friction follows its steady value "
                "with a memory of that length",
            .equation = "d phi/dt = (v/D_c) (f(v) - phi), mu = phi + a asinh(v/(2 v0)), v0 = 1 mm/s",
            .source =
                "A. Ruina, J. Geophys. Res. 88 (1983) 10359, doi:10.1029/JB088iB12p10359; "
                "J. R. Rice, N. Lapusta, K. Ranjith, J. Mech. Phys. Solids 49 (2001) 1865, "
                "doi:10.1016/S0022-5096(01)00042-4",
            .experiment = "1, 2, 4 and 8 rpm: the loop closes over a constant distance, not a constant time",
            .parameters = {{.name = "D_c",
                            .description = "sliding distance over which the contacts are renewed",
                            .unit = "um",
                            .si = 1e-6,
                            .lower = 0.1,
                            .upper = 200,
                            .start = 20,
                            .neutral = 0.1,
                            .bound_scaling = BoundScaling::with_slip_length,
                            .start_grid_points = 4},
                           {.name = "a",
                            .description = "direct effect: rise of friction with the logarithm of speed, at once",
                            .lower = 0,
                            .upper = 0.02,
                            .neutral = 0,
                            .scales_with_friction = true}},
            .excitation = {.changing_speed = true},
            .sketch = {.view = SketchView::loop, .values = {100, 0}},
            .pairs = {looks_like<SensorInertia>(SensorInertia::compare_jumps),
                      looks_like<ChannelDelay>(ChannelDelay::tap_the_block),
                      looks_like<ForceBandwidth>(ForceBandwidth::tap_the_block),
                      looks_like<Bristle>(
                          "record at half the disc speed too and look at the stick: with a bristle v_r is not zero "
                          "there; or reverse the disc 5 to 50 um below break-away: an elastic return is a bristle")},
            .forms = {
                {"healing", "contacts also grow older at rest (Dieterich), so break-away grows with the stick time"}}};
  }

  template <class T>
  Relaxation<T> relaxation(const T* p, const SlidingState<T>& x, const T& steady) const {
    using std::abs;
    return {abs(x.velocity) / p[0], steady};
  }

  /// a asinh(|v|/(2 v0)): what friction does at once.
  template <class T>
  static T direct(const T* p, const SlidingState<T>& x) {
    using std::abs;
    using std::log;
    using std::sqrt;
    const T r = abs(x.velocity) / (2 * reference_velocity);
    return p[1] * log(r + sqrt(r * r + 1.0));
  }

  template <class T>
  T output(const T* p, const SlidingState<T>& x, const T& /*steady*/, const T& phi) const {
    return phi + direct(p, x);
  }
};

}  // namespace tribofit
