#include "diagnose_traces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "conclusions.hpp"
#include "fit/fit_laws.hpp"
#include "fit/requested_effects.hpp"
#include "fit/stick_evidence.hpp"
#include "imitations.hpp"
#include "instrument_limits.hpp"
#include "kinematic_effects.hpp"
#include "limits.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit::diagnosis {

namespace {

/// Prepares the trace again without undoing the high-pass, or following a disc that slows down, and keeps that where a
/// contact that turns with the disc explains the sag of the plateau.
void reconsider_sag(const Instruments& instruments, PreparedTrace& prepared) {
  const Identification& trace = prepared.trace;
  const bool slows = trace.motion.drive_compliance.any();
  if (!trace.analysed || !(trace.motion.high_pass > 0 || slows) || instruments.vibrometer.high_pass) return;
  MotionOptions raw = prepared.motion;
  raw.undo_high_pass = false;
  raw.undo_speed_ripple &= !slows;
  Identification plain = prepared.prepare(raw);
  // Where what was undone would leave the plateau off, the spin explains by one effect what else takes two.
  const double at_least = plateau_is_off(trace.motion, instruments) ? 0 : limits::kFallOfSag;
  if (!plain.analysed || !spins_rather_than_sags(plain.motion, plain.segmentation, at_least)) return;
  prepared.motion = raw;
  prepared.trace = std::move(plain);
}

/// Puts a plateau right that is not where the stated speed and radius put it.
void correct_plateau(const Instruments& instruments, PreparedTrace& prepared) {
  const Motion& motion = prepared.trace.motion;
  if (!prepared.trace.analysed || prepared.motion.plateau != PlateauCorrection::none ||
      !plateau_is_off(motion, instruments)) {
    return;
  }
  const PlateauSays says = plateau_says(instruments, motion.conditions, motion.plateau_ratio);
  const bool gain = says.not_the_radius && !says.not_the_gain;
  MotionOptions corrected = prepared.motion;
  corrected.plateau = gain ? PlateauCorrection::gain : PlateauCorrection::radius;
  prepared.trace = prepared.prepare(corrected);
}

/// Prepares a trace anew as its options say, with what follows from the record itself.
void prepare_again(const Instruments& instruments, PreparedTrace& prepared) {
  prepared.trace = prepared.prepare(prepared.motion);
  correct_plateau(instruments, prepared);
  remove_load_coupling(prepared.trace);
}

/// Of runs with one force sensor: it is a low-pass in all of them where most of the cycles that can show it do, and in
/// none where they do not. Few cycles, or noise, show or hide it wrongly; and where some runs are read through a filter
/// and others not, no law describes all.
void share_friction_filter(const Instruments& instruments, std::vector<PreparedTrace>& traces) {
  double cycles_with = 0, cycles = 0, sum = 0, variance = 0;
  for (const PreparedTrace& prepared : traces) {
    const Motion& motion = prepared.trace.motion;
    if (!prepared.trace.analysed || motion.friction_filter_source != FilterSource::this_record) continue;
    const auto own = static_cast<double>(prepared.trace.segmentation.cycles.size());
    cycles += own;
    if (!motion.friction_low_pass.any()) continue;
    cycles_with += own;
    sum += own * motion.friction_low_pass.value;
    variance += std::pow(own * motion.friction_low_pass.std_error, 2);
  }
  if (cycles_with == 0) return;
  const bool is_filter = cycles_with >= limits::kMostOfTheError * cycles;
  const Estimate shared = is_filter ? Estimate{sum / cycles_with, std::sqrt(variance) / cycles_with} : Estimate{};
  for (PreparedTrace& prepared : traces) {
    const bool sticks = prepared.trace.analysed && prepared.trace.segmentation.kind == MotionKind::stick_slip;
    if (!sticks || prepared.trace.motion.friction_low_pass.any() == is_filter) continue;
    prepared.motion.friction_low_pass = shared;
    prepare_again(instruments, prepared);
    prepared.trace.notes.push_back(
        is_filter ? fmt::format("friction: a low-pass at {}, as other runs show; each law is filtered the same way",
                                frequency_text(1 / (2 * std::numbers::pi * shared.value), 3))
                  : "friction: it seems to be read through a low-pass, which most of the runs do not show; not taken");
  }
}

/// Takes back corrections of the plateau that nobody asked for, where the effect that was found lets the block creep as
/// much: a plateau below omega r is then what that effect does. True when there was one.
bool undo_needless_corrections(const IdentifyOptions& options, const Diagnosed& diagnosed,
                               std::vector<PreparedTrace>& traces) {
  if (options.motion.plateau != PlateauCorrection::none || diagnosed.fits.empty()) return false;
  const Fit& fit = diagnosed.fits.back();
  if (!fit.model.acts_in_stick() || fit.parameters.empty()) return false;
  bool undone = false;
  for (PreparedTrace& prepared : traces) {
    if (prepared.trace.motion.plateau_correction == PlateauCorrection::none) continue;
    Identification plain = prepared.prepare(prepared.motion);
    if (plain.motion.plateau_correction != PlateauCorrection::none) continue;  // asked for by its effect
    const Estimate gap = gap_beside_creep(fit.model, fit.values(), plain.motion, plain.segmentation);
    if (!plain.analysed || !std::isfinite(gap.value) || is_gap(gap.value, gap.std_error)) continue;
    prepared.trace = std::move(plain);
    undone = true;
  }
  return undone;
}

using Corrected = std::pair<std::size_t, Identification>;  ///< a corrected trace, and which it was

/// Takes back corrections of plateaus below omega r that differ from that of a run at the same radius and speed: a
/// wrong radius or gain moves both alike, creep in stick each in its own way. Returns the corrected ones.
std::vector<Corrected> doubt_corrections(const IdentifyOptions& options, std::vector<PreparedTrace>& traces) {
  std::vector<Corrected> out;
  if (options.motion.plateau != PlateauCorrection::none) return out;
  for (std::size_t k = 0; k < traces.size(); ++k) {
    const Motion& motion = traces[k].trace.motion;
    if (motion.plateau_correction == PlateauCorrection::none || !(motion.plateau_ratio < 1)) continue;
    const bool differs = std::any_of(traces.begin(), traces.end(), [&](const PreparedTrace& other) {
      return plateaus_disagree(motion, other.trace.motion);
    });
    if (!differs) continue;
    Identification plain = traces[k].prepare(traces[k].motion);
    if (!plain.analysed || plain.motion.plateau_correction != PlateauCorrection::none) continue;
    remove_load_coupling(plain);
    out.emplace_back(k, std::exchange(traces[k].trace, std::move(plain)));
  }
  return out;
}

/// The error on held-out cycles of what was found where that creeps in stick; infinite where it does not.
double held_out_of_creep(const Diagnosed& diagnosed) {
  const bool creeps = !diagnosed.fits.empty() && diagnosed.fits.back().model.acts_in_stick() &&
                      !diagnosed.fits.back().parameters.empty();
  return creeps ? diagnosed.fits.back().error.held_out_rmse : std::numeric_limits<double>::infinity();
}

/// What the base law leaves where nothing of the motion is undone; nothing where nothing was, or where the record
/// cannot be read like that.
std::optional<Fit> fit_uncorrected(const PreparedTrace& prepared, IdentifyOptions options, Law law,
                                   const EffectRoles& effects) {
  const Motion& motion = prepared.trace.motion;
  const bool distorted = motion.velocity_zero.any() || motion.velocity_low_pass.any() ||
                         motion.friction_low_pass.any() || motion.velocity_response.any() ||
                         motion.friction_response.any() || motion.clock_drift.any();
  const bool corrected = distorted || motion.high_pass > 0 || motion.speed_ripple.amplitude > 0 ||
                         motion.plateau_correction != PlateauCorrection::none ||
                         prepared.trace.load_coupling.value != 0;
  if (!corrected) return std::nullopt;
  MotionOptions raw = options.motion;
  raw.undo_high_pass = raw.undo_speed_ripple = raw.undo_distortions = false;
  Identification trace = prepared.prepare(raw);
  if (!trace.analysed) return std::nullopt;
  options.laws = {law};
  options.effects = effects.from_the_start;
  options.published_protocol = false;
  fit_laws(options, trace);
  if (trace.fits.empty() || trace.fits[0].parameters.empty()) return std::nullopt;
  return trace.fits[0];
}

std::vector<Record> records_of(const std::vector<PreparedTrace>& traces) {
  std::vector<Record> records;
  for (const PreparedTrace& prepared : traces)
    records.push_back({&prepared.trace.motion, &prepared.trace.segmentation});
  return records;
}

/// Refuses traces without what the effects need; false when any is refused.
bool all_can_be_diagnosed(const std::vector<Effect>& effects, const EffectRoles& roles,
                          std::vector<PreparedTrace>& traces) {
  bool all = true;
  for (PreparedTrace& prepared : traces) {
    require_channels(effects, prepared.trace.motion, prepared.trace);
    require_formulas(roles.candidates, prepared.trace.motion, prepared.trace);
    all &= prepared.trace.analysed;
  }
  return all;
}

/// The first and the last rung as the fits of the result, and every rung.
void take_rungs(std::vector<Fit> rungs, DiagnosedTraces& out) {
  if (rungs.empty()) return;
  out.fits.push_back(rungs.front());
  if (rungs.size() > 1) out.fits.push_back(rungs.back());
  out.best = out.fits.size() - 1;
  out.rungs = std::move(rungs);
}

/// What the run leaves where every parameter is its own.
double own_floor(const Fit& joint, const Identification& trace) {
  const Record record = {&trace.motion, &trace.segmentation};
  const FrictionModel model = joint.model.of_one_record();
  return fit_model(model, {&record, 1}, observations_for(model, {&record, 1})).floor.rmse;
}

/// The fit with what belongs to a record alone (phases, the time of a change) found anew on this one.
Fit with_values_of_record(const Fit& joint, const Identification& trace) {
  const Fit fit = of_first_record(joint);
  FitOptions options;
  const auto belongs_to_record = [&](std::size_t k) {
    return fit.model.parameters()[k].parameter.scope == ParameterScope::record;
  };
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const double value = fit.parameters[k].value;
    if (belongs_to_record(k)) continue;
    options.given.push_back({fit.model.parameters()[k].full_name(), value, GivenParameter::Bounds{value, value}});
  }
  if (options.given.size() == fit.parameters.size()) return fit;
  const Record record = {&trace.motion, &trace.segmentation};
  const Fit own = fit_model(fit.model, {&record, 1}, observations_for(fit.model, {&record, 1}), {}, options);
  Fit out = fit;
  for (std::size_t k = 0; k < own.parameters.size(); ++k) {
    if (belongs_to_record(k)) out.parameters[k].value = own.parameters[k].value;
  }
  return out;
}

/// What is said of a trace that holds the same values as another. Empty where it does not. A checksum of 0 is not
/// known.
std::string copy_of(const Identification& trace, const Identification& other) {
  if (trace.checksum == 0 || trace.checksum != other.checksum) return {};
  return trace.path + " holds the same values as " + other.path + ": identical files are one run, it counts once";
}

}  // namespace

Fit of_first_record(const Fit& joint) {
  Fit fit = joint;
  fit.model = joint.model.of_one_record();
  fit.parameters.clear();
  fit.covariance.clear();
  const std::size_t n = joint.parameters.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (joint.model.is_of_further_record(k)) continue;
    fit.parameters.push_back(joint.parameters[k]);
    for (std::size_t i = 0; i < n && !joint.covariance.empty(); ++i) {
      if (!joint.model.is_of_further_record(i)) fit.covariance.push_back(joint.covariance[k * n + i]);
    }
  }
  return fit;
}

EffectRoles roles_of(const std::vector<Effect>& effects) {
  EffectRoles roles;
  roles.kinematic = kinematic_effects(effects);
  for (const Effect& effect : friction_effects(effects)) {
    (std::holds_alternative<Formula>(effect) ? roles.candidates : roles.from_the_start).push_back(effect);
  }
  return roles;
}

std::optional<Estimate> shared_friction_filter(const std::vector<Identification>& traces) {
  for (const Identification& trace : traces) {
    if (trace.motion.friction_filter_source != FilterSource::unknown) return trace.motion.friction_low_pass;
  }
  return std::nullopt;
}

PreparedTrace prepare_to_diagnose(const PrepareTrace& prepare, const IdentifyOptions& options) {
  PreparedTrace prepared{prepare(options.motion), options.motion, prepare};
  reconsider_sag(options.instruments, prepared);
  correct_plateau(options.instruments, prepared);
  remove_load_coupling(prepared.trace);
  return prepared;
}

DiagnosedTraces diagnose_traces(std::vector<PreparedTrace> traces, const IdentifyOptions& options,
                                const DiagnosisOptions& given) {
  DiagnosedTraces out;
  const EffectRoles effects = roles_of(options.effects);
  out.analysed = all_can_be_diagnosed(options.effects, effects, traces);
  if (out.analysed) {
    share_friction_filter(options.instruments, traces);
    DiagnosisOptions inner = given;
    inner.threads = options.threads;
    inner.from_the_start = effects.from_the_start;
    const auto diagnose_records = [&](std::span<const Record> records) {
      return diagnose(records, options.laws, effects.candidates, options.instruments, options.fit, inner);
    };
    const auto diagnose_all = [&] { return diagnose_records(records_of(traces)); };
    std::vector<Corrected> doubted = doubt_corrections(options, traces);
    Diagnosed diagnosed = diagnose_all();
    if (!doubted.empty()) {  // creep must describe them better than corrected plateaus do
      const auto exchange = [&] {
        for (auto& [k, other] : doubted) std::swap(traces[k].trace, other);
      };
      exchange();
      Diagnosed corrected = diagnose_all();
      const double with_creep = held_out_of_creep(diagnosed);
      const bool creeps = std::isfinite(with_creep) &&
                          (corrected.fits.empty() || with_creep < corrected.fits.back().error.held_out_rmse);
      if (creeps) {
        exchange();
      } else {
        diagnosed = std::move(corrected);
      }
    }
    const bool finished = diagnosed.diagnosis.verdict != Verdict::unfinished;
    if (finished && undo_needless_corrections(options, diagnosed, traces)) diagnosed = diagnose_all();
    withhold_of_differing_runs(traces, diagnose_records, diagnosed);
    out.diagnosis = std::move(diagnosed.diagnosis);
    std::optional<Fit> uncorrected;
    if (traces.size() == 1 && !diagnosed.fits.empty())
      uncorrected = fit_uncorrected(traces[0], options, out.diagnosis.law, effects);
    add_motion(records_of(traces), traces[0].trace.load_coupling, options.instruments, uncorrected, out.diagnosis);
    add_open_problems(records_of(traces), out.diagnosis);
    offer_load_variation(records_of(traces), out.diagnosis);
    take_rungs(std::move(diagnosed.fits), out);
  } else {
    out.diagnosis.verdict = Verdict::not_enough_data;
  }
  for (PreparedTrace& prepared : traces) out.traces.push_back(std::move(prepared.trace));
  return out;
}

namespace {

/// The law alone, which was enough for the runs it was fitted to, does not predict the run.
void veto_law(const Confirmation& run, Diagnosis& diagnosis) {
  if (!contradicts_law(run)) return;
  diagnosis.verdict = Verdict::unconfirmed;
  diagnosis.messages.push_back(fmt::format(
      "{} contradicts the law: with every parameter frozen the error there is {}, {} times the noise "
      "floor of {} of that run",
      run.path, general(run.final_rmse, 3), general(run.final_rmse / run.floor_rmse, 2), general(run.floor_rmse, 3)));
}

}  // namespace

void veto(const std::vector<Confirmation>& confirmations, Diagnosis& diagnosis) {
  const Verdict found = diagnosis.verdict;
  for (const Confirmation& run : confirmations) {
    if (found == Verdict::sufficient) veto_law(run, diagnosis);
    if (found != Verdict::effect_found || !std::isfinite(run.final_rmse) || is_confirmed(run)) continue;
    diagnosis.verdict = Verdict::unconfirmed;
    diagnosis.messages.push_back(
        fmt::format("{} does not bear out what was found: there the error goes from {} to "
                    "{} (p = {})",
                    run.path, general(run.base_rmse, 4), general(run.final_rmse, 4), general(run.p_value, 2)));
  }
}

std::vector<std::string> exclude_copies(std::vector<PreparedTrace>& traces) {
  std::vector<std::string> copies;
  std::vector<PreparedTrace> kept;
  for (PreparedTrace& next : traces) {
    std::string copy;
    for (std::size_t k = 0; k < kept.size() && copy.empty(); ++k) copy = copy_of(next.trace, kept[k].trace);
    if (copy.empty()) {
      kept.push_back(std::move(next));
    } else {
      copies.push_back(std::move(copy));
    }
  }
  traces = std::move(kept);
  return copies;
}

Confirmation confirm(const Identification& trace, const std::vector<Fit>& rungs) {
  Confirmation out;
  out.path = trace.path;
  out.base_rmse = out.final_rmse = std::numeric_limits<double>::quiet_NaN();
  if (!trace.analysed) return out;
  const Fit base = evaluate_frozen(rungs.front(), trace.motion, trace.segmentation);
  const Fit last = evaluate_frozen(with_values_of_record(rungs.back(), trace), trace.motion, trace.segmentation);
  out.base_rmse = base.error.rmse;
  out.final_rmse = last.error.rmse;
  out.floor_rmse = own_floor(rungs.back(), trace);
  const Comparison comparison = compare_held_out(last, base);
  out.p_value = comparison.first_better ? 0.5 * comparison.p_value : 1 - 0.5 * comparison.p_value;
  return out;
}

void add_confirmation(const Identification& trace, DiagnosedTraces& diagnosed) {
  for (const Identification& other : diagnosed.traces) {
    std::string copy = copy_of(trace, other);
    if (copy.empty()) continue;
    diagnosed.traces.front().warnings.push_back(std::move(copy));
    return;
  }
  diagnosed.diagnosis.confirmations.push_back(confirm(trace, diagnosed.rungs));
}

}  // namespace tribofit::diagnosis
