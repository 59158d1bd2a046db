#pragma once

#include <span>

#include "range_crowds.hpp"

namespace tribofit::kinematics {

/// Friction that is cut off behind noise as wide as what is cut: near the top of its range it stops rising against the
/// way of the block that its spring pulls back, which at rest is a straight line for any law, however the contact
/// creeps. count = 0 where it does not. velocity: of the block. upper: the end of the range.
PileUp find_levelling(const ChannelOutline& friction, std::span<const double> velocity, bool upper);

}  // namespace tribofit::kinematics
