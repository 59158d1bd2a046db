#include "requested_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include "errors.hpp"
#include "tribofit/fit/observations.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/segmentation/strokes.hpp"

namespace tribofit {

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

/// Why a formula cannot be fitted to a trace, as a sentence. Empty where it can.
std::string trouble_with(const Formula& formula, const Motion& motion, const TracePart& part) {
  const FrictionModel model(CoulombLaw{}, {formula});
  const Observations observations = observe_motion(motion, part.segmentation, {}, model.needs());
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
            "'{}' is not finite on these data at its starting values, first at t = {} s, v_r = {} mm/s: it "
            "divides by zero, overflows or leaves its domain",
            key, general(slip.time[i], 4), general(1e3 * slip.velocity[i], 4));
      }
    }
  }
  return acts ? std::string() : fmt::format("'{}' is zero on these data for all values of its parameters", key);
}

}  // namespace

std::vector<Effect> friction_effects(std::span<const Effect> effects) {
  std::vector<Effect> out;
  std::copy_if(effects.begin(), effects.end(), std::back_inserter(out),
               [](const Effect& e) { return !is_kinematic(e); });
  return out;
}

std::vector<Effect> kinematic_effects(std::span<const Effect> effects) {
  std::vector<Effect> out;
  std::copy_if(effects.begin(), effects.end(), std::back_inserter(out), is_kinematic);
  return out;
}

MotionOptions with_corrections(MotionOptions options, std::span<const Effect> effects) {
  for (const Effect& effect : effects) {
    const PlateauCorrection correction = describe(effect).plateau_correction;
    if (correction != PlateauCorrection::none) options.plateau = correction;
  }
  return options;
}

IdentifyOptions with_declared_filter(const IdentifyOptions& options, const Motion& motion) {
  const std::optional<Declared>& declared = options.instruments.force_sensor.bandwidth;
  const bool slips = !motion.kind || motion.kind == RecordKind::stick_slip || motion.kind == RecordKind::sliding;
  if (!declared || !slips) return options;
  const Effect& filter = effect_declared_by(InstrumentValue::force_bandwidth);
  const std::string key = describe(filter).key;
  const auto is_filter = [&](const Effect& effect) { return describe(effect).key == key; };
  if (std::any_of(options.effects.begin(), options.effects.end(), is_filter)) return options;
  IdentifyOptions out = options;
  out.motion.undo_bandwidth = false;
  out.effects.push_back(filter);
  const FrictionModel model(ExponentialLaw{}, {filter});
  std::vector<double> p(model.parameters().size());
  for (std::size_t k = model.base_count(); k < p.size(); ++k) {
    const auto& slot = model.parameters()[k];
    p[k] = k == model.base_count() ? declared->value : slot.parameter.start * slot.parameter.si;
    out.fit.given.push_back({slot.full_name(), p[k], GivenParameter::Bounds{p[k], p[k]}});
  }
  double delay = 0;
  for_each_effect(model, p.data(), [&]<class E>(const E&, const double* q) {
    if constexpr (requires { E::reading_delay(q); }) delay = E::reading_delay(q);
  });
  return delay > motion.step ? out : options;
}

void require_channels(std::span<const Effect> effects, const Motion& motion, TracePart& part) {
  const Channels needs = FrictionModel(ExponentialLaw{}, {effects.begin(), effects.end()}).needs();
  const auto require = [&](bool needed, bool present, const char* channel) {
    if (!needed || present) return;
    part.refuse(std::string("an effect needs the channel '") + channel + "', which this trace does not have");
  };
  require(needs.load, !motion.load.empty(), "load");
  if (needs.force && motion.friction_kind != FrictionKind::force && motion.load.empty() &&
      !motion.conditions.load.known()) {
    part.refuse("an effect needs the normal force, which is not known: give it with --load 50N");
  }
  if (needs.time && motion.is_points())
    part.refuse("an effect needs to know what came before each sample, and points have no order in time");
  if (needs.reversal_distance && !strokes_of(motion, part.segmentation).known())
    part.refuse(fmt::format("an effect needs the distance since a reversal: {}",
                            too_few_reversals(reversals_of(part.segmentation))));
  require(needs.temperature, !motion.temperature.empty(), "temperature");
  require(needs.angle, !motion.disc_angle.empty() || motion.conditions.speed.known(), "angle");
}

void require_formulas(std::span<const Effect> effects, const Motion& motion, TracePart& part) {
  if (!part.analysed) return;
  for (const Effect& effect : effects) {
    const auto* formula = std::get_if<Formula>(&effect);
    if (formula == nullptr) continue;
    const std::string trouble = trouble_with(*formula, motion, part);
    if (!trouble.empty()) part.refuse(trouble);
  }
}

}  // namespace tribofit
