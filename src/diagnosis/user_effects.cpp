#include "user_effects.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <vector>

#include "tribofit/fit/observations.hpp"
#include "tribofit/friction/evaluate.hpp"

namespace tribofit::diagnosis {

namespace {

/// Starting values, the lower and the upper bounds of the parameters of a model with one effect.
std::vector<std::vector<double>> corners_of(const FrictionModel& model) {
  std::vector<std::vector<double>> corners(3);
  for (const auto& slot : model.parameters()) {
    const Parameter& q = slot.parameter;
    corners[0].push_back(q.start * q.si);
    corners[1].push_back(q.lower * q.si);
    corners[2].push_back(q.upper * q.si);
  }
  return corners;
}

/// The term of a formula at every sample of a slip.
std::vector<double> term_of(const Formula& formula, std::span<const double> p, const Slip& slip) {
  std::vector<double> term(slip.size(), 0.0);
  formula.modulate_all(p.data(), slip, slip.velocity, std::span<double>(term));
  return term;
}

}  // namespace

std::string trouble_with(const Formula& formula, const Record& record) {
  const FrictionModel model(BaseLaw::coulomb, {formula});
  const Observations observations = observe(*record.motion, *record.segmentation, model.needs());
  const std::string key = formula.info().key;
  bool acts = observations.slips.empty();
  const std::vector<std::vector<double>> corners = corners_of(model);
  for (const auto& range : observations.slips) {
    const Slip slip = observations.slip(range);
    for (const std::vector<double>& corner : corners) {
      const bool at_starts = &corner == &corners.front();
      if (acts && !at_starts) break;
      const std::vector<double> term = term_of(formula, std::span(corner).subspan(model.base_count()), slip);
      for (std::size_t i = 0; i < term.size(); ++i) {
        acts |= term[i] != 0;
        if (!at_starts || std::isfinite(term[i])) continue;
        return fmt::format(
            "'{}' is not finite on these data at its starting values, first at t = {:.4g} s, v_r = {:.4g} mm/s: it "
            "divides by zero, overflows or leaves its domain",
            key, slip.time[i], 1e3 * slip.velocity[i]);
      }
    }
  }
  return acts ? std::string()
              : fmt::format("'{}' is zero on these data whatever its parameters: it changes nothing", key);
}

}  // namespace tribofit::diagnosis
