#pragma once

#include <cmath>

#include "tribofit/friction/effects/rate_state.hpp"

namespace tribofit {

/// Break-away grows with the time in stick: mu_s + B ln(1 + t_stick/tau_a), erased by slip.
struct Ageing {
  static constexpr std::string_view key = "ageing";
  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement = "contacts grow stronger while they rest, so break-away is higher after a longer stick",
        .equation = "mu_s(t_stick) = mu_s + B ln(1 + t_stick/tau_a)",
        .source = "J. H. Dieterich, J. Geophys. Res. 77 (1972) 3690, doi:10.1029/JB077i020p03690",
        .experiment = "slide, hold, slide with holds of 1, 10, 100 and 1000 s; or four disc speeds",
        .parameters = {{.name = "B",
                        .description = "rise of static friction with the logarithm of the stick time",
                        .lower = 0.002,
                        .upper = 0.1,
                        .start = 0.005,
                        .neutral = 0.002,
                        .scales_with_friction = true},
                       {.name = "tau_a",
                        .description = "stick time from which on contacts grow stronger",
                        .unit = "s",
                        .lower = 0.001,
                        .upper = 10,
                        .start = 0.1,
                        .neutral = 0.1,
                        .bound_scaling = BoundScaling::with_stick_time,
                        .start_grid_points = 3,
                        .within_record = true}},
        .needs = {.stick_time = true},
        .sketch = {.view = SketchView::stick_time, .values = {0.02, 0.1}},
        .pairs = {looks_like<RateState>("slide, hold, slide with a dozen holds from 0.3 to 6 s, or of 1, 10, 100 and "
                                        "1000 s: only ageing raises break-away with the logarithm of the hold")}};
  }

  template <class T>
  void adjust(const T* p, const Slip& slip, LawValues<T>& law) const {
    using std::log;
    if (slip.stick_time > 0) law.raise_break_away(p[0] * log(1.0 + slip.stick_time / p[1]));  // NaN: not recorded
  }
};

}  // namespace tribofit
