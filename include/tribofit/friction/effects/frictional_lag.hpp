#pragma once

#include "tribofit/friction/effects/channel_delay.hpp"
#include "tribofit/friction/effects/force_bandwidth.hpp"
#include "tribofit/friction/effects/rate_state.hpp"
#include "tribofit/friction/effects/sensor_inertia.hpp"

namespace tribofit {

/// Friction follows its steady value late in time: d phi/dt = (f(v) - phi)/tau.
struct FrictionalLag {
  static constexpr std::string_view key = "frictional-lag";
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "friction follows a change of speed late, by a constant time",
            .equation = "d phi/dt = (f(v) - phi)/tau, mu = phi, phi = mu_s at break-away",
            .source =
                "first-order form of D. P. Hess, A. Soom, J. Tribol. 112 (1990) 147; "
                "B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083, "
                "doi:10.1016/0005-1098(94)90209-7",
            .experiment =
                "1, 2, 4 and 8 rpm: the loop stays constant in ms; a delay of the channels also shows at re-stick",
            .parameters = {{.name = "tau",
                            .description = "time by which friction follows its steady value late",
                            .unit = "ms",
                            .si = 1e-3,
                            .lower = 0.1,
                            .upper = 10,
                            .start = 1,
                            .neutral = 0.1,
                            .bound_scaling = BoundScaling::with_slip_time,
                            .start_grid_points = 3}},
            .excitation = {.changing_speed = true},
            .sketch = {.view = SketchView::loop, .values = {2}},
            .pairs = {looks_like<ChannelDelay>(ChannelDelay::tap_the_block),
                      looks_like<ForceBandwidth>(ForceBandwidth::tap_the_block),
                      looks_like<SensorInertia>(SensorInertia::compare_jumps),
                      looks_like<RateState>("run at 1, 2, 4 and 8 rpm: the loop of mu over v_r stays constant in ms "
                                            "for a lag, in um for a memory of distance")}};
  }

  template <class T>
  Relaxation<T> relaxation(const T* p, const SlidingState<T>& /*x*/, const T& steady) const {
    return {1.0 / p[0], steady};
  }
};

}  // namespace tribofit
