#include "tribofit/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/diagnose_traces.hpp"
#include "fit/fit_laws.hpp"
#include "fit/requested_effects.hpp"
#include "ingest/stated_conditions.hpp"
#include "segmentation/counts.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/kinematics/clock_offset.hpp"
#include "tribofit/study/twin.hpp"

namespace tribofit {

namespace {

Trace read_file(const std::string& path, const ReadOptions& given, const Instruments& instruments) {
  ReadOptions read = with_declared_conditions(given, instruments);
  read.clock_offset = estimate_clock_offset;
  return read_trace(path, read);
}

constexpr const char* kFilterInModel =
    "the declared filter of the force sensor stands in every model, held as declared";

/// What a trace is read for.
enum class Purpose { anything, law, rig };

/// Values are given of parameters that records of another kind have.
void refuse_given_of_others(const IdentifyOptions& options, const Motion& motion, bool is_driven) {
  const std::vector<GivenParameter>& given = is_driven ? options.fit.given : options.rate_state.given;
  if (given.empty()) return;
  const std::string_view driven = "velocity steps and holds", others = "laws of sliding speed";
  throw InputError(
      fmt::format("{} is a parameter of {}; this record is of {}", given.front().name, is_driven ? others : driven,
                  motion.kind ? fmt::format("the kind {}", to_string(*motion.kind)) : "another kind"),
      "leave it out of --start and --bounds, or state the kind of the record with --kind");
}

Identification facts_of(const std::string& path, const Trace& trace) {
  Identification out;
  out.path = path;
  out.checksum = trace.checksum;
  out.samples = trace.size();
  out.duration = trace.duration();
  out.rate = trace.rate();
  out.notes = trace.notes;
  out.warnings = trace.warnings;
  return out;
}

/// The stages behind the motion of a trace: segment, check.
Identification segment(Identification out, Motion motion, const IdentifyOptions& options, Purpose purpose) {
  out.motion = std::move(motion);
  if (out.motion.is_points()) out.duration = out.rate = std::nan("");
  stop_point();
  const bool driven = is_driven_in_steps(out.motion.kind);
  refuse_given_of_others(options, out.motion, driven);
  const bool has_spectrum = !driven && !out.motion.is_points() && out.motion.kind != RecordKind::force_only;
  run_tasks(2, options.threads, [&](std::size_t k) {
    if (k == 0) out.segmentation = find_cycles(out.motion, options.threads);
    if (k == 1 && has_spectrum) out.spectral_peak = fundamental(out.motion.relative_velocity, out.motion.step);
  });
  if (options.check_kind) options.check_kind(kind_of_record(out.motion, out.segmentation));
  stop_point();
  if (!driven) exclude(options.selection, out.motion, out.segmentation);
  if (out.motion.kind == RecordKind::force_only) out.force_statistics = force_statistics(out.motion);
  if (out.motion.kind == RecordKind::motion_only) out.friction_levels = friction_levels(out.motion, out.segmentation);
  out.notes.insert(out.notes.end(), out.motion.notes.begin(), out.motion.notes.end());
  out.notes.insert(out.notes.end(), out.segmentation.notes.begin(), out.segmentation.notes.end());

  for (std::string& warning :
       warnings_beside_declared(out.motion.conditions, options.instruments, purpose == Purpose::rig))
    out.warnings.push_back(std::move(warning));
  require_channels(options.effects, out.motion, out);
  if (driven && purpose == Purpose::anything) return out;
  for (std::string& obstacle : obstacles(out.motion, out.segmentation, purpose != Purpose::rig))
    out.refuse(std::move(obstacle));
  return out;
}

/// Of a trace in memory: what is prepared again is not read again.
Identification prepare(const std::string& path, Trace trace, const IdentifyOptions& options,
                       const MotionOptions& motion, Purpose purpose) {
  Identification facts = facts_of(path, trace);
  MotionOptions corrected = with_corrections(motion, options.effects);
  corrected.threads = options.threads;
  return segment(std::move(facts), compute_motion(std::move(trace), options.instruments, corrected), options, purpose);
}

const Trace& in_memory(const TraceInput& input) {
  if (!input.trace) throw std::invalid_argument("a trace is prepared that was not read");
  return *input.trace;
}

Trace taken(const TraceInput& input, const IdentifyOptions& options) {
  return input.trace ? *input.trace : read_file(input.path, input.read, options.instruments);
}

/// What effects of friction need is checked when they are fitted.
IdentifyOptions of_the_motion(IdentifyOptions options) {
  options.effects = kinematic_effects(options.effects);
  return options;
}

/// Rate-and-state friction of a contact whose load point is driven in steps.
void fit_driven(const IdentifyOptions& options, Identification& trace) {
  if (!options.effects.empty())
    trace.refuse("effects are of laws of sliding speed: velocity steps and holds are fitted by rate and state alone");
  if (!trace.analysed) return;
  if (options.rate_state.given_in_newtons && trace.motion.friction_kind != FrictionKind::force)
    throw InputError("a, b or k was given in newtons, and friction is a coefficient",
                     "give a and b without a unit, and k as in 0.005/um");
  RateStateOptions own = options.rate_state;
  own.threads = options.threads;
  own.excluded = options.selection.excluded;
  trace.rate_state = fit_rate_state(trace.motion, own);
  for (const std::string& message : trace.rate_state->messages) trace.warnings.push_back(message);
  if (!trace.rate_state->fitted()) trace.refuse(trace.rate_state->reason);
}

}  // namespace

Identification identify(const std::string& path, const IdentifyOptions& options) {
  const auto prepared = [&](Trace trace, const IdentifyOptions& as) {
    return prepare(path, std::move(trace), of_the_motion(as), as.motion, Purpose::anything);
  };
  Trace trace = read_file(path, options.read, options.instruments);
  std::optional<Trace> kept;  // a declared filter may stand in the model
  if (options.instruments.force_sensor.bandwidth && options.motion.undo_bandwidth) kept = trace;
  Identification out = prepared(std::move(trace), options);
  const IdentifyOptions modelled = with_declared_filter(options, out.motion);
  if (kept && !modelled.motion.undo_bandwidth) {
    out = prepared(*std::move(kept), modelled);
    out.notes.push_back(kFilterInModel);
  }
  fit_trace(modelled, out);
  if (out.fits.empty()) return out;
  const Record record = {&out.motion, &out.segmentation};
  out.remaining = remaining_over({&record, 1}, out.fits[out.best], options.threads);
  return out;
}

std::shared_ptr<const Trace> read_input(const TraceInput& input, const IdentifyOptions& options) {
  if (input.trace) return input.trace;
  return std::make_shared<const Trace>(taken(input, options));
}

Identification prepare_trace(const TraceInput& input, const IdentifyOptions& options) {
  return prepare(input.path, in_memory(input), of_the_motion(options), options.motion, Purpose::anything);
}

Identification prepare_trace(const TraceInput& input, const IdentifyOptions& options, const Motion& uncorrected) {
  Motion motion = uncorrected;
  correct_plateau(motion, with_corrections(options.motion, options.effects).plateau);
  return segment(facts_of(input.path, in_memory(input)), std::move(motion), of_the_motion(options), Purpose::anything);
}

void fit_trace(const IdentifyOptions& options, Identification& trace) {
  if (!is_driven_in_steps(trace.motion.kind)) return fit_trace(options, trace.motion, trace);
  trace.fits.clear();
  trace.best = 0;
  fit_driven(options, trace);
}

void fit_trace(const IdentifyOptions& options, const Motion& motion, TracePart& part) {
  part.fits.clear();
  part.best = 0;
  require_channels(friction_effects(options.effects), motion, part);
  require_formulas(options.effects, motion, part);
  if (part.analysed) fit_laws(options, motion, part);
}

DiagnosedTraces diagnose(const std::vector<TraceInput>& inputs, const IdentifyOptions& options) {
  return diagnose(inputs, options, {});
}

DiagnosedTraces diagnose(const std::vector<TraceInput>& inputs, const IdentifyOptions& given,
                         const DiagnoseOptions& more) {
  refuse_same(given.effects);
  std::vector<TraceInput> read = inputs;
  for (TraceInput& input : read) input.trace = read_input(input, given);
  IdentifyOptions options = given;
  if (given.instruments.force_sensor.bandwidth && !read.empty())
    options = with_declared_filter(given, prepare_trace(read.front(), given).motion);
  IdentifyOptions kinematic = options;
  kinematic.effects = kinematic_effects(options.effects);
  const auto prepared = [&kinematic](const TraceInput& input, const IdentifyOptions& as) {
    const auto again = [&kinematic, input](const MotionOptions& motion) {
      return prepare(input.path, in_memory(input), kinematic, motion, Purpose::law);
    };
    return diagnosis::prepare_to_diagnose(again, as);
  };
  std::vector<diagnosis::PreparedTrace> traces;
  for (const TraceInput& input : read) traces.push_back(prepared(input, options));
  const std::vector<std::string> copies = diagnosis::exclude_copies(traces);
  DiagnosedTraces out = diagnosis::diagnose_traces(std::move(traces), options, more.diagnosis);
  Identification& first = out.traces.front();
  first.warnings.insert(first.warnings.end(), copies.begin(), copies.end());
  if (options.effects.size() > given.effects.size()) first.notes.push_back(kFilterInModel);
  if (out.rungs.empty()) return out;
  IdentifyOptions as_diagnosed = options;
  as_diagnosed.motion.friction_low_pass = diagnosis::shared_friction_filter(out.traces);
  for (TraceInput input : more.confirm) {
    input.trace = read_input(input, given);
    diagnosis::add_confirmation(prepared(input, as_diagnosed).trace, out);
  }
  diagnosis::veto(out.diagnosis.confirmations, out.diagnosis);
  return out;
}

RigIdentification identify_rig(const TraceInput& input, const IdentifyOptions& options) {
  RigIdentification out{prepare(input.path, taken(input, options), options, options.motion, Purpose::rig), {}};
  if (out.trace.analysed) {
    out.rig = identify_rig(out.trace.motion, out.trace.segmentation, options.instruments);
  } else {
    out.rig.reason = out.trace.warnings.back();
  }
  out.trace.analysed = out.rig.determined;
  return out;
}

TwinIdentification identify_twin(const TraceInput& input, const IdentifyOptions& options) {
  return identify_twin(input, options, {});
}

TwinIdentification identify_twin(const TraceInput& input, const IdentifyOptions& options, const TwinOptions& more) {
  TwinIdentification out{prepare(input.path, taken(input, options), options, options.motion, Purpose::rig), {}, {}};
  require_formulas(options.effects, out.trace.motion, out.trace);
  add_twins(options, more, out);
  return out;
}

}  // namespace tribofit
