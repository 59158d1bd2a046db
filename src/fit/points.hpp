#pragma once

#include <span>
#include <vector>

#include "cycle_evidence.hpp"
#include "tribofit/fit/fit.hpp"

// What is different where the data are steady points: they are independent, and each has its own weight.

namespace tribofit {

/// All of these records are points.
bool are_points(std::span<const Record> records);

/// Points with standard errors weigh against their squares, by one on average.
void weigh_points(const Motion& motion, Observations& observations);

/// Standard deviation of friction of a point [1 or N]: of one with weight 1 where standard errors are stated, else what
/// neighbours in speed differ by beyond a straight line (T. Gasser, L. Sroka, C. Jennen-Steinmetz, Biometrika 73 (1986)
/// 625, doi:10.1093/biomet/73.3.625), over speed or over the order of speeds, whichever is straighter. 0 for fewer than
/// three points in a direction.
SensorNoise noise_of_points(const Motion& motion, const Segmentation& segmentation);

/// Errors of the parameters from the scatter between points. Their variance may differ from point to point: HC2, which
/// divides each squared residual by one less its leverage (J. G. MacKinnon, H. White, J. Econometrics 29 (1985) 305,
/// doi:10.1016/0304-4076(85)90158-7), with the degrees of freedom of R. M. Bell, D. F. McCaffrey, Survey Methodology 28
/// (2002) 169. A parameter that hangs on few points takes one variance for all, s^2 (J'J)^-1 with n - p degrees of
/// freedom. squares: of the weighed residuals. Each cycle of the evidence is a point.
Spread spread_of_points(const CycleEvidence& evidence, double squares, const std::vector<bool>& free);

}  // namespace tribofit
