#pragma once

#include <vector>

#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// Offset between the clocks of two instruments, one of which recorded friction and the other the velocity of the
/// block.
///
/// It is the offset at which friction is best balanced by the motion, N mu = m a + c v + k x, which holds for any law
/// of friction in stick and in slip, and for either sign of a channel. First every offset is compared, of means over a
/// few samples; then the time that both share is divided into parts, each with its own offset, and a straight line
/// through them gives the offset in the middle of that time and the drift of one clock against the other (to 300 ppm);
/// their scatter about the line gives the standard errors, with a part of a sample of friction, between two of which it
/// jumps. A lag or delay of friction behind velocity is not distinguishable from an offset and is absorbed in it.
///
/// An offset is taken where it leaves clearly less of friction than any other a period or more beside: the scatter of
/// break-away makes the times of slips a pattern. Throws InputError where none does, as with records of two runs, too
/// few cycles in common (seven to twelve are needed) or perfectly regular stick-slip. No events: the velocity shows
/// fewer than three slips, and there is nothing to compare. Times in s, increasing; friction and velocity in any unit.
/// Cost: n log n of the bins, and some 30 passes over at most 2e5 samples; 0.2 s for two records of 40 s at 10 kHz.
ClockOffset estimate_clock_offset(const std::vector<double>& friction_time, const std::vector<double>& friction,
                                  const std::vector<double>& velocity_time, const std::vector<double>& velocity);

}  // namespace tribofit
