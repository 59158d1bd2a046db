#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/friction/creep.hpp"

namespace tribofit {

/// Rows that turn v_r of the parts of a stick, from the first in which the law holds, into residuals of variance
/// stick_unit^2, without what is not distinguishable from creep: see add_stick_evidence(). One matrix a record; without
/// rows where its noise is not known.
///
/// What a law of creep is wrong by is the same in every stick and does not average out: it widens the noise of one
/// stick by as many times its variance as there are sticks.
std::vector<Eigen::MatrixXd> stick_weights(const Observations& observations, const CreepLaw& law = {});

/// v_r [m/s] of the parts of a stick, from part `first` on.
Eigen::VectorXd stick_velocities(const StickCreep& stick, std::size_t first);

/// Whether v_r in stick grows as friction makes a contact creep that turns with the disc, rather than evenly with time,
/// as a high-pass on the velocity lets it sag: both lower the plateau of v_b as the stick goes on.
/// motion: with no high-pass undone; at_least: by how much the spin must fit better (chi-squared). False where the
/// noise is not known.
bool spins_rather_than_sags(const Motion& motion, const Segmentation& segmentation, double at_least);

/// Root mean square of measured minus predicted creep velocity in stick [m/s], for models that act in stick.
/// Compared over tenths of each stick, where sensor noise has averaged out. NaN where no stick is long enough.
double stick_creep_rmse(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
                        const Segmentation& segmentation);

/// What the creep of a model does not explain of the gap between v_b in stick and omega r, as a part of omega r, beyond
/// what its law of creep may be wrong by; with its standard error over sticks. NaN where no stick is long enough.
Estimate gap_beside_creep(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
                          const Segmentation& segmentation);

}  // namespace tribofit
