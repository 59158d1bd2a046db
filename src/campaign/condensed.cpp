#include "tribofit/campaign/condensed.hpp"

#include <algorithm>
#include <cmath>

#include "limits.hpp"

namespace tribofit {

const CondensedRun::OfFit* CondensedRun::fit(const std::string& law, const std::vector<std::string>& effects) const {
  const auto found =
      std::find_if(fits.begin(), fits.end(), [&](const OfFit& f) { return f.law == law && f.effects == effects; });
  return found == fits.end() ? nullptr : &*found;
}

namespace {

/// Mean square of what samples are off the values that are their means.
double square_within(const Motion& motion, const Observations& observations) {
  double squares = 0, count = 0;
  for (const auto& slip : observations.slips) {
    for (std::size_t i = slip.samples.begin; i < slip.samples.end; ++i) {
      if (motion.has_fault(i, SampleFault::any)) continue;
      const std::size_t value = slip.begin + (i - slip.samples.begin) / observations.samples_per_value;
      squares += std::pow(motion.friction[i] - observations.friction[value], 2);
      count += 1;
    }
  }
  return count > 0 ? squares / count : 0;
}

}  // namespace

CondensedRun condensed(const Identification& result) {
  CondensedRun out;
  out.is_points = result.motion.is_points();
  const std::size_t slips = std::max<std::size_t>(1, result.segmentation.cycles.size());
  const std::size_t values = std::clamp(kMostCondensedValues / slips, kFewestCondensedOfSlip, kMostCondensedOfSlip);
  out.observations = observe(result.motion, result.segmentation, {}, values);
  out.within = square_within(result.motion, out.observations);
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
