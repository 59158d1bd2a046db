#pragma once

#include <Eigen/Dense>

#include "probes.hpp"

namespace tribofit::diagnosis {

/// Fits further columns beside a trial and writes what that takes off its squares into the probe: fall, size, p_value.
/// columns: one row a value of each slip and one for its break-away; places: where else the same would have been looked
/// for. Returns their coefficients, none where the model is not finite there. Cost: one pass over the values of the
/// level.
Eigen::VectorXd judge_probe(const DiagnosisContext& context, const Level& level, const Trial& trial,
                            const ModelResiduals::FurtherColumns& columns, double places, Probe& probe);

}  // namespace tribofit::diagnosis
