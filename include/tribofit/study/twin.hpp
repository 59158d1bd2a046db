#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/fit/identification.hpp"
#include "tribofit/study/block_motion.hpp"
#include "tribofit/study/identified.hpp"

namespace tribofit {

/// Standard errors from which a measure counts as off: of the ten measures of a twin that is right, one in forty twins
/// has one beyond.
inline constexpr double kTwinIsOff = 3;

/// One measure of the motion, as measured and as each twin has it. SI; `si` is one of `unit`.
struct TwinMeasure {
  std::string name, unit;
  double si = 1;
  double measured = 0, measured_std_error = 0;
  struct Simulated {
    double value = 0;
    double std_error = 0;   ///< of one record of this length, with the uncertainty of law and rig
    double difference = 0;  ///< simulated less measured, in standard errors
  };
  std::vector<Simulated> simulated;  ///< one a column
};

/// A measured motion beside those that law and rig predict.
///
/// Each law is simulated on the rig beside it at the record's own conditions (speed of the disc, load, length, rate,
/// noise, break-away scatter); the simulated records are taken through the same segmentation, and compared. Each
/// simulation has numbers of its own, drawn from the covariances of law and rig, and a scatter of its own; it is a
/// record that the fit could have been made to. What the record owes to the levels at which it happened to break away
/// is no error of the twin: the simulated value is the one at the mean break-away of the record, by a straight line
/// through the simulations, and its standard error that of one more record beside this line (Student's t with the
/// number of simulations less two). To it comes what the measured mean is known less well than those of the
/// simulations. Of break-away itself the mean of the simulations is compared. A difference beyond three is not chance.
///
/// The phase portrait is the mean slip in the plane of displacement and velocity; its `value` and `difference` are the
/// root mean square over the loop of the differences in standard errors, its measured value is zero.
/// Cost: about 1 us a sample and simulation.
struct Twin {
  std::vector<std::string> columns;    ///< names of the laws
  std::vector<TwinMeasure> measures;   ///< the last is the phase portrait
  std::vector<double> rms_difference;  ///< over the measures, in standard errors, one a column
  std::vector<std::string> messages;
  std::string reason;           ///< why there is no twin; empty where there is one
  std::size_t simulations = 0;  ///< behind each column

  BlockMotion measured;                ///< three cycles of the record; empty where no three are whole
  std::vector<BlockMotion> simulated;  ///< and of the first simulation of each column

  /// Names of the measures in which a column is off by more than kTwinIsOff, the worst first.
  std::vector<std::string> failures(std::size_t column) const;
  /// The last column, which the user believes in, is off in none of them.
  bool agrees() const;
  /// A column beside the others: the bare law by its name, one with effects by what it adds.
  std::string short_name(std::size_t column) const;
};

/// A trace beside the motions that its laws and its rig predict; see pipeline.hpp.
struct TwinIdentification {
  /// Its `fits`: the best bare law, then the best law with the effects asked for. Its `motion` holds neither friction
  /// nor v_r any more where twins were simulated, for the memory they take.
  Identification trace;
  std::vector<RigFit> rigs;  ///< beside each of them, see rig_beside()
  Twin twin;

  /// Means over cycles may agree while the law misses what goes up and down between them.
  bool law_falls_short() const;
};

struct TwinOptions {
  std::size_t simulations = 24;  ///< of each column; fewer for long records, at least 8
  std::uint64_t seed = 1;
  int threads = 0;
  std::function<void(std::string_view, double)> progress = {};  ///< what is being done and the part done
};

/// Fits the bare laws of the options to a trace that was prepared, then the laws with the effects of friction among
/// them; identifies the rig beside the best of each, and simulates their twins. Without stick-slip, a law or a rig the
/// trace is refused, and `out.twin.reason` says why.
void add_twins(const IdentifyOptions& options, TwinOptions more, TwinIdentification& out);

}  // namespace tribofit
