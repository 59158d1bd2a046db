#include "tribofit/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "diagnosis/declared.hpp"
#include "diagnosis/own_effects.hpp"
#include "fit/stick.hpp"
#include "fit/stick_evidence.hpp"
#include "tribofit/fit/parallel.hpp"
#include "tribofit/friction/effect_pairs.hpp"
#include "tribofit/segmentation/load_coupling.hpp"
#include "tribofit/segmentation/mean_error.hpp"

namespace tribofit {

namespace {

/// Effects with a term in a friction model.
std::vector<Effect> of_friction(const std::vector<Effect>& effects) {
  std::vector<Effect> out;
  for (const Effect& effect : effects) {
    if (!is_of_motion(effect)) out.push_back(effect);
  }
  return out;
}

/// Every model and protocol to fit: joint fits first, then the published protocol for the bare laws.
std::vector<std::pair<FrictionModel, FitOptions>> plan(const IdentifyOptions& options) {
  std::vector<std::pair<FrictionModel, FitOptions>> fits;
  FitOptions inner = options.fit;
  for (const BaseLaw law : options.laws) fits.emplace_back(FrictionModel(law, of_friction(options.effects)), inner);
  inner.protocol = Protocol::published;
  for (const BaseLaw law : options.laws) {
    if (options.published_protocol && law != BaseLaw::coulomb) fits.emplace_back(FrictionModel(law), inner);
  }
  return fits;
}

/// Index of the fit with the least error on held-out cycles, among those of the first fit's protocol.
std::size_t best_of(const std::vector<Fit>& fits) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < fits.size(); ++k) {
    if (fits[k].protocol != fits[0].protocol || fits[k].parameters.empty()) continue;
    if (fits[best].parameters.empty() || fits[k].error.held_out_rmse < fits[best].error.held_out_rmse) best = k;
  }
  return best;
}

/// One floor a trace, that of the best fit: the floor is a property of the data.
void share_floor(std::vector<Fit>& fits, std::size_t best) {
  const Floor floor = fits[best].floor;
  for (Fit& fit : fits) {
    if (!fit.parameters.empty()) set_floor(floor, fit);
  }
}

/// Where the instruments file contradicts what was used, or says more than is used.
void compare_declared(const Motion& motion, const Instruments& instruments, std::vector<std::string>& warnings) {
  const auto compare = [&](const Condition& used, const std::optional<Declared>& declared, const char* name) {
    if (!declared || !used.known() || used.source == "instruments file") return;
    const double allowed = std::max(1e-6 * std::abs(declared->value), 2 * declared->uncertainty);
    if (std::abs(used.value - declared->value) <= allowed) return;
    warnings.push_back(
        fmt::format("the {} from the {} ({:.4g} in SI units) is used, not that of the instruments file ({:.4g})", name,
                    used.source, used.value, declared->value));
  };
  compare(motion.conditions.radius, instruments.rig.radius, "radius");
  compare(motion.conditions.speed, instruments.rig.speed, "disc speed");
  compare(motion.conditions.load, instruments.rig.load, "load");
  const auto unused = [&](const std::optional<Declared>& declared, const char* name) {
    if (declared)
      warnings.push_back(fmt::format("{} is declared in the instruments file but nothing uses it yet", name));
  };
  unused(instruments.rig.stiffness, "rig.stiffness");
  unused(instruments.rig.ping_frequency, "rig.ping_frequency");
  unused(instruments.rig.pad_radius, "rig.pad_radius");
}

/// What the instruments file says of the conditions, where neither the user nor the manifest said it.
ReadOptions with_declared(ReadOptions read, const Instruments& instruments) {
  const auto declare = [](Condition& condition, const std::optional<Declared>& declared) {
    if (!condition.known() && declared) condition = {declared->value, "instruments file"};
  };
  if (read.step_radii.empty()) declare(read.conditions.radius, instruments.rig.radius);
  declare(read.conditions.speed, instruments.rig.speed);
  declare(read.conditions.load, instruments.rig.load);
  return read;
}

bool is_constant(const std::vector<double>& channel) {
  return std::all_of(channel.begin(), channel.end(), [&](double x) { return x == channel.front(); });
}

/// What keeps the data from carrying an analysis, as sentences; none when nothing does.
std::vector<std::string> obstacles(const Motion& motion, const Segmentation& segmentation) {
  constexpr std::size_t kFewestSamples = 16;
  std::vector<std::string> found;
  if (motion.size() < kFewestSamples) {
    found.push_back(fmt::format("there are only {} samples: too few for any analysis", motion.size()));
    return found;
  }
  if (is_constant(motion.friction))
    found.push_back("friction is the same in every sample: the channel was not recorded");
  if (is_constant(motion.relative_velocity) && !motion.sticks && motion.velocity_kind != VelocityKind::fixed_block) {
    found.push_back("the velocity is the same in every sample: the channel was not recorded");
  }
  if (found.empty() && segmentation.kind == MotionKind::always_sticking) {
    found.push_back("nothing slips in this trace: there is no friction law to fit");
  }
  return found;
}

void require_channels(const IdentifyOptions& options, const Motion& motion, std::vector<std::string>& warnings,
                      bool& analysed) {
  const Channels needs = FrictionModel(BaseLaw::exponential, options.effects).needs();
  const auto missing = [&](bool needed, bool present, const char* channel) {
    if (!needed || present) return;
    warnings.push_back(std::string("an effect needs the channel '") + channel + "', which this trace does not have");
    analysed = false;
  };
  missing(needs.load, !motion.load.empty(), "load");
  if (needs.force && motion.friction_kind != FrictionKind::force && motion.load.empty() &&
      !motion.conditions.load.known()) {
    warnings.push_back("an effect needs the normal force, which is not known: give it with --load 50N");
    analysed = false;
  }
  missing(needs.temperature, !motion.temperature.empty(), "temperature");
  missing(needs.angle, !motion.disc_angle.empty() || motion.conditions.speed.known(), "angle");
}

/// Formulas that have a value on the data.
void require_formulas(const std::vector<Effect>& effects, Identification& trace) {
  if (!trace.analysed) return;
  for (const Effect& effect : effects) {
    const auto* formula = std::get_if<Formula>(&effect);
    if (formula == nullptr) continue;
    const std::string trouble = diagnosis::trouble_with(*formula, {&trace.motion, &trace.segmentation});
    if (trouble.empty()) continue;
    trace.warnings.push_back(trouble);
    trace.analysed = false;
  }
}

/// The stages up to the cycles. Effects of the motion among `effects` are corrected.
Identification prepare(const TraceInput& input, const IdentifyOptions& options, MotionOptions motion_options) {
  Identification out;
  out.path = input.path;
  Trace trace = input.trace ? *input.trace : read_trace(input.path, with_declared(input.read, options.instruments));
  out.checksum = trace.checksum;
  out.samples = trace.size();
  out.duration = trace.duration();
  out.rate = trace.rate();
  out.notes = trace.notes;
  out.warnings = trace.warnings;
  for (const Effect& effect : options.effects) {
    const std::string key = describe(effect).key;
    if (key == "radius-offset") motion_options.plateau = PlateauCorrection::radius;
    if (key == "velocity-gain") motion_options.plateau = PlateauCorrection::gain;
  }
  out.motion = compute_motion(std::move(trace), options.instruments, motion_options);
  out.segmentation = find_cycles(out.motion);
  out.spectral_peak = fundamental(out.motion.relative_velocity, out.motion.step);
  out.notes.insert(out.notes.end(), out.motion.notes.begin(), out.motion.notes.end());
  out.notes.insert(out.notes.end(), out.segmentation.notes.begin(), out.segmentation.notes.end());

  compare_declared(out.motion, options.instruments, out.warnings);
  require_channels(options, out.motion, out.warnings, out.analysed);
  for (const std::string& obstacle : obstacles(out.motion, out.segmentation)) {
    out.warnings.push_back(obstacle);
    out.analysed = false;
  }
  return out;
}

/// Fits every model of the plan to one trace.
void fit_all(const IdentifyOptions& options, Identification& out) {
  // Effects may act within a few samples of break-away and re-stick; the bare laws are smooth.
  const std::vector<Effect> effects = of_friction(options.effects);
  const std::size_t values_per_slip = effects.empty() ? 80 : 1000;
  const Observations observations =
      observe(out.motion, out.segmentation, FrictionModel(BaseLaw::exponential, effects).needs(), values_per_slip);
  if (observations.cycles < 3) {
    out.warnings.push_back("there are fewer than three cycles: no law can be fitted with an uncertainty");
    out.analysed = false;
    return;
  }
  const auto fits = plan(options);
  out.fits.resize(fits.size());
  run_tasks(fits.size(), options.threads, [&](std::size_t k) {
    out.fits[k] =
        fit_model(fits[k].first, out.motion, out.segmentation, observations, options.instruments, fits[k].second);
  });
  out.best = best_of(out.fits);
  share_floor(out.fits, out.best);
}

/// What was found in the motion and in the load channel, and undone, as effects.
std::vector<EffectFinding> motion_findings(const Identification& trace, const Instruments& instruments) {
  const Motion& motion = trace.motion;
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
    const auto says = diagnosis::plateau_says(instruments, motion.conditions, motion.corrected_ratio);
    const bool known = gain ? says.not_the_radius && !says.not_the_gain : says.not_the_gain && !says.not_the_radius;
    other.status = known ? EffectStatus::unsupported : EffectStatus::equivalent;
    other.reason = known ? "the instruments file leaves no room for it"
                         : std::string("these data cannot tell it from ") + (gain ? "velocity-gain" : "radius-offset");
  }
  if (motion.high_pass > 0) add("velocity-highpass", {{motion.high_pass, motion.high_pass_std_error}});
  if (trace.load_coupling.value != 0) {
    add("load-coupling", {{trace.load_coupling.value, trace.load_coupling.std_error}});
    out.back().reason = "the load channel follows friction within every cycle; that part was taken out of it";
  }
  return out;
}

/// Why an effect of the motion cannot show, for one that was not found.
EffectFinding not_found(const Effect& effect, const std::vector<Identification>& traces) {
  const EffectInfo info = describe(effect);
  EffectFinding finding;
  finding.key = info.key;
  finding.held_out_rmse = finding.error_reduction = finding.p_value = std::numeric_limits<double>::quiet_NaN();
  finding.status = EffectStatus::unsupported;
  finding.reason = "the plateau of stick does not show it";
  const bool sticks = std::any_of(traces.begin(), traces.end(), [](const auto& t) { return t.motion.sticks; });
  const bool measured = std::any_of(traces.begin(), traces.end(),
                                    [](const auto& t) { return t.motion.velocity_kind == VelocityKind::block; });
  const bool stated =
      std::any_of(traces.begin(), traces.end(), [](const auto& t) { return std::isfinite(t.motion.plateau_ratio); });
  if (!sticks || !measured) {
    finding.status = EffectStatus::untestable;
    finding.reason = "there is no plateau of stick in v_b";
  } else if (!stated && (info.key == "radius-offset" || info.key == "velocity-gain")) {
    finding.status = EffectStatus::untestable;
    finding.reason = "there is no stated speed and radius to compare the plateau with";
  } else if (info.key == "speed-ripple" && !traces[0].motion.disc_speed.empty()) {
    finding.status = EffectStatus::untestable;
    finding.reason = "the disc speed was recorded: it is used as it is";
  } else if (info.key == "speed-ripple") {
    const Motion& motion = traces[0].motion;
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

constexpr double kLeastGap = 0.004, kGapSigmas = 5;  ///< of the plateau, that call for a correction

/// The plateau is not where the stated speed and radius put it, nor within what the declared gain leaves open.
bool plateau_is_off(const Motion& motion, const Instruments& instruments) {
  const double off = std::abs(motion.plateau_ratio - 1);
  const bool open = instruments.vibrometer.gain &&
                    !diagnosis::plateau_says(instruments, motion.conditions, motion.plateau_ratio).not_the_gain;
  return off > kLeastGap && !open && off > kGapSigmas * motion.plateau_ratio_std_error && motion.plateau_ratio > 0.85 &&
         motion.plateau_ratio < 1.15;
}

/// A load that follows friction within every cycle would pass for friction that follows the load.
void take_out_load_coupling(Identification& trace) {
  constexpr double kLeast = 0.01, kChance = 0.01 / 28;  // one of the catalogue's effects
  const Measure kappa = load_coupling(trace.motion, trace.segmentation);
  if (!(std::abs(kappa.value) > kLeast)) return;
  if (kappa.std_error > 0 && t_p_value(kappa.value / kappa.std_error, kappa.degrees_of_freedom) > kChance) return;
  uncouple_load(kappa.value, trace.motion);
  trace.load_coupling = kappa;
}

/// A trace as the diagnosis reads it. A high-pass that nobody declared is not undone where a contact that turns with
/// the disc lets the plateau sag as well or better; a plateau that is off is put right. motion: what was done in the
/// end, but for the plateau.
Identification prepare_to_diagnose(const TraceInput& input, const IdentifyOptions& options, MotionOptions& motion) {
  Identification trace = prepare(input, options, motion);
  if (trace.analysed && trace.motion.high_pass > 0 && !options.instruments.vibrometer.high_pass) {
    MotionOptions raw = motion;
    raw.undo_high_pass = false;
    Identification plain = prepare(input, options, raw);
    // One in 1e4; but where the high-pass would leave the plateau off, the spin explains by one what else takes two.
    const double at_least = plateau_is_off(trace.motion, options.instruments) ? 0 : 15;
    if (plain.analysed && spins_rather_than_sags(plain.motion, plain.segmentation, at_least)) {
      motion = raw;
      trace = std::move(plain);
    }
  }
  if (trace.analysed && motion.plateau == PlateauCorrection::none &&
      plateau_is_off(trace.motion, options.instruments)) {
    MotionOptions corrected = motion;
    const auto says = diagnosis::plateau_says(options.instruments, trace.motion.conditions, trace.motion.plateau_ratio);
    const bool gain = says.not_the_radius && !says.not_the_gain;
    corrected.plateau = gain ? PlateauCorrection::gain : PlateauCorrection::radius;
    trace = prepare(input, options, corrected);
  }
  if (trace.analysed) take_out_load_coupling(trace);
  return trace;
}

/// Takes back corrections of the plateau that nobody asked for, where the effect that was found lets the block creep as
/// much: a plateau below omega r is then what that effect does. True when there was one.
bool undo_needless_corrections(const std::vector<TraceInput>& inputs, const IdentifyOptions& options,
                               const std::vector<MotionOptions>& motions, const Diagnosed& diagnosed,
                               std::vector<Identification>& traces) {
  if (options.motion.plateau != PlateauCorrection::none || diagnosed.fits.empty()) return false;
  const Fit& fit = diagnosed.fits.back();
  if (!fit.model.acts_in_stick() || fit.parameters.empty()) return false;
  bool undone = false;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    if (traces[k].motion.plateau_correction == PlateauCorrection::none) continue;
    Identification plain = prepare(inputs[k], options, motions[k]);
    if (plain.motion.plateau_correction != PlateauCorrection::none) continue;  // asked for by its effect
    const Measure gap = gap_beside_creep(fit.model, fit.values(), plain.motion, plain.segmentation);
    if (!plain.analysed || !(std::abs(gap.value) <= std::max(kLeastGap, kGapSigmas * gap.std_error))) continue;
    traces[k] = std::move(plain);
    undone = true;
  }
  return undone;
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

/// Puts what kinematics/ found into a diagnosis: rungs below all others, and a finding each.
void add_motion(const std::vector<Identification>& traces, const Instruments& instruments,
                const std::optional<Fit>& uncorrected, DiagnosedTraces& out) {
  Diagnosis& diagnosis = out.diagnosis;
  const std::vector<EffectFinding> found = motion_findings(traces[0], instruments);
  std::vector<EffectFinding> findings;
  for (const Effect& effect : effect_catalogue()) {
    const std::string key = describe(effect).key;
    const auto named = [&](const EffectFinding& f) { return f.key == key; };
    const auto before = std::find_if(found.begin(), found.end(), named);
    const auto at = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(), named);
    if (before != found.end()) {
      findings.push_back(*before);
    } else if (is_of_motion(effect)) {
      findings.push_back(not_found(effect, traces));
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

std::vector<Record> records_of(const std::vector<Identification>& traces) {
  std::vector<Record> records;
  for (const Identification& trace : traces) records.push_back({&trace.motion, &trace.segmentation});
  return records;
}

/// What the base law leaves where nothing of the motion is undone; nothing where the record cannot be read like that.
std::optional<Fit> fit_uncorrected(const TraceInput& input, const IdentifyOptions& options, BaseLaw law,
                                   const std::vector<Effect>& from_the_start) {
  MotionOptions raw = options.motion;
  raw.undo_high_pass = raw.undo_speed_ripple = false;
  Identification trace = prepare(input, options, raw);
  if (!trace.analysed) return std::nullopt;
  IdentifyOptions bare = options;
  bare.laws = {law};
  bare.effects = from_the_start;
  bare.published_protocol = false;
  fit_all(bare, trace);
  if (trace.fits.empty() || trace.fits[0].parameters.empty()) return std::nullopt;
  return trace.fits[0];
}

/// The final model against the base law on a run that took no part, every parameter frozen.
Confirmation confirm(const TraceInput& input, const IdentifyOptions& options, const Fit& base, const Fit& last) {
  Confirmation out;
  out.path = input.path;
  out.base_rmse = out.final_rmse = std::numeric_limits<double>::quiet_NaN();
  MotionOptions motion = options.motion;
  const Identification trace = prepare_to_diagnose(input, options, motion);
  if (!trace.analysed) return out;
  const Fit frozen_base = frozen_on(base, trace.motion, trace.segmentation);
  const Fit frozen_last = frozen_on(last, trace.motion, trace.segmentation);
  out.base_rmse = frozen_base.error.rmse;
  out.final_rmse = frozen_last.error.rmse;
  const Comparison comparison = compare_held_out(frozen_last, frozen_base);
  out.p_value = comparison.first_better ? 0.5 * comparison.p_value : 1 - 0.5 * comparison.p_value;
  return out;
}

}  // namespace

Identification identify(const std::string& path, const IdentifyOptions& options) {
  Identification out = prepare({path, options.read, {}}, options, options.motion);
  require_formulas(options.effects, out);
  if (out.analysed) fit_all(options, out);
  return out;
}

DiagnosedTraces diagnose(const std::vector<TraceInput>& inputs, const IdentifyOptions& given,
                         const DiagnoseOptions& more) {
  DiagnosedTraces out;
  refuse_same(given.effects);
  IdentifyOptions options = given;
  std::vector<Effect> own = of_friction(given.effects);
  options.effects.erase(std::remove_if(options.effects.begin(), options.effects.end(),
                                       [](const Effect& effect) { return !is_of_motion(effect); }),
                        options.effects.end());
  const auto first_given = std::stable_partition(
      own.begin(), own.end(), [](const Effect& effect) { return std::holds_alternative<Formula>(effect); });
  const std::vector<Effect> from_the_start(first_given, own.end());
  own.erase(first_given, own.end());
  std::vector<MotionOptions> motions(inputs.size(), options.motion);
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const TraceInput& input = inputs[k];
    out.traces.push_back(prepare_to_diagnose(input, options, motions[k]));
    Identification& trace = out.traces.back();
    require_channels(given, trace.motion, trace.warnings, trace.analysed);
    require_formulas(own, trace);
    out.analysed &= trace.analysed;
  }
  if (!out.analysed) {
    out.diagnosis.verdict = Verdict::not_enough_data;
    return out;
  }
  DiagnosisOptions inner = more.diagnosis;
  inner.threads = options.threads;
  inner.from_the_start = from_the_start;
  const auto diagnose_all = [&] {
    const std::vector<Record> records = records_of(out.traces);
    return diagnose(records, options.laws, own, options.instruments, options.fit, inner);
  };
  Diagnosed diagnosed = diagnose_all();
  if (undo_needless_corrections(inputs, options, motions, diagnosed, out.traces)) diagnosed = diagnose_all();
  out.diagnosis = std::move(diagnosed.diagnosis);
  std::optional<Fit> uncorrected;
  const Motion& motion = out.traces[0].motion;
  const bool moved =
      motion.high_pass > 0 || motion.speed_ripple.amplitude > 0 || motion.plateau_correction != PlateauCorrection::none;
  if (moved && inputs.size() == 1 && !diagnosed.fits.empty()) {
    uncorrected = fit_uncorrected(inputs[0], options, out.diagnosis.law, from_the_start);
  }
  add_motion(out.traces, options.instruments, uncorrected, out);
  if (!diagnosed.fits.empty()) {
    out.fits.push_back(diagnosed.fits.front());
    if (diagnosed.fits.size() > 1) out.fits.push_back(diagnosed.fits.back());
    out.best = out.fits.size() - 1;
    for (const TraceInput& input : more.confirm) {
      out.diagnosis.confirmations.push_back(confirm(input, options, diagnosed.fits.front(), diagnosed.fits.back()));
    }
  }
  return out;
}

}  // namespace tribofit
