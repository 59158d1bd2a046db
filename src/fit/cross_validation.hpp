#pragma once

#include <vector>

#include "errors.hpp"
#include "estimate.hpp"
#include "influence.hpp"

namespace tribofit {

/// Adds a step, within the bounds. True where it is too long for the model to be straight over it.
bool take_step(const Bounds& bounds, const std::vector<bool>& free, const Eigen::VectorXd& step,
               std::vector<double>& q);

/// Sets the held-out error of a fit: contiguous blocks of cycles are left out in turn and the rest fitted, by one
/// Gauss-Newton step from the fit of all. The step is mostly short (a fraction of a standard error), so it ends where a
/// refit would; where it is not, the rest is fitted again. Levels from extremes are those of the cycles kept.
/// free: parameters that a step may move.
void cross_validate(const FitContext& context, const Solution& solution, const NormalEquations& equations,
                    const std::vector<bool>& free, const SampleErrors& errors, Fit& fit);

}  // namespace tribofit
