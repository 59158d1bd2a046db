#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recording.hpp"

namespace tribofit {

/// When rows were recorded, where no column holds their time.
struct Sampling {
  double start = 0;      ///< [s] of the first row
  double rate = 0;       ///< [Hz]; 0: the interval is given instead
  double interval = 0;   ///< [s]
  bool by_user = false;  ///< stated with --rate, else by the file
  std::string source;    ///< for the note: "the sampling rate of 1000 Hz"
};

/// The sampling of a set of rows: what the user says, else what the file states of these rows, else a fact of the
/// file that is named as a rate or an interval (fs, dt, "Sampling rate"). Nothing when none is stated.
std::optional<Sampling> stated_sampling(const RawTable& table, std::size_t rows, std::optional<double> rate);

/// Gives the rows their time where no column holds it. Throws InputError for a sampling that is not possible.
void set_time(FileRecord& recording, const Sampling& sampling);

/// Makes the recording's time start at 0 and increase strictly, and divides it into steps.
///
/// - A new step begins where the file sets one apart, where the step column changes and where the clock restarts: goes
///   back to where the step's clock began. The clock of a restarted step continues one sampling interval after the
///   last one's end.
/// - A gap, an interval of more than 1.5 times the median, keeps its time and begins a step too, because nothing
///   may be taken across it; a warning names it. It belongs to the same step of the recipe.
/// Throws InputError where time goes backwards or repeats otherwise, and where more than one interval in a
/// thousand (and more than 20) is a gap: such a clock is not one of samples.
void set_clock(FileRecord& recording, const std::optional<Sampling>& sampling, int threads);

/// The median of up to 4096 evenly spread intervals [s]; 0 for fewer than two times.
double typical_interval(const std::vector<double>& time);

}  // namespace tribofit
