#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/ingest/trace.hpp"

namespace tribofit::kinematics {

/// A slower channel in a faster record: each value is repeated until the next.
struct Hold {
  std::size_t samples = 1;  ///< that hold one value
  std::size_t first = 0;    ///< sample from which the first whole one is held
};

/// samples = 1 where values change at any sample, as those of a coarse converter do.
Hold find_hold(std::span<const double> channel);

/// Leaves the first sample of every held value: the others are late by up to samples - 1. Says so in the notes.
void keep_fresh_values(Trace& trace, std::vector<std::string>& notes);

}  // namespace tribofit::kinematics
