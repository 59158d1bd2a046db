#pragma once

#include <optional>
#include <vector>

#include "change_point.hpp"
#include "fit_context.hpp"

namespace tribofit {

/// Takes p, where a search on fewer values ended, to where all values of the context lead: Gauss-Newton steps within
/// the bounds, each with the scatter of break-away seen anew, until one moves no parameter by more than kLastStep of
/// its standard error, as independent noise would make it. So the parameters are those of all values, whatever the
/// search saw. Sets the whitening of the context; the time of a change is held in `held`.
///
/// false: the steps do not get shorter, or the model is not finite; p is as it was. Cost: two evaluations a step.
bool refine(FitContext& context, const std::optional<ChangePoint>& change, Bounds& held, std::vector<double>& p);

/// The same for a look: one such step, where it leads no further from the data. Sets the whitening of the context to
/// that at the p given. Returns the residuals of all slips with it.
ModelResiduals refine_look(FitContext& context, const std::optional<ChangePoint>& change, Bounds& held,
                           std::vector<double>& p);

/// Moves the time of the change in p to where it leaves least, with the whitening of the context, and holds it there.
/// The residuals that the whitening kept are used up.
void find_change(FitContext& context, const ChangePoint& change, Bounds& held, std::vector<double>& p);

}  // namespace tribofit
