#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// One quantity over several runs, in `unit`. The parts of the error are kept apart: what cycles leave within runs
/// (statistical), what differs from run to run beyond that (between), and what all runs share (systematic).
struct PooledValue {
  std::string name, unit;
  std::string effect;                 ///< key; empty for the base law and for measures
  std::size_t runs = 0;               ///< that state it with a finite error
  double value = 0;                   ///< mean, each run weighted by its own error and the scatter between runs
  double std_error = 0;               ///< statistical and between-run parts together; of one run: statistical alone
  double lower95 = 0, upper95 = 0;    ///< from std_error, t distribution
  double statistical = 0;             ///< standard error that the runs' own errors would leave
  double between = 0;                 ///< standard deviation between runs beyond their own errors; NaN with one run
  double systematic = 0;              ///< from the declared instruments, shared by all runs; 0 where none is declared
  double mean = 0;                    ///< plain mean, as [D] Fig 5 and 9
  double standard_error_of_mean = 0;  ///< NaN of one run
};

/// Runs made under the same conditions.
struct PooledGroup {
  struct OfFit {
    std::string law, protocol;
    std::vector<PooledValue> parameters;
    std::size_t best_in = 0;  ///< runs in which this law predicts held-out cycles best
  };

  /// Fits with this law and protocol; null where there are none.
  const OfFit* fit(std::string_view law, std::string_view protocol) const;

  Conditions conditions;  ///< as used by the first of them
  std::vector<OtherCondition> others;
  std::vector<std::size_t> runs;      ///< indices of the results given
  std::vector<OfFit> fits;            ///< joint fits first
  std::vector<PooledValue> measures;  ///< frequency, amplitude, stick_time, slip_time, rms_velocity
};

/// Pools repeats: runs whose stated conditions (radius, speed, load, any further one but the order) are equal.
///
/// The mean over runs of y_i with errors v_i and scatter tau^2 between them: see meta_regression(); intervals cover
/// with two runs as with thirty, of few cycles as of many, and are no narrower than the runs' own errors allow. A
/// parameter on its bound, or with an error that is not known, is not used. Groups in the order of their first run;
/// runs that were not fitted are in none. Cost: linear in runs.
std::vector<PooledGroup> pool_repeats(std::span<const RunResult> runs);

/// What a run says of a quantity.
struct RunValue {
  double value = 0, std_error = 0, systematic = 0;
  double freedom = 1e6;  ///< degrees of freedom of std_error; by default it is known
};

/// Pools one quantity over runs; those with errors that are not finite and positive are not used.
PooledValue pool(std::string name, std::string unit, std::vector<RunValue> runs);

// Values of repeats together, as [D] has them in Fig 5 to 9: plain means over the runs of a group.

/// The pooled value of that name of the base law or a measure; null where there is none.
const PooledValue* pooled_value(const std::vector<PooledValue>& values, std::string_view name);

/// Its plain mean with the standard error; nothing where there is none.
std::optional<Estimate> pooled_mean(const std::vector<PooledValue>& values, std::string_view name);

/// mu_s - mu_k over the runs of a group: mean and standard error, as [D] Fig 9 has its means; not known for a
/// law without these levels.
Estimate drop_of(std::span<const RunResult> runs, const PooledGroup& group, const PooledGroup::OfFit& pooled);

/// Amplitude of the fundamental of v_r over the runs of a group [mm/s]; none where no run has figures.
std::optional<Estimate> fundamental_of(const ResultReader& results, std::span<const RunResult> runs,
                                       const PooledGroup& group);

/// What the figures of one run show.
struct FiguresOfRun {
  std::string run;  ///< its name
  RunFigures figures;
};

/// The first run of a group that has figures; nothing where none has.
std::optional<FiguresOfRun> first_figures(const ResultReader& results, std::span<const RunResult> runs,
                                          const PooledGroup& group);

/// A parameter of a law that is no level: neither mu_s nor mu_k, nor of an effect.
struct OtherParameter {
  std::string law, name, unit;
};
/// Those that any group has, in the order in which they are met.
std::vector<OtherParameter> other_parameters(std::span<const PooledGroup> groups);

/// Law and protocol of each estimate of the levels mu_s and mu_k; per-cycle extremes give the same whatever the law.
std::vector<std::pair<std::string, std::string>> kinds_of_levels(std::span<const PooledGroup> groups);

/// The condition over which groups of repeats are shown: the one that takes most values, else their number.
struct OverConditions {
  explicit OverConditions(std::span<const PooledGroup> groups);
  /// At most so many groups, evenly, in the order of the series.
  std::vector<std::size_t> some(std::size_t most) const;

  /// Groups of one line, by rising abscissa, and what they have in common ("50 N").
  struct Series {
    std::string name;
    std::vector<std::size_t> groups;
    std::vector<double> x;
  };
  std::string quantity = "conditions", unit;  ///< "friction radius", "mm"; "conditions" for their number
  std::vector<std::string> names;             ///< the conditions of each group where they are only numbered
  std::vector<Series> series;
  std::vector<double> x;  ///< of each group
};

}  // namespace tribofit
