#pragma once

#include <optional>
#include <vector>

#include "recording.hpp"

namespace tribofit {

/// Makes the recording's time start at 0 and increase strictly, and divides it into steps.
///
/// - Without a time column the rate gives it.
/// - A new step begins where the step column changes and where the clock restarts: goes back to where the step's clock
///   began. The clock of a restarted step continues one sampling interval after the last one's end.
/// - A gap, an interval of more than 1.5 times the median, keeps its time and begins a step too, because nothing
///   may be taken across it; a warning names it. It belongs to the same step of the recipe.
/// Throws InputError where time goes backwards or repeats otherwise, and where more than one interval in a
/// thousand (and more than 20) is a gap: such a clock is not one of samples.
void set_clock(FileRecord& recording, std::optional<double> rate);

/// The median of up to 4096 evenly spread intervals [s]; 0 for fewer than two times.
double typical_interval(const std::vector<double>& time);

}  // namespace tribofit
