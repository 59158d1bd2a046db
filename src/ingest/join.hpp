#pragma once

#include "recording.hpp"

namespace tribofit {

/// Adds the channels of a second instrument to those of the first.
///
/// The time base is that of the file with the friction; the other's channels are interpolated linearly on it, and
/// what only one of them recorded is cut off. The offset between the clocks is estimated where one file holds friction
/// and the other velocity: first from the most frequent difference between break-aways (steep falls of friction) and
/// jumps of the velocity, then refined so that friction scatters least about a function of the velocity in
/// slip. A lag or delay of friction behind velocity is not distinguishable from an offset and is absorbed
/// in it.
/// Throws InputError when both files hold the same channels, or when no offset can be found.
void join(FileRecord& run, FileRecord other);

/// Adds the channels of other rows of the same file: as above, but their clock is the same, and no offset is estimated.
void join_on_one_clock(FileRecord& run, FileRecord other);

/// How far the clock of `velocity` lags: its event at t happened at t + offset on the clock of friction [s].
struct ClockOffset {
  double offset = 0;       ///< [s]
  double uncertainty = 0;  ///< [s], from the events' scatter
  std::size_t events = 0;  ///< break-aways that were matched
  double ambiguity = 0;    ///< support of the second best offset over that of the best
};
ClockOffset estimate_clock_offset(const std::vector<double>& friction_time, const std::vector<double>& friction,
                                  const std::vector<double>& velocity_time, const std::vector<double>& velocity);

}  // namespace tribofit
