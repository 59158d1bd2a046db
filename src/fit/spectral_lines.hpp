#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "tribofit/fit/fit.hpp"

namespace tribofit {

/// Spectral lines and how many independent frequencies were looked at to find them.
struct SpectralLines {
  std::vector<double> frequencies;  ///< [Hz], the strongest first
  double places = 1;
};

/// The strongest lines, three at most, of fixed frequency over the whole record, slip and stick: in slip in what a
/// model leaves, in stick about a parabola through each stick. Its phase runs on from one to the next, and its
/// frequency is found more finely than the record resolves, between `lowest` and `highest` [Hz]. residual: one value
/// for each of the observations, signed. Only the first record is looked at.
SpectralLines strongest_lines(const Record& record, const Observations& observations, std::span<const double> residual,
                              double lowest, double highest, int threads = 1);

/// The strongest lines of a record about its mean friction over speed: no model changes them, so that all fits to the
/// record share them. Several threads may ask.
class LinesOfRecord {
 public:
  /// As strongest_lines() finds them; those found last are kept.
  SpectralLines find(const Record& record, const Observations& observations, double lowest, double highest,
                     int threads);

 private:
  struct Found {
    std::size_t values = 0;  ///< of the observations
    double lowest = 0, highest = 0;
    SpectralLines lines;
  };
  std::mutex looking_;  ///< guards found_
  std::optional<Found> found_;
};

/// The strongest line that runs through the sticks, where it is most of the noise there.
struct LineInStick {
  double frequency = 0;  ///< [Hz]; 0: there is none
  double noise = 0;      ///< sensor noise without it [1 or N]
};
/// noise: with the line.
LineInStick line_in_stick(const Record& record, double noise);

/// The strongest line, if any, whose phase starts anew at each break-away, from `lowest` [Hz] up.
SpectralLines strongest_ringing(const Observations& observations, std::span<const double> residual, double lowest);

/// Below this a steady line has less than half a period in a slip: it moves slips as a whole, as slow noise does,
/// unless the sticks show it [Hz].
double lowest_steady_line(const Observations& observations);

/// Below this a ring has too few periods in a slip to be distinguished from the shape of the law [Hz].
double lowest_ringing(const Observations& observations);

/// Samples per second of the observations, at the least [Hz].
double observation_rate(const Observations& observations);

}  // namespace tribofit
