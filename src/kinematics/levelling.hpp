#pragma once

#include <span>

#include "recording_faults.hpp"

namespace tribofit::kinematics {

/// Friction that is cut off behind noise as wide as what is cut: near the top of its range it stops rising against the
/// way of the block that its spring pulls back, which at rest is a straight line for any law, however the contact
/// creeps. count = 0 where it does not. velocity: of the block. upper: the end of the range.
PileUp find_levelling(std::span<const double> friction, std::span<const double> velocity, bool upper);

}  // namespace tribofit::kinematics
