#include "kinematic_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "candidates.hpp"
#include "instrument_limits.hpp"
#include "limits.hpp"
#include "tribofit/friction/effect_pairs.hpp"
#include "tribofit/segmentation/load_coupling.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit::diagnosis {
namespace {

/// The effect that stands for a correction of the plateau; empty for none.
std::string key_of(PlateauCorrection correction) {
  for (const Effect& effect : effect_catalogue()) {
    const EffectInfo info = describe(effect);
    if (correction != PlateauCorrection::none && info.plateau_correction == correction) return info.key;
  }
  return {};
}

/// The effect stands for a gap between the plateau and omega r.
bool is_of_plateau(const std::string& key) {
  return !key.empty() && (key == key_of(PlateauCorrection::radius) || key == key_of(PlateauCorrection::gain));
}

constexpr double kNotFitted = std::numeric_limits<double>::quiet_NaN();

FoundBeforeFit found_before_fit(const Effect& effect, const Motion& motion, const Estimate& load_coupling) {
  return std::visit(
      [&]<class E>(const E&) -> FoundBeforeFit {
        if constexpr (requires { E::found_before_fit(motion, load_coupling); }) {
          return E::found_before_fit(motion, load_coupling);
        }
        return {};
      },
      effect);
}

EffectFinding finding_of(const EffectInfo& info, const FoundBeforeFit& found) {
  EffectFinding finding;
  finding.key = info.key;
  finding.status = EffectStatus::found;
  finding.held_out_rmse = finding.error_reduction = kNotFitted;
  finding.p_value = 0;
  for (std::size_t k = 0; k < info.parameters.size(); ++k) {
    FitParameter parameter;
    parameter.parameter = info.parameters[k];
    parameter.effect = info.key;
    parameter.value = found.values[k].value;
    parameter.std_error = found.values[k].std_error;
    parameter.lower95 = parameter.value - kNormalQuantile95 * parameter.std_error;
    parameter.upper95 = parameter.value + kNormalQuantile95 * parameter.std_error;
    parameter.profile_lower95 = parameter.profile_upper95 = kNotFitted;
    finding.parameters.push_back(parameter);
  }
  finding.reason = found.reason;
  return finding;
}

/// The effect that was corrected for a gap of the plateau has its name; the other one of the two fits as well, unless
/// the instruments file rules it out.
void share_plateau(const Motion& motion, const Instruments& instruments, const EffectInfo& other,
                   const std::string& corrected, EffectFinding& finding) {
  const bool known =
      plateau_says(instruments, motion.conditions, motion.corrected_ratio).rules_out(other.plateau_correction);
  finding.status = known ? EffectStatus::not_supported : EffectStatus::equivalent;
  finding.reason =
      known ? "the instruments file leaves no room for it" : "with these data not distinguishable from " + corrected;
}

/// The catalogue, each effect with its forms.
std::vector<Effect> effects_and_forms() {
  std::vector<Effect> out;
  for (const Effect& effect : effect_catalogue()) {
    out.push_back(effect);
    const EffectInfo info = describe(effect);
    for (const EffectForm& form : info.forms) out.push_back(make_effect(info.key + ":" + form.name));
  }
  return out;
}

/// What was found in the motion and in the load channel, and undone, as effects: those of the motion first.
std::vector<EffectFinding> motion_findings(const Motion& motion, const Estimate& load_coupling,
                                           const Instruments& instruments) {
  std::vector<EffectFinding> out;
  for (const bool kinematic : {true, false}) {
    for (const Effect& effect : effects_and_forms()) {
      if (is_kinematic(effect) != kinematic) continue;
      const FoundBeforeFit found = found_before_fit(effect, motion, load_coupling);
      if (found.values.empty()) continue;
      const EffectInfo info = describe(effect);
      out.push_back(finding_of(info, found));
      const bool of_plateau = info.plateau_correction != PlateauCorrection::none;
      if (!of_plateau || info.plateau_correction == motion.plateau_correction) continue;
      share_plateau(motion, instruments, info, key_of(motion.plateau_correction), out.back());
    }
  }
  return out;
}

/// Why no record can show an effect of the motion; empty where they can.
std::string obstacle(const EffectInfo& info, std::span<const Record> records) {
  const auto any = [&](auto has) { return std::any_of(records.begin(), records.end(), has); };
  const bool sticks = any([](const Record& r) { return r.motion->sticks; });
  const bool measured = any([](const Record& r) { return r.motion->velocity_kind == VelocityKind::block; });
  if (!sticks || !measured) return "there is no plateau of stick in v_b";
  const bool stated = any([](const Record& r) { return std::isfinite(r.motion->plateau_ratio); });
  if (info.excitation.stated_plateau && !stated) {
    return "there is no stated speed and radius to compare the plateau with";
  }
  const Motion& motion = *records[0].motion;
  if (info.excitation.stated_disc_speed && !motion.disc_speed.empty()) {
    return "the disc speed was recorded: it is used as it is";
  }
  const Condition& speed = motion.conditions.speed;
  const double turns = speed.known() ? speed.value * motion.duration() / (2 * std::numbers::pi) : 0;
  return turns < info.excitation.revolutions ? too_few_revolutions(turns, info) : std::string();
}

/// An effect of the motion that was not found.
EffectFinding not_found(const EffectInfo& info, std::span<const Record> records) {
  EffectFinding finding;
  finding.key = info.key;
  finding.held_out_rmse = finding.error_reduction = finding.p_value = kNotFitted;
  finding.status = EffectStatus::not_supported;
  finding.reason = info.needs.plateau ? "the plateau of stick does not show it" : "re-stick does not show it";
  if (const std::string why = obstacle(info, records); !why.empty()) {
    finding.status = EffectStatus::untestable;
    finding.reason = why;
  }
  return finding;
}

/// Every effect of the catalogue in its order, then the user's own: as found before the fit, as an effect of the motion
/// that was not found, or as the ladder has it.
std::vector<EffectFinding> merged(const std::vector<EffectFinding>& found, std::span<const Record> records,
                                  const std::vector<EffectFinding>& of_ladder) {
  std::vector<EffectFinding> out;
  const auto find = [](const std::vector<EffectFinding>& list, const std::string& key) {
    return std::find_if(list.begin(), list.end(), [&](const EffectFinding& f) { return f.key == key; });
  };
  for (const Effect& effect : effect_catalogue()) {
    const EffectInfo info = describe(effect);
    const auto before = find(found, info.key), at = find(of_ladder, info.key);
    if (before != found.end()) {
      out.push_back(*before);
    } else if (info.kinematic_effect) {
      out.push_back(not_found(info, records));
    } else if (at != of_ladder.end()) {
      out.push_back(*at);
    }
  }
  for (const EffectFinding& finding : of_ladder) {
    if (find(out, finding.key) == out.end()) out.push_back(finding);
  }
  return out;
}

/// A rung for each effect found before the fit, above the base law and below all others.
std::vector<Rung> rungs_before_fit(const std::vector<EffectFinding>& found, const std::optional<Fit>& uncorrected,
                                   const Rung& base) {
  std::vector<Rung> rungs = {base};
  if (uncorrected) {
    rungs[0].rmse = uncorrected->error.rmse;
    rungs[0].held_out_rmse = uncorrected->error.held_out_rmse;
    rungs[0].held_out_std_error = held_out_std_error(*uncorrected);
  }
  for (const EffectFinding& finding : found) {
    if (finding.status != EffectStatus::found) continue;
    Rung rung = base;
    rung.added = finding.key;
    for (const EffectFinding& other : found) {
      if (other.status == EffectStatus::equivalent && is_of_plateau(finding.key)) rung.equivalent.push_back(other.key);
    }
    rungs.push_back(rung);
  }
  return rungs;
}

/// Puts the experiment that distinguishes the two effects of a plateau in front of the other experiments.
void add_plateau_experiment(Diagnosis& diagnosis) {
  const auto shared = std::find_if(diagnosis.ladder.begin(), diagnosis.ladder.end(), [](const Rung& rung) {
    return !rung.equivalent.empty() && is_of_plateau(rung.added);
  });
  if (shared == diagnosis.ladder.end()) return;
  const std::string& other = shared->equivalent.front();
  const std::string test =
      fmt::format("{} or {}: {}.", shared->added, other, discriminating_experiment(shared->added, other));
  const bool more = diagnosis.verdict == Verdict::unexplained ||
                    std::any_of(diagnosis.ladder.begin(), diagnosis.ladder.end(),
                                [&](const Rung& rung) { return &rung != &*shared && !rung.equivalent.empty(); });
  diagnosis.next_experiment = more ? test + ' ' + diagnosis.next_experiment : test;
}

}  // namespace

bool is_gap(double gap, double std_error) {
  return std::abs(gap) > std::max(limits::kLeastGap, limits::kGapSigmas * std_error);
}

bool plateau_is_off(const Motion& motion, const Instruments& instruments) {
  const double off = std::abs(motion.plateau_ratio - 1);
  const bool open =
      instruments.vibrometer.gain && !plateau_says(instruments, motion.conditions, motion.plateau_ratio).not_the_gain;
  return !open && is_gap(off, motion.plateau_ratio_std_error) && motion.plateau_ratio > 1 / limits::kLargestRatio &&
         motion.plateau_ratio < limits::kLargestRatio;
}

bool plateaus_disagree(const Motion& a, const Motion& b) {
  const auto alike = [&](Condition Conditions::*which) {
    const Condition &x = a.conditions.*which, &y = b.conditions.*which;
    return x.known() && y.known() && std::abs(x.value - y.value) <= limits::kSameSetting * std::abs(x.value);
  };
  return alike(&Conditions::radius) && alike(&Conditions::speed) &&
         is_gap(a.plateau_ratio - b.plateau_ratio, std::hypot(a.plateau_ratio_std_error, b.plateau_ratio_std_error));
}

void remove_load_coupling(Identification& trace) {
  if (!trace.analysed) return;
  const Estimate kappa = load_coupling(trace.motion, trace.segmentation);
  if (!(std::abs(kappa.value) > limits::kLeastCoupling)) return;
  const double chance = limits::kChance / static_cast<double>(effect_catalogue().size());
  if (kappa.std_error > 0 && t_p_value(kappa.value / kappa.std_error, kappa.degrees_of_freedom) > chance) return;
  uncouple_load(kappa.value, trace.motion);
  trace.load_coupling = kappa;
}

void add_motion(std::span<const Record> records, const Estimate& load_coupling, const Instruments& instruments,
                const std::optional<Fit>& uncorrected, Diagnosis& diagnosis) {
  const std::vector<EffectFinding> found = motion_findings(*records[0].motion, load_coupling, instruments);
  diagnosis.effects = merged(found, records, diagnosis.effects);
  if (found.empty()) return;
  if (diagnosis.verdict == Verdict::sufficient) diagnosis.verdict = Verdict::effect_found;
  if (diagnosis.ladder.empty()) return;
  std::vector<Rung> rungs = rungs_before_fit(found, uncorrected, diagnosis.ladder.front());
  rungs.insert(rungs.end(), diagnosis.ladder.begin() + 1, diagnosis.ladder.end());
  diagnosis.ladder = std::move(rungs);
  add_plateau_experiment(diagnosis);
}

}  // namespace tribofit::diagnosis
