#pragma once

#include <span>

#include "tribofit/fit/observations.hpp"

namespace tribofit {

/// What the values reach: speeds and friction.
void set_extent(const Motion& motion, Observations& out);

/// Scales of several records: medians over the slips of all of them, the longest record.
RecordScales scales_of(std::span<const Observations> records);

}  // namespace tribofit
