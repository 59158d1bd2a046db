#include "tribofit/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "diagnosis/instrument_limits.hpp"
#include "diagnosis/kinematic_effects.hpp"
#include "diagnosis/user_effects.hpp"
#include "fit/stick.hpp"
#include "fit/stick_evidence.hpp"
#include "tribofit/kinematics/clock_offset.hpp"
#include "tribofit/segmentation/load_coupling.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/parallel.hpp"

namespace tribofit {

namespace {

/// Effects with a term in a friction model.
std::vector<Effect> friction_effects(const std::vector<Effect>& effects) {
  std::vector<Effect> out;
  for (const Effect& effect : effects) {
    if (!is_kinematic(effect)) out.push_back(effect);
  }
  return out;
}

/// Every model and protocol to fit: joint fits first, then the published protocol for the bare laws.
std::vector<std::pair<FrictionModel, FitOptions>> plan(const IdentifyOptions& options) {
  std::vector<std::pair<FrictionModel, FitOptions>> fits;
  FitOptions inner = options.fit;
  for (const BaseLaw law : options.laws)
    fits.emplace_back(FrictionModel(law, friction_effects(options.effects)), inner);
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

/// What a trace is read for.
enum class Purpose { law, rig };

/// Where the instruments file contradicts what was used, or says more than is used.
void compare_declared(const Motion& motion, const Instruments& instruments, Purpose purpose,
                      std::vector<std::string>& warnings) {
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
  const auto of_rig = [&](const std::optional<Declared>& declared, const char* name) {
    if (declared && purpose != Purpose::rig)
      warnings.push_back(fmt::format("{} is declared in the instruments file; only `identify rig` uses it", name));
  };
  of_rig(instruments.rig.stiffness, "rig.stiffness");
  of_rig(instruments.rig.ping_frequency, "rig.ping_frequency");
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
std::vector<std::string> obstacles(const Motion& motion, const Segmentation& segmentation, Purpose purpose) {
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
  if (found.empty() && segmentation.kind == MotionKind::always_sticking && purpose == Purpose::law) {
    found.push_back("nothing slips in this trace: there is no friction law to fit");
  }
  return found;
}

void require_channels(const std::vector<Effect>& effects, const Motion& motion, std::vector<std::string>& warnings,
                      bool& analysed) {
  const Channels needs = FrictionModel(BaseLaw::exponential, effects).needs();
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
Identification prepare(const TraceInput& input, const IdentifyOptions& options, MotionOptions motion_options,
                       Purpose purpose = Purpose::law) {
  Identification out;
  out.path = input.path;
  Trace trace = *read_input(input, options);
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
  exclude(options.selection, out.motion, out.segmentation);
  out.spectral_peak = fundamental(out.motion.relative_velocity, out.motion.step);
  out.notes.insert(out.notes.end(), out.motion.notes.begin(), out.motion.notes.end());
  out.notes.insert(out.notes.end(), out.segmentation.notes.begin(), out.segmentation.notes.end());

  compare_declared(out.motion, options.instruments, purpose, out.warnings);
  require_channels(options.effects, out.motion, out.warnings, out.analysed);
  for (const std::string& obstacle : obstacles(out.motion, out.segmentation, purpose)) {
    out.warnings.push_back(obstacle);
    out.analysed = false;
  }
  return out;
}

/// Fits every model of the plan to one trace.
void fit_all(const IdentifyOptions& options, Identification& out, FitDetail detail = FitDetail::full) {
  // Effects may act within a few samples of break-away and re-stick; the bare laws are smooth.
  constexpr std::size_t kBare = 80, kQuick = 100, kFull = 1000;
  const std::vector<Effect> effects = friction_effects(options.effects);
  const std::size_t values_per_slip = effects.empty() ? kBare : detail == FitDetail::quick ? kQuick : kFull;
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

/// A load that follows friction within every cycle would pass for friction that follows the load.
void take_out_load_coupling(Identification& trace) {
  constexpr double kLeast = 0.01, kChance = 0.01 / 28;  // one of the catalogue's effects
  const Estimate kappa = load_coupling(trace.motion, trace.segmentation);
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
    const double at_least = diagnosis::plateau_is_off(trace.motion, options.instruments) ? 0 : 15;
    if (plain.analysed && spins_rather_than_sags(plain.motion, plain.segmentation, at_least)) {
      motion = raw;
      trace = std::move(plain);
    }
  }
  if (trace.analysed && motion.plateau == PlateauCorrection::none &&
      diagnosis::plateau_is_off(trace.motion, options.instruments)) {
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
    const Estimate gap = gap_beside_creep(fit.model, fit.values(), plain.motion, plain.segmentation);
    if (!plain.analysed || !std::isfinite(gap.value) || diagnosis::is_gap(gap.value, gap.std_error)) continue;
    traces[k] = std::move(plain);
    undone = true;
  }
  return undone;
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
  const Fit frozen_base = evaluate_frozen(base, trace.motion, trace.segmentation);
  const Fit frozen_last = evaluate_frozen(last, trace.motion, trace.segmentation);
  out.base_rmse = frozen_base.error.rmse;
  out.final_rmse = frozen_last.error.rmse;
  const Comparison comparison = compare_held_out(frozen_last, frozen_base);
  out.p_value = comparison.first_better ? 0.5 * comparison.p_value : 1 - 0.5 * comparison.p_value;
  return out;
}

}  // namespace

Identification identify(const std::string& path, const IdentifyOptions& options) {
  Identification out = prepare_trace({path, options.read, {}}, options);
  fit_trace(options, out);
  return out;
}

std::shared_ptr<const Trace> read_input(const TraceInput& input, const IdentifyOptions& options) {
  if (input.trace) return input.trace;
  ReadOptions read = with_declared(input.read, options.instruments);
  read.clock_offset = estimate_clock_offset;
  return std::make_shared<const Trace>(read_trace(input.path, read));
}

Identification prepare_trace(const TraceInput& input, const IdentifyOptions& options) {
  IdentifyOptions kinematic_effect = options;  // what effects of friction need is a matter of their fit
  std::erase_if(kinematic_effect.effects, [](const Effect& effect) { return !is_kinematic(effect); });
  return prepare(input, kinematic_effect, options.motion);
}

void fit_trace(const IdentifyOptions& options, Identification& trace, FitDetail detail) {
  trace.fits.clear();
  trace.best = 0;
  require_channels(friction_effects(options.effects), trace.motion, trace.warnings, trace.analysed);
  require_formulas(options.effects, trace);
  if (trace.analysed) fit_all(options, trace, detail);
}

RigIdentification identify_rig(const TraceInput& input, const IdentifyOptions& options) {
  RigIdentification out{prepare(input, options, options.motion, Purpose::rig), {}};
  if (out.trace.analysed) {
    out.rig = identify_rig(out.trace.motion, out.trace.segmentation, options.instruments);
  } else {
    out.rig.reason = out.trace.warnings.back();
  }
  out.trace.analysed = out.rig.determined;
  return out;
}

TwinIdentification identify_twin(const TraceInput& input, const IdentifyOptions& given, const TwinOptions& more) {
  TwinIdentification out;
  IdentifyOptions options = given;
  options.published_protocol = false;
  Identification& trace = out.trace = prepare(input, options, options.motion, Purpose::rig);
  require_formulas(options.effects, trace);
  if (trace.analysed && trace.segmentation.kind != MotionKind::stick_slip) {
    trace.warnings.push_back(trace.segmentation.kind == MotionKind::always_sticking
                                 ? "the block never slips: there is no motion to compare"
                                 : "the block never sticks: there are no cycles to compare");
    trace.analysed = false;
  }
  std::vector<Fit> best;
  const auto take_best = [&] {
    if (trace.analysed) fit_all(options, trace);
    if (!trace.analysed) return;
    best.push_back(trace.fits[trace.best]);
    out.rigs.push_back(rig_beside(best.back(), trace.motion, trace.segmentation, options.instruments));
    if (out.rigs.back().determined) return;
    trace.warnings.push_back("the rig could not be identified: " + out.rigs.back().reason);
    trace.analysed = false;
  };
  options.effects.clear();
  take_best();
  options.effects = given.effects;
  if (!friction_effects(given.effects).empty()) take_best();
  trace.fits = std::move(best);
  trace.best = trace.fits.empty() ? 0 : trace.fits.size() - 1;
  if (trace.analysed) {
    TwinOptions inner = more;
    inner.threads = options.threads;
    out.twin = compare_twins(trace.motion, trace.segmentation, trace.fits, out.rigs, inner);
  } else {
    out.twin.reason = trace.warnings.back();
  }
  trace.analysed = out.twin.reason.empty();
  return out;
}

DiagnosedTraces diagnose(const std::vector<TraceInput>& inputs, const IdentifyOptions& given,
                         const DiagnoseOptions& more) {
  DiagnosedTraces out;
  refuse_same(given.effects);
  IdentifyOptions options = given;
  std::vector<Effect> own = friction_effects(given.effects);
  options.effects.erase(std::remove_if(options.effects.begin(), options.effects.end(),
                                       [](const Effect& effect) { return !is_kinematic(effect); }),
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
    require_channels(given.effects, trace.motion, trace.warnings, trace.analysed);
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
  diagnosis::add_motion(records_of(out.traces), out.traces[0].load_coupling, options.instruments, uncorrected,
                        out.diagnosis);
  if (!diagnosed.fits.empty()) {
    out.fits.push_back(diagnosed.fits.front());
    if (diagnosed.fits.size() > 1) out.fits.push_back(diagnosed.fits.back());
    out.best = out.fits.size() - 1;
    for (const TraceInput& input : more.confirm) {
      out.diagnosis.confirmations.push_back(confirm(input, options, diagnosed.fits.front(), diagnosed.fits.back()));
    }
    out.rungs = std::move(diagnosed.fits);
  }
  return out;
}

}  // namespace tribofit
