#include "fit_machines.hpp"

#include <utility>
#include <vector>

#include "fit/fit_laws.hpp"
#include "fit/requested_effects.hpp"
#include "tribofit/study/identified.hpp"

namespace tribofit {

namespace {

/// Fits the laws with the effects of the options and adds the best of them, with its rig.
void add_best(const IdentifyOptions& options, std::vector<Fit>& best, TwinIdentification& out) {
  Identification& trace = out.trace;
  if (trace.analysed) fit_laws(options, trace);
  if (!trace.analysed) return;
  best.push_back(trace.fits[trace.best]);
  out.rigs.push_back(rig_beside(best.back(), trace.motion, trace.segmentation, options.instruments));
  if (!out.rigs.back().determined) trace.refuse("the rig could not be identified: " + out.rigs.back().reason);
}

}  // namespace

void require_stick_slip(Identification& trace) {
  if (!trace.analysed || trace.segmentation.kind == MotionKind::stick_slip) return;
  trace.refuse(trace.segmentation.kind == MotionKind::always_sticking
                   ? "the block never slips: there is no motion to compare"
                   : "the block never sticks: there are no cycles to compare");
}

void fit_machines(const IdentifyOptions& options, TwinIdentification& out) {
  IdentifyOptions plan = options;
  plan.published_protocol = false;
  plan.effects.clear();
  std::vector<Fit> best;
  add_best(plan, best, out);
  plan.effects = options.effects;
  if (!friction_effects(options.effects).empty()) add_best(plan, best, out);
  out.trace.fits = std::move(best);
  out.trace.best = out.trace.fits.empty() ? 0 : out.trace.fits.size() - 1;
}

void compare_machines(const IdentifyOptions& options, TwinOptions more, TwinIdentification& out) {
  Identification& trace = out.trace;
  if (trace.analysed) {
    more.threads = options.threads;
    // A long record and those that are simulated beside it do not fit into memory together.
    const auto release = [&] {
      std::vector<double>().swap(trace.motion.friction);
      std::vector<double>().swap(trace.motion.relative_velocity);
    };
    out.twin = compare_twins(trace.motion, trace.segmentation, trace.fits, out.rigs, more, release);
  } else {
    out.twin.reason = trace.warnings.back();
  }
  trace.analysed = out.twin.reason.empty();
}

}  // namespace tribofit
