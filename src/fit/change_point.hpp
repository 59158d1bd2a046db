#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include "influence.hpp"
#include "model_residuals.hpp"
#include "starts.hpp"

namespace tribofit {

/// A parameter that is the time of a sudden change and the size that changes there, which is the parameter before it
/// (see ParameterSearch::moment_of_change).
///
/// Its likelihood is flat while nothing slides and has walls elsewhere, so no derivative leads to it or says how well
/// it is known: it is searched, and its interval is where the likelihood ratio stays below the point that holds 95 % of
/// change points.
struct ChangePoint {
  std::size_t time = 0, size = 0;  ///< indices of the parameters
};

/// The change point of a model; nothing when it has none.
std::optional<ChangePoint> change_point_of(const FrictionModel& model);

/// Time of change within its bounds that leaves least, the other parameters staying [s]; as it is where the bounds hold
/// it. residuals: over all slips of the observations.
/// Cost: an evaluation, another where the whitening did not keep the residuals at p, and some 120 of single slips,
/// which threads share.
double best_change(const ChangePoint& point, const ModelResiduals& residuals, const Observations& observations,
                   const Bounds& bounds, std::vector<double> p, int threads);

/// 95 % interval of the time of change [s], within the bounds. Squares may rise by 7.35 times the variance that the
/// cycles show for the size of the change (B. E. Hansen, Econometrica 68 (2000) 575, doi:10.1111/1468-0262.00124), so
/// coloured noise widens it.
std::pair<double, double> interval_of_change(const ChangePoint& point, const ModelResiduals& residuals,
                                             const Observations& observations, const NormalEquations& equations,
                                             const Bounds& bounds, std::vector<double> p, int threads);

}  // namespace tribofit
