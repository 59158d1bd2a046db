#pragma once

#include "recording.hpp"
#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// Adds the channels of a second instrument to those of the first.
///
/// The time base is that of the file with the friction; the other's channels are interpolated linearly on it, and
/// what only one of them recorded is cut off. `find` gives the offset between the clocks where one file holds friction
/// and the other velocity; where it finds none, or is empty, the times are taken as written, or both files to start
/// together, with a warning.
/// Throws InputError when both files hold the same channels, or do not overlap in time.
void join(FileRecord& run, FileRecord other, const ClockOffsetFinder& find);

/// Adds the channels of other rows of the same file: as above, but their clock is the same, and no offset is estimated.
void join_on_one_clock(FileRecord& run, FileRecord other);

}  // namespace tribofit
