#pragma once

#include <cstddef>
#include <vector>

#include "force_balance.hpp"

namespace tribofit::kinematics {

/// An alignment of two clocks and how well friction balances the motion there.
struct ClockMatch {
  ClockLine clock;
  double from = 0, to = 0;  ///< of friction's clock, shared by both
  std::size_t cycles = 0;   ///< in that time
  double unbalanced = 1;    ///< part of friction that is left
  double evidence = 0;      ///< logarithm of the odds against chance
};

/// Means over bins; a bin without a sample is between its neighbours.
TimedChannel binned(const TimedChannel& channel, double width);

/// What is compared: both channels in bins of one width, and the times at which the block breaks away on the
/// velocity's clock.
struct ScannedChannels {
  double width = 0;  ///< [s]
  TimedChannel friction, velocity;
  std::vector<double> jumps;
  double period = 0;  ///< [s], of the jumps
};

/// Alignments of a stretch [from, to) of friction's bins at every offset: the best ones, best first, no two of them the
/// same. usual: what most offsets leave of friction where it goes best, a period after the other.
struct ClockScan {
  std::vector<ClockMatch> best;
  double usual = 1;
};
ClockScan scan_clocks(const ScannedChannels& channels, std::size_t from, std::size_t to);

/// Evidence of an alignment: a wrong one leaves so little with a chance that falls with every cycle, though not for
/// ever, as one that is right for a while stays so for some cycles.
double evidence_of(double unbalanced, double usual, std::size_t cycles);

}  // namespace tribofit::kinematics
