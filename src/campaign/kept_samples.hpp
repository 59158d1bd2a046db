#pragma once

#include <string>
#include <vector>

#include "output/described.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/fit/observations.hpp"

namespace tribofit {

/// What a run keeps of its samples for a fit of all runs together: the means over a few neighbours by which laws are
/// fitted (see Observations), without channels. A megabyte in memory at the most, but for runs of thousands of slips.
struct CondensedRun {
  /// Bounds of the parameters of a joint fit [SI]; held where they are equal.
  struct OfFit {
    std::string law;
    std::vector<std::string> effects;
    std::vector<double> lower, upper;
  };
  Observations observations;
  bool is_points = false;
  double within = 0;  ///< mean square of friction about the values, over all samples [1 or N^2]
  std::vector<OfFit> fits;
};

/// Writes NAME.figures.json and NAME.condensed.json of an analysed run; of one that was not, removes them. Throws
/// WriteError.
void keep_samples(const std::string& results, const RunRecord& run, const Identification* result);

// Six digits are more than a picture shows; eight are more than any sensor has.
inline constexpr auto figure = [](auto get) { return to_digits(6, get); };
inline constexpr auto condensed_number = [](auto get) { return to_digits(8, get); };
inline constexpr auto condensed_in = [](double unit, auto get) { return in(unit, get, 8); };

constexpr auto description(const ErrorCurve*) {
  using C = ErrorCurve;
  return described("law", &C::law, "protocol", &C::protocol, "below_0.08", figure(&C::below_limit), "bins_below_0.08",
                   figure(&C::bins_below_limit), "largest_of_bins", figure(&C::largest_of_bins), "mean_relative",
                   figure(&C::mean_relative), "max_relative", figure(&C::max_relative), "fitted", figure(&C::fitted),
                   "bin_mean_relative", figure(&C::bin_mean_relative), "bin_max_relative",
                   figure(&C::bin_max_relative));
}

constexpr auto description(const Harmonic*) {
  return described("frequency_hz", figure(&Harmonic::frequency), "amplitude_mm_s", figure(&Harmonic::amplitude));
}

constexpr auto description(const RunFigures*) {
  using F = RunFigures;
  return described("bin_width_mm_s", figure(&F::bin_width), "bin_samples", &F::bin_samples, "bin_friction",
                   figure(&F::bin_friction), "errors", &F::errors, "spectrum_step_hz", figure(&F::spectrum_step),
                   "spectrum_mm_s", figure(&F::spectrum), "harmonics", &F::harmonics, "time_s", figure(&F::time),
                   "velocity_mm_s", figure(&F::velocity), "friction", figure(&F::friction));
}

constexpr auto description(const Observations::SlipObservation*) {
  using S = Observations::SlipObservation;
  return described("begin", &S::begin, "end", &S::end, "block", &S::cycle, "direction", &S::direction, "from_stick",
                   &S::from_stick, "break_away_friction", condensed_number(&S::break_away_friction),
                   "break_away_root_weight", condensed_number(&S::break_away_root_weight));
}

constexpr auto description(const RecordNoise*) {
  return described("level_scatter", condensed_number(&RecordNoise::level_scatter), "flicker",
                   condensed_number(within(&RecordNoise::flicker, &FlickerNoise::power)), "samples",
                   condensed_number(within(&RecordNoise::flicker, &FlickerNoise::samples)));
}

constexpr auto description(const Observations*) {
  using O = Observations;
  return described("flicker", condensed_number(&O::flicker), "noise", &O::noise, "mean_load_N",
                   condensed_number(&O::mean_load), "slips", &O::slips, "velocity_mm_s",
                   condensed_in(kMillimetre, &O::velocity), "friction", condensed_number(&O::friction), "weight",
                   condensed_number(&O::weight), "velocity_variance_mm2_s2",
                   condensed_in(kMillimetre * kMillimetre, &O::velocity_variance));
}

TRIBOFIT_DESCRIBED(CondensedRun::OfFit, law, effects, lower, upper);

constexpr auto description(const CondensedRun*) {
  using R = CondensedRun;
  return described("points", &R::is_points, "within", condensed_number(&R::within), "observations", &R::observations,
                   "fits", &R::fits);
}

}  // namespace tribofit
