#pragma once

/// Conventions of the whole house, stated here once:
/// - SI inside. Units are converted at two doors only: ingest/ on the way in, report/ and the command line on the way
/// out.
/// - v_r = omega r - v_b ([D] Eq 4); mu is positive when v_r is; time is in seconds from the trace's first sample.
/// - Options in, results out, valid on construction. A fit that fails is a result with a reason. Bad input throws
///   InputError (ingest/input_error.hpp) with file, line, column and what to do; a wrong call from code (a wrong count
///   of parameters) throws std::invalid_argument.
/// - Library code never prints and never exits. Results are the same to the last bit for any number of threads.
/// - [D]: Stick-Slip Characteristic Analysis of High-Speed Train Brake Systems: A Disc-Block Friction System with
/// Different
///   Friction Radii (2023).

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/rig.hpp"
#include "tribofit/ingest/instruments.hpp"
#include "tribofit/ingest/read_trace.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"
#include "tribofit/statistics/spectrum.hpp"
#include "tribofit/study/twin.hpp"

namespace tribofit {

struct IdentifyOptions {
  ReadOptions read;
  Instruments instruments;
  MotionOptions motion;
  FitOptions fit;
  std::vector<BaseLaw> laws = {BaseLaw::exponential, BaseLaw::fractional};
  int threads = 0;                 ///< 0: as many as there are; the result does not depend on it
  std::vector<Effect> effects;     ///< added to every law
  bool published_protocol = true;  ///< fit by the published protocol too, beside the joint one
  Selection selection;             ///< what part of the record is fitted
};

/// Everything known about one trace.
struct Identification {
  std::string path;
  std::uint64_t checksum = 0;
  std::size_t samples = 0;
  double duration = 0, rate = 0;  ///< [s], [Hz]
  Motion motion;
  Segmentation segmentation;
  SpectralPeak spectral_peak;      ///< of v_r
  Estimate load_coupling = {};     ///< found in the load channel by a diagnosis and taken out of it; 0: none
  std::vector<Fit> fits;           ///< joint fits first, in the order of options.laws, then the published ones
  std::size_t best = 0;            ///< the fit that predicts held-out cycles best
  std::vector<std::string> notes;  ///< how the input was read
  std::vector<std::string> warnings;
  bool analysed = true;  ///< false: the data were read but cannot carry the analysis, warnings say why
};

/// One input file with what is known of it beforehand (a manifest's row over the command line).
struct TraceInput {
  std::string path;
  ReadOptions read = {};
  std::shared_ptr<const Trace> trace = {};  ///< already in memory (a simulation): `path` is its name, nothing is read
};

struct DiagnoseOptions {
  DiagnosisOptions diagnosis;
  std::vector<TraceInput> confirm;  ///< runs that take no part and on which the finding is tried
};

/// A diagnosis of one trace, or of several together with shared parameters.
struct DiagnosedTraces {
  std::vector<Identification> traces;  ///< as given; their `fits` are of each trace alone and empty where several are
                                       ///< diagnosed together
  std::vector<Fit> fits;   ///< the bare laws, then the last rung of the ladder where it holds more; all traces together
  std::size_t best = 0;    ///< index in `fits`
  std::vector<Fit> rungs;  ///< the models of the ladder, the base law first
  Diagnosis diagnosis;
  bool analysed = true;  ///< false: some trace cannot carry the analysis, its warnings say why
};

/// The stages in order: read, move, segment, fit, diagnose. options.effects are candidates of the user beside the
/// catalogue (formulas), or part of the model from the start (catalogue effects). `options.read` is not used: each
/// input brings its own.
DiagnosedTraces diagnose(const std::vector<TraceInput>& inputs, const IdentifyOptions& options = {},
                         const DiagnoseOptions& more = {});

/// The rig behind one trace.
struct RigIdentification {
  Identification trace;  ///< without fits; `analysed` is that of the rig
  RigFit rig;
};

/// The stages in order: read, move, segment, balance the forces. Needs no law: of `options`, reading, instruments and
/// motion are used.
RigIdentification identify_rig(const TraceInput& input, const IdentifyOptions& options = {});

/// A trace beside the motions that its laws and its rig predict.
struct TwinIdentification {
  Identification trace;      ///< its `fits`: the best bare law, then the best law with the effects asked for
  std::vector<RigFit> rigs;  ///< beside each of them, see rig_beside()
  Twin twin;
};

/// The stages in order: read, move, segment, fit, balance the forces, simulate. The bare laws of `options` are fitted
/// and the better one has a twin; with options.effects the better law with all of them has one beside it.
TwinIdentification identify_twin(const TraceInput& input, const IdentifyOptions& options = {},
                                 const TwinOptions& more = {});

/// The stages in order: read, move, segment, fit.
Identification identify(const std::string& path, const IdentifyOptions& options = {});

/// A trace as it is read for the stages that follow: with what options.instruments declares of its conditions.
std::shared_ptr<const Trace> read_input(const TraceInput& input, const IdentifyOptions& options = {});

/// The stages up to the cycles: read, move, segment. Effects of the motion among options.effects are corrected.
Identification prepare_trace(const TraceInput& input, const IdentifyOptions& options = {});

/// The stage after them, for a trace that prepare_trace() made with the same effects of the motion and the same
/// selection: fits take the place of those it has. Warnings are added to those it has.
/// quick: effects are fitted to means of a few samples where a slip has many, which moves parameters by up to about one
/// standard error; the bare laws are always.
enum class FitDetail { full, quick };
void fit_trace(const IdentifyOptions& options, Identification& trace, FitDetail detail = FitDetail::full);

}  // namespace tribofit
