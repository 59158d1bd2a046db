#pragma once

#include <cstddef>
#include <span>

#include "tribofit/fit/fit.hpp"

namespace tribofit::diagnosis {

/// A spectral line and how many independent frequencies were looked at to find it.
struct SpectralLine {
  double frequency = 0;  ///< [Hz]; 0: none
  double places = 1;
};

/// The strongest line of fixed frequency over the whole record, slip and stick: in slip in what a model leaves, in
/// stick about a parabola through each stick. Its phase runs on from one to the next, and its frequency is found more
/// finely than the record resolves, between `lowest` and `highest` [Hz]. residual: one value for each of the
/// observations, signed. Only the first record is looked at.
SpectralLine strongest_line(const Record& record, const Observations& observations, std::span<const double> residual,
                            double lowest, double highest);

/// Sensor noise [1 or N] without the strongest line that runs through the sticks, where that line is most of it.
double noise_without_line(const Record& record, double noise);

/// The strongest line whose phase starts anew at each break-away, from `lowest` [Hz] up.
SpectralLine strongest_ringing(const Observations& observations, std::span<const double> residual, double lowest);

/// Below this a ring has too few periods in a slip to be told from the shape of the law [Hz].
double lowest_ringing(const Observations& observations);

/// Samples per second of the observations, at the least [Hz].
double observation_rate(const Observations& observations);

}  // namespace tribofit::diagnosis
