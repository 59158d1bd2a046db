#pragma once

#include <Eigen/Dense>

#include "model_residuals.hpp"
#include "starts.hpp"

namespace tribofit {

/// Opens the interval of every parameter that holds all of its bounds: the data say nothing of it, or only that it
/// lies above or below a value, which its profile then says.
void open_whole_ranges(const ModelResiduals& residuals, const Bounds& bounds, const Eigen::MatrixXd& inverse_curvature,
                       Fit& fit);

/// Adds profile-likelihood 95 % intervals to a fit.
///
/// Each parameter is moved away from its best value while the others are refitted, until the sum of squares has
/// risen by as much as it would at the end of the symmetric interval if the model were linear. The scale of the rise is
/// that of the cycle-to-cycle standard error, so correlated samples do not shorten the interval; only its asymmetry is
/// new.
void add_profiles(const ModelResiduals& residuals, const Bounds& bounds, const Eigen::MatrixXd& inverse_curvature,
                  Fit& fit);

}  // namespace tribofit
