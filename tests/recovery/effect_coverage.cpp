/// Coverage of the intervals of effects where law and effects are known: what the fit itself does, without the search.
#include <utility>

#include "hidden_effects.hpp"
#include "tribofit/fit/fit.hpp"

namespace recovery {

using namespace tribofit;

namespace {

/// A record through the stages before the fit.
struct Prepared {
  Motion motion;
  Segmentation segmentation;
};

Prepared prepare(const Trace& trace) {
  Prepared out;
  out.motion = compute_motion(trace);
  out.segmentation = find_cycles(out.motion);
  return out;
}

}  // namespace

KnownFit fit_known(const Simulated& simulated) {
  std::vector<Prepared> prepared;
  for (const auto& trace : simulated.traces) prepared.push_back(prepare(*trace));
  const FrictionModel& model = simulated.model;
  std::vector<Observations> parts;
  std::vector<Record> records;
  constexpr std::size_t kValues = 1000;  // a slip, as `identify` fits effects
  for (const Prepared& p : prepared) {
    parts.push_back(observe(p.motion, p.segmentation, model.needs(), kValues));
    if (model.acts_in_stick()) {
      const double noise = estimate_floor(p.motion, p.segmentation).noise;
      add_stick_evidence(p.motion, p.segmentation, noise, parts.back());
    }
    records.push_back({&p.motion, &p.segmentation});
  }
  const Observations observations = parts.size() == 1 ? std::move(parts[0]) : join(std::move(parts));
  FitOptions options;
  options.start = simulated.truth;
  KnownFit out;
  out.truth = simulated.truth;
  out.fit = fit_model(model, records, observations, {}, options);
  return out;
}

}  // namespace recovery
