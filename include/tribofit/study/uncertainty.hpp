#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "tribofit/oscillator/machine.hpp"
#include "tribofit/statistics/estimate.hpp"

namespace tribofit {

/// What is known of the numbers of an identified machine.
struct MachineCovariance {
  std::vector<double> friction;  ///< of its parameters, row by row (Fit::covariance); empty: taken as exact
  std::vector<double> rig;       ///< of mass, damping, stiffness, row by row [SI]; empty: taken as exact
  bool empty() const { return friction.empty() && rig.empty(); }
};

/// Machines that the data would have given as well: normal draws from both covariances, which are taken to be
/// independent (friction is fitted over slip from speeds, the rig from forces over everything). Draws that cannot be
/// (a negative mass, mu_s or decay factor) are drawn again. The same seed gives the same machines.
std::vector<Machine> draws_of(const Machine& machine, const MachineCovariance& covariance, std::size_t count,
                              std::uint64_t seed = 1);

/// 2.5 % and 97.5 % quantile of the values that are not NaN, in their unit. Both ends are NaN where there are none or
/// more than a tenth of `values` is NaN.
Interval interval95_of(std::vector<double> values);

}  // namespace tribofit
