#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit::diagnosis {

/// Reads, moves and segments one trace with other motion options than before.
using PrepareTrace = std::function<Identification(const MotionOptions&)>;

/// A trace that can be prepared again.
struct PreparedTrace {
  Identification trace;
  MotionOptions motion;  ///< what was done in the end, but for the plateau
  PrepareTrace prepare;
};

/// Which part the effects that a user names have in a diagnosis.
struct EffectRoles {
  std::vector<Effect> kinematic;       ///< corrected before any fit
  std::vector<Effect> from_the_start;  ///< of the catalogue: in every model
  std::vector<Effect> candidates;      ///< formulas: candidates beside the catalogue
};
EffectRoles roles_of(const std::vector<Effect>& effects);

/// A fit of several records as the first of them has it.
Fit of_first_record(const Fit& joint);

/// A trace as the diagnosis reads it. A high-pass that nobody declared is not undone where a contact that turns with
/// the disc lets the plateau sag as well or better; a plateau that is off is corrected; a load that follows friction
/// within every cycle is freed of it.
PreparedTrace prepare_to_diagnose(const PrepareTrace& prepare, const IdentifyOptions& options);

/// The low-pass of the force sensor that the traces of a diagnosis were read through (0: none), for others of that
/// sensor; nothing where none of them shows whether there is one.
std::optional<Estimate> shared_friction_filter(const std::vector<Identification>& traces);

/// Leaves one of those that hold the same values: a copy of a record is no repeat of it. Returns what was left out.
std::vector<std::string> exclude_copies(std::vector<PreparedTrace>& traces);

/// Diagnoses the traces together. A trace without what `options.effects` need is refused, and nothing is diagnosed.
/// Corrections of the plateau that nobody asked for are taken back where the effect that was found explains it.
DiagnosedTraces diagnose_traces(std::vector<PreparedTrace> traces, const IdentifyOptions& options,
                                const DiagnosisOptions& diagnosis);

/// The last rung against the base law on a trace that was held back, every parameter frozen.
Confirmation confirm(const Identification& trace, const std::vector<Fit>& rungs);

/// Adds how the last rung does on a trace that was held back. A copy of a trace that was diagnosed confirms nothing: it
/// is only warned of.
void add_confirmation(const Identification& trace, DiagnosedTraces& diagnosed);

/// A confirmation that fails vetoes what was found: on a run that was held back the last rung is no better than the
/// base law, or no better than chance would have it. So does a run far above its own noise floor, where no effect was
/// found and the law was enough.
void veto(const std::vector<Confirmation>& confirmations, Diagnosis& diagnosis);

/// Diagnoses records together, as the options say.
using DiagnoseRecords = std::function<Diagnosed(std::span<const Record>)>;

/// Says that the law differs from run to run, where each run by itself is described down to its noise floor and all
/// together are not. Effects that a single run could show and none does are withdrawn: they follow what differs between
/// the runs. What only several runs show together (ageing over speeds, a load law) stays.
/// Costs a diagnosis of each of the longest runs, only where that of all leaves an error well above the noise floor.
void withhold_of_differing_runs(const std::vector<PreparedTrace>& traces, const DiagnoseRecords& diagnose_records,
                                Diagnosed& diagnosed);

}  // namespace tribofit::diagnosis
