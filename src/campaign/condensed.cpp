#include "tribofit/campaign/condensed.hpp"

#include <algorithm>

#include "limits.hpp"

namespace tribofit {

const CondensedRun::OfFit* CondensedRun::fit(const std::string& law, const std::vector<std::string>& effects) const {
  const auto found =
      std::find_if(fits.begin(), fits.end(), [&](const OfFit& f) { return f.law == law && f.effects == effects; });
  return found == fits.end() ? nullptr : &*found;
}

CondensedRun condensed(const Identification& result) {
  CondensedRun out;
  out.is_points = result.motion.is_points();
  const std::size_t slips = std::max<std::size_t>(1, result.segmentation.cycles.size());
  const std::size_t values = std::clamp(kMostCondensedValues / slips, kFewestCondensedOfSlip, kMostCondensedOfSlip);
  out.observations = observe(result.motion, result.segmentation, {}, values);
  for (const Fit& fit : result.fits) {
    if (fit.protocol != Protocol::joint || fit.parameters.empty()) continue;
    CondensedRun::OfFit& of_fit = out.fits.emplace_back();
    of_fit.law = to_string(fit.model.law());
    of_fit.effects = fit.model.effect_keys();
    for (const FitParameter& p : fit.parameters) {
      of_fit.lower.push_back(p.parameter.lower * p.parameter.si);
      of_fit.upper.push_back(p.parameter.upper * p.parameter.si);
    }
  }
  return out;
}

}  // namespace tribofit
