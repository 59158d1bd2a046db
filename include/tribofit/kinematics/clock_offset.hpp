#pragma once

#include <vector>

#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// Offset between the clocks of two instruments, one of which recorded friction and the other the velocity of the
/// block.
///
/// First the most frequent difference between break-aways (steep falls of friction) and jumps of the velocity; then the
/// offset at which friction is best balanced by the motion, N mu = m a + c v + k x, which holds for any law of friction
/// in stick and in slip. A lag or delay of friction behind velocity is not distinguishable from an offset and is
/// absorbed in it. The uncertainty is from the scatter between six parts of the record. Fewer than three events: the
/// offset could not be found. Times in s, increasing; friction and velocity in any unit.
/// Cost: the number of break-aways squared, and some 300 passes over at most 4e5 samples.
ClockOffset estimate_clock_offset(const std::vector<double>& friction_time, const std::vector<double>& friction,
                                  const std::vector<double>& velocity_time, const std::vector<double>& velocity);

}  // namespace tribofit
