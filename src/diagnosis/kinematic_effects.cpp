#include "kinematic_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "instrument_limits.hpp"
#include "tribofit/friction/effect_pairs.hpp"

namespace tribofit::diagnosis {
namespace {

/// What was found in the motion and in the load channel, and undone, as effects.
std::vector<EffectFinding> motion_findings(const Motion& motion, const Estimate& load_coupling,
                                           const Instruments& instruments) {
  std::vector<EffectFinding> out;
  const auto add = [&](const char* key, const std::vector<std::pair<double, double>>& values) {
    EffectFinding finding;
    finding.key = key;
    finding.status = EffectStatus::missing;
    finding.held_out_rmse = finding.error_reduction = std::numeric_limits<double>::quiet_NaN();
    finding.p_value = 0;
    const EffectInfo info = describe(make_effect(key));
    for (std::size_t k = 0; k < info.parameters.size(); ++k) {
      FitParameter parameter;
      parameter.parameter = info.parameters[k];
      parameter.effect = key;
      parameter.value = values[k].first * info.parameters[k].si;
      parameter.std_error = values[k].second * info.parameters[k].si;
      parameter.lower95 = parameter.value - 1.96 * parameter.std_error;
      parameter.upper95 = parameter.value + 1.96 * parameter.std_error;
      parameter.profile_lower95 = parameter.profile_upper95 = std::numeric_limits<double>::quiet_NaN();
      finding.parameters.push_back(parameter);
    }
    finding.reason = "the plateau of stick shows it; it was undone before the law was fitted";
    out.push_back(std::move(finding));
  };
  if (motion.speed_ripple.amplitude > 0) {
    const DiscRipple& ripple = motion.speed_ripple;
    add("speed-ripple", {{ripple.amplitude, ripple.amplitude_std_error},
                         {static_cast<double>(ripple.order), 0.0},
                         {ripple.phase, ripple.phase_std_error}});
  }
  if (motion.plateau_correction != PlateauCorrection::none) {
    const std::pair<double, double> ratio = {motion.corrected_ratio, motion.plateau_ratio_std_error};
    add("radius-offset", {ratio});
    add("velocity-gain", {ratio});
    const bool gain = motion.plateau_correction == PlateauCorrection::gain;
    EffectFinding& other = out[out.size() - (gain ? 2 : 1)];
    const auto says = plateau_says(instruments, motion.conditions, motion.corrected_ratio);
    const bool known = gain ? says.not_the_radius && !says.not_the_gain : says.not_the_gain && !says.not_the_radius;
    other.status = known ? EffectStatus::unsupported : EffectStatus::equivalent;
    const char* rival = gain ? "velocity-gain" : "radius-offset";
    other.reason =
        known ? "the instruments file leaves no room for it" : fmt::format("these data cannot tell it from {}", rival);
  }
  if (motion.high_pass > 0) add("velocity-highpass", {{motion.high_pass, motion.high_pass_std_error}});
  if (load_coupling.value != 0) {
    add("load-coupling", {{load_coupling.value, load_coupling.std_error}});
    out.back().reason = "the load channel follows friction within every cycle; that part was taken out of it";
  }
  return out;
}

/// Why an effect of the motion cannot show, for one that was not found.
EffectFinding not_found(const Effect& effect, std::span<const Record> records) {
  const EffectInfo info = describe(effect);
  EffectFinding finding;
  finding.key = info.key;
  finding.held_out_rmse = finding.error_reduction = finding.p_value = std::numeric_limits<double>::quiet_NaN();
  finding.status = EffectStatus::unsupported;
  finding.reason = "the plateau of stick does not show it";
  const bool sticks = std::any_of(records.begin(), records.end(), [](const Record& r) { return r.motion->sticks; });
  const bool measured = std::any_of(records.begin(), records.end(),
                                    [](const Record& r) { return r.motion->velocity_kind == VelocityKind::block; });
  const bool stated = std::any_of(records.begin(), records.end(),
                                  [](const Record& r) { return std::isfinite(r.motion->plateau_ratio); });
  if (!sticks || !measured) {
    finding.status = EffectStatus::untestable;
    finding.reason = "there is no plateau of stick in v_b";
  } else if (!stated && (info.key == "radius-offset" || info.key == "velocity-gain")) {
    finding.status = EffectStatus::untestable;
    finding.reason = "there is no stated speed and radius to compare the plateau with";
  } else if (info.key == "speed-ripple" && !records[0].motion->disc_speed.empty()) {
    finding.status = EffectStatus::untestable;
    finding.reason = "the disc speed was recorded: it is used as it is";
  } else if (info.key == "speed-ripple") {
    const Motion& motion = *records[0].motion;
    const double turns = motion.conditions.speed.known()
                             ? motion.conditions.speed.value * motion.duration() / (2 * std::numbers::pi)
                             : 0;
    if (turns < 2) {
      finding.status = EffectStatus::untestable;
      finding.reason = fmt::format("the record holds {:.1f} revolutions of the disc; two are needed", turns);
    }
  }
  return finding;
}

/// Puts the test that tells the two effects of a plateau apart in front of the other experiments.
void tell_plateau(Diagnosis& diagnosis) {
  const auto shared = std::find_if(diagnosis.ladder.begin(), diagnosis.ladder.end(), [](const Rung& rung) {
    return !rung.equivalent.empty() && (rung.added == "radius-offset" || rung.added == "velocity-gain");
  });
  if (shared == diagnosis.ladder.end()) return;
  const std::string& other = shared->equivalent.front();
  const std::string test = fmt::format("{} or {}: {}.", shared->added, other, telling_test(shared->added, other));
  const bool more = diagnosis.verdict == Verdict::unexplained ||
                    std::any_of(diagnosis.ladder.begin(), diagnosis.ladder.end(),
                                [&](const Rung& rung) { return &rung != &*shared && !rung.equivalent.empty(); });
  diagnosis.next_experiment = more ? test + ' ' + diagnosis.next_experiment : test;
}

}  // namespace

bool is_gap(double gap, double std_error) {
  constexpr double kLeast = 0.004, kSigmas = 5;
  return std::abs(gap) > std::max(kLeast, kSigmas * std_error);
}

bool plateau_is_off(const Motion& motion, const Instruments& instruments) {
  const double off = std::abs(motion.plateau_ratio - 1);
  const bool open =
      instruments.vibrometer.gain && !plateau_says(instruments, motion.conditions, motion.plateau_ratio).not_the_gain;
  return !open && is_gap(off, motion.plateau_ratio_std_error) && motion.plateau_ratio > 0.85 &&
         motion.plateau_ratio < 1.15;
}

void add_motion(std::span<const Record> records, const Estimate& load_coupling, const Instruments& instruments,
                const std::optional<Fit>& uncorrected, Diagnosis& diagnosis) {
  const std::vector<EffectFinding> found = motion_findings(*records[0].motion, load_coupling, instruments);
  std::vector<EffectFinding> findings;
  for (const Effect& effect : effect_catalogue()) {
    const std::string key = describe(effect).key;
    const auto named = [&](const EffectFinding& f) { return f.key == key; };
    const auto before = std::find_if(found.begin(), found.end(), named);
    const auto at = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(), named);
    if (before != found.end()) {
      findings.push_back(*before);
    } else if (is_kinematic(effect)) {
      findings.push_back(not_found(effect, records));
    } else if (at != diagnosis.effects.end()) {
      findings.push_back(*at);
    }
  }
  for (const EffectFinding& finding : diagnosis.effects) {  // the user's own
    const auto same = [&](const EffectFinding& f) { return f.key == finding.key; };
    if (std::none_of(findings.begin(), findings.end(), same)) findings.push_back(finding);
  }
  diagnosis.effects = std::move(findings);
  if (found.empty()) return;
  if (diagnosis.verdict == Verdict::sufficient) diagnosis.verdict = Verdict::effect_found;
  if (diagnosis.ladder.empty()) return;
  std::vector<Rung> rungs;
  Rung first = diagnosis.ladder.front();
  if (uncorrected) {
    first.rmse = uncorrected->error.rmse;
    first.held_out_rmse = uncorrected->error.held_out_rmse;
    first.held_out_std_error = held_out_std_error(*uncorrected);
  }
  rungs.push_back(first);
  for (const EffectFinding& finding : found) {
    if (finding.status != EffectStatus::missing) continue;
    Rung rung = diagnosis.ladder.front();
    rung.added = finding.key;
    for (const EffectFinding& other : found) {
      const bool pair = other.status == EffectStatus::equivalent &&
                        (finding.key == "radius-offset" || finding.key == "velocity-gain");
      if (pair) rung.equivalent.push_back(other.key);
    }
    rungs.push_back(rung);
  }
  rungs.insert(rungs.end(), diagnosis.ladder.begin() + 1, diagnosis.ladder.end());
  diagnosis.ladder = std::move(rungs);
  tell_plateau(diagnosis);
}

}  // namespace tribofit::diagnosis
