#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/rate_state.hpp"
#include "tribofit/fit/residual_variable.hpp"
#include "tribofit/fit/rig.hpp"
#include "tribofit/ingest/instruments.hpp"
#include "tribofit/ingest/read_trace.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"
#include "tribofit/segmentation/force_statistics.hpp"
#include "tribofit/segmentation/friction_levels.hpp"
#include "tribofit/statistics/spectrum.hpp"

namespace tribofit {

/// How a trace is read, prepared and fitted.
struct IdentifyOptions {
  ReadOptions read;
  Instruments instruments;
  MotionOptions motion;
  FitOptions fit;
  std::vector<Law> laws = {Law(ExponentialLaw{}), Law(FractionalLaw{})};
  int threads = 0;                 ///< 0: as many as there are; the result does not depend on it
  std::vector<Effect> effects;     ///< added to every law
  bool published_protocol = true;  ///< fit by per-cycle extremes too, beside the joint fit
  Selection selection;             ///< what part of the record is fitted
  RateStateOptions rate_state;     ///< of velocity steps and holds
  /// Called with the kind of a record once it is known; throws where what is asked means nothing for it.
  std::function<void(RecordKind)> check_kind;
};

/// One input file with what is known of it beforehand (a manifest's row over the command line).
struct TraceInput {
  std::string path;
  ReadOptions read = {};
  std::shared_ptr<const Trace> trace = {};  ///< already in memory (a simulation): `path` is its name, nothing is read
};

/// A part of a trace, and what was fitted to it. Several parts may share one motion.
struct TracePart {
  Segmentation segmentation;
  std::vector<Fit> fits;  ///< joint fits first, in the order of options.laws, then the per-cycle extremes
  std::size_t best = 0;   ///< the fit that predicts held-out cycles best
  std::vector<ResidualVariable> remaining;  ///< with which the error of the best fit varies beyond chance, see
                                            ///< remaining_over() of diagnosis.hpp
  std::optional<RecordNoise> noise;         ///< of this part, once a fit has asked for it
  std::vector<std::string> notes;           ///< how the input was read
  std::vector<std::string> warnings;
  bool analysed = true;  ///< false: the data were read but cannot carry the analysis, warnings say why

  /// The trace cannot carry the analysis, for this reason.
  void refuse(std::string reason) {
    warnings.push_back(std::move(reason));
    analysed = false;
  }
};

/// Everything known about one trace.
struct Identification : TracePart {
  std::string path;
  std::uint64_t checksum = 0;
  std::size_t samples = 0;
  double duration = 0, rate = 0;  ///< [s], [Hz]
  Motion motion;
  SpectralPeak spectral_peak;                       ///< of v_r
  std::optional<ForceStatistics> force_statistics;  ///< of a record of friction alone
  std::optional<FrictionLevels> friction_levels;    ///< of a record whose friction follows from the motion
  std::optional<RateStateAnalysis> rate_state;      ///< of velocity steps and holds, beside which there are no fits
  Estimate load_coupling = {};  ///< found in the load channel by a diagnosis and removed from it; 0: none
};

/// How thoroughly a model is fitted. quick: a look (FitOptions::starts == 0), from the start of the data alone,
/// searched on fewer values and taken to all of them in two steps; where the data hardly determine a parameter it stays
/// where the search ended.
enum class FitDetail { full, quick };

/// The rig behind one trace.
struct RigIdentification {
  Identification trace;  ///< without fits; `analysed` is that of the rig
  RigFit rig;
};

}  // namespace tribofit
