#include "own_effects.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tribofit/fit/observations.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit::diagnosis {

void refuse_same(const std::vector<Effect>& given) {
  for (std::size_t k = 0; k < given.size(); ++k) {
    const std::string key = describe(given[k]).key;
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      if (describe(given[earlier]).key != key) continue;
      throw InputError("the effect '" + key + "' is given twice", "name each effect once");
    }
    if (!std::holds_alternative<Formula>(given[k])) continue;
    for (const Effect& known : effect_catalogue()) {
      if (describe(known).key != key) continue;
      throw InputError("the formula '" + key + "' is named as an effect of the catalogue is", "give it another name");
    }
  }
}

std::string not_finite(const Effect& effect, const Record& record) {
  const FrictionModel model(BaseLaw::coulomb, {effect});
  const Observations observations = observe(*record.motion, *record.segmentation, model.needs());
  std::vector<double> p, mu;
  for (const auto& slot : model.parameters()) p.push_back(slot.parameter.start * slot.parameter.si);
  for (const auto& range : observations.slips) {
    const Slip slip = observations.slip(range);
    mu.resize(slip.size());
    evaluate<double>(model, p.data(), slip, slip.velocity, mu);
    for (std::size_t i = 0; i < mu.size(); ++i) {
      if (std::isfinite(mu[i])) continue;
      return fmt::format(
          "'{}' is not finite on these data at its starting values, first at t = {:.4g} s, v_r = {:.4g} mm/s: it "
          "divides "
          "by zero, overflows or leaves its domain",
          describe(effect).key, slip.time[i], 1e3 * slip.velocity[i]);
    }
  }
  return {};
}

}  // namespace tribofit::diagnosis
