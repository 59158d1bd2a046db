#include "by_hand.hpp"

#include <algorithm>

#include "fit/assessment.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit::workbench {

Curve curve_by_hand(const std::vector<WorkbenchRung>& rungs, const WorkbenchChoice& choice,
                    const std::vector<std::pair<std::string, double>>& values) {
  constexpr std::size_t kPoints = 121;
  const auto refused = [](const std::string& why) { return InputError(why, "choose the model first"); };
  const WorkbenchRung* last = nullptr;
  for (const WorkbenchRung& rung : rungs) {
    // What is dragged is a start or a bound of the choice; the fit it is drawn from is of the same model.
    const bool alike = rung.choice.law == choice.law && rung.choice.effects == choice.effects &&
                       rung.choice.formulas == choice.formulas;
    if (alike) last = &rung;
  }
  if (last == nullptr) throw refused("this model was not fitted yet");
  Fit fit = last->fit;
  std::fill(fit.covariance.begin(), fit.covariance.end(), 0.0);  // no band about values that were set by hand
  for (const auto& [name, value] : values) {
    bool known = false;
    for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
      if (fit.model.parameters()[k].full_name() != name) continue;
      fit.parameters[k].value = value * fit.parameters[k].parameter.si;
      known = true;
    }
    if (!known) throw refused("the model has no parameter '" + name + "'");
  }
  return curve_of(fit, kPoints);
}

}  // namespace tribofit::workbench
