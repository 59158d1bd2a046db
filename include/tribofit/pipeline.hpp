#pragma once

/// Conventions of the whole library, stated here once:
/// - SI inside. Units are converted at two boundaries only: ingest/ on the way in, report/ and the command line on the
///   way out.
/// - v_r = omega r - v_b ([D] Eq 4); mu is positive when v_r is; time is in seconds from the trace's first sample.
/// - Options in, results out, valid on construction. A fit that fails is a result with a reason. Bad input throws
///   InputError (ingest/input_error.hpp) with file, line, column and what to do; a wrong call from code (a wrong count
///   of parameters) throws std::invalid_argument.
/// - Library code never prints and never exits. Results are the same to the last bit for any number of threads.
/// - [D]: Stick-Slip Characteristic Analysis of High-Speed Train Brake Systems: A Disc-Block Friction System with
///   Different Friction Radii (2023).

#include <memory>
#include <string>
#include <vector>

#include "tribofit/fit/identification.hpp"

namespace tribofit {

struct DiagnosedTraces;     // diagnosis/diagnosis.hpp
struct DiagnoseOptions;     // diagnosis/diagnosis.hpp
struct TwinIdentification;  // study/twin.hpp
struct TwinOptions;         // study/twin.hpp

/// The stages in order: read, move, segment, fit.
Identification identify(const std::string& path, const IdentifyOptions& options = {});

/// A trace as it is read for the stages that follow: with what options.instruments declares of its conditions.
std::shared_ptr<const Trace> read_input(const TraceInput& input, const IdentifyOptions& options = {});

/// The stages after reading, up to the cycles: move, segment. Effects of the motion among options.effects are
/// corrected. The trace is in memory (read_input): preparing never touches the disc.
Identification prepare_trace(const TraceInput& input, const IdentifyOptions& options = {});
/// The same where the motion of the trace without effects of the motion is known: the corrections are made to a copy of
/// it, and nothing is looked for again.
Identification prepare_trace(const TraceInput& input, const IdentifyOptions& options, const Motion& uncorrected);

/// The stage after them, for a trace that prepare_trace() made with the same effects of the motion and the same
/// selection: fits take the place of those it has. Warnings are added to those it has.
void fit_trace(const IdentifyOptions& options, Identification& trace);
/// The same for a part of a trace whose motion others use at the same time.
void fit_trace(const IdentifyOptions& options, const Motion& motion, TracePart& part);

/// The stages in order: read, move, segment, fit, diagnose. options.effects are candidates of the user beside the
/// catalogue (formulas), or part of the model from the start (catalogue effects). `options.read` is not used: each
/// input brings its own.
DiagnosedTraces diagnose(const std::vector<TraceInput>& inputs, const IdentifyOptions& options = {});
DiagnosedTraces diagnose(const std::vector<TraceInput>& inputs, const IdentifyOptions& options,
                         const DiagnoseOptions& more);

/// The stages in order: read, move, segment, balance the forces. Needs no law: of `options`, reading, instruments and
/// motion are used.
RigIdentification identify_rig(const TraceInput& input, const IdentifyOptions& options = {});

/// The stages in order: read, move, segment, fit, balance the forces, simulate. The bare laws of `options` are fitted
/// and the better one has a twin; with options.effects the better law with all of them has one beside it.
TwinIdentification identify_twin(const TraceInput& input, const IdentifyOptions& options = {});
TwinIdentification identify_twin(const TraceInput& input, const IdentifyOptions& options, const TwinOptions& more);

}  // namespace tribofit
