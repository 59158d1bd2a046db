#pragma once

#include <cstddef>
#include <vector>

#include "recording.hpp"
#include "tribofit/ingest/trace.hpp"

namespace tribofit {

/// Tables of steady points: rows of friction and sliding velocity that no clock orders.

/// Whether these columns are those of points: a friction and a sliding velocity. The velocity of a block (v_b) is one
/// only where its column is not called after the block.
bool are_columns_of_points(const Columns& columns);

/// Whether these times go back so often that no clock made them.
bool is_no_clock(const std::vector<double>& time);

/// Numbers the rows in place of a time, as one step.
void set_points(FileRecord& recording);

/// Sorts points by velocity, then by their other values: the order in the file says nothing. The checksum is that of
/// the sorted values.
void sort_points(Trace& trace);

}  // namespace tribofit
