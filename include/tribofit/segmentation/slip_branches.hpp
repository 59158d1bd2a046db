#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"
#include "tribofit/statistics/bins.hpp"

namespace tribofit {

/// A part of a slip in which the speed only rises or only falls; both where the block never sticks.
enum class Branch { accelerating, decelerating, both };

struct SlipBranch {
  Branch branch = Branch::both;
  SampleRange samples;
  int direction = 1;  ///< of sliding
};

/// The slips that are selected for fits, cut at their fastest samples. Where the block never sticks there are no
/// cycles: the record is cut into (at least, where it has so many samples) `pieces` stretches instead, which stand for
/// them.
std::vector<SlipBranch> slip_branches(const Motion& motion, const Segmentation& segmentation, std::size_t pieces = 20);

/// Largest |v_r| of these branches [m/s]; 0 where there are none.
double fastest_of(const Motion& motion, const std::vector<SlipBranch>& branches);

/// A value of each sample, in the direction of sliding, over |v_r| [m/s]: a band over cycles in `bins` bins for each
/// branch that there is.
struct BranchBand {
  Branch branch;
  CycleBand band;
};
std::vector<BranchBand> bands_over_speed(const Motion& motion, const std::vector<SlipBranch>& branches,
                                         std::span<const double> values, std::size_t bins);

/// The first number up to `last` that will do, as near to its half as they come.
template <class WillDo>
std::optional<std::size_t> nearest_to_middle(std::size_t last, const WillDo& will_do) {
  const std::size_t middle = last / 2;
  for (std::size_t off = 0; off <= last; ++off) {
    if (middle + off <= last && will_do(middle + off)) return middle + off;
    if (off <= middle && will_do(middle - off)) return middle - off;
  }
  return std::nullopt;
}

/// The first of `count` cycles in a row that are whole and selected, as near to the middle of the record as they come;
/// else the middle ones. There are at least `count` cycles.
std::size_t whole_cycles_near_middle(const Segmentation& segmentation, std::size_t count);

}  // namespace tribofit
