#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// One quantity over several runs, in `unit`. The parts of the error are kept apart: what cycles leave within runs
/// (statistical), what differs from run to run beyond that (between), and what all runs share (systematic).
struct PooledValue {
  std::string name, unit;
  std::string effect;               ///< key; empty for the base law and for measures
  std::size_t runs = 0;             ///< that state it with a finite error
  double value = 0;                 ///< mean, each run weighted by its own error and the scatter between runs
  double std_error = 0;             ///< statistical and between-run parts together; of one run: statistical alone
  double lower95 = 0, upper95 = 0;  ///< from std_error, t distribution
  double statistical = 0;           ///< standard error that the runs' own errors would leave
  double between = 0;               ///< standard deviation between runs beyond their own errors; NaN with one run
  double systematic = 0;            ///< from the declared instruments, shared by all runs; 0 where none is declared
  double mean = 0, standard_error_of_mean =
                       0;  ///< plain mean and its standard error, as [D] Fig 5 and 9; the error NaN of one run
};

/// Runs made under the same conditions.
struct PooledGroup {
  struct OfFit {
    std::string law, protocol;
    std::vector<PooledValue> parameters;
    std::size_t best_in = 0;  ///< runs in which this law predicts held-out cycles best
  };

  Conditions conditions;  ///< as used by the first of them
  std::vector<OtherCondition> others;
  std::vector<std::size_t> runs;      ///< indices of the results given
  std::vector<OfFit> fits;            ///< joint fits first
  std::vector<PooledValue> measures;  ///< frequency, amplitude, stick_time, slip_time, rms_velocity
};

/// Pools repeats: runs whose stated conditions (radius, speed, load, any further one but the order) are equal.
///
/// The mean over runs of y_i with errors v_i and scatter tau^2 between them: see meta_regression(); intervals cover
/// with three runs as with thirty. A parameter on its bound, or with an error that is not known, is not used.
/// Groups in the order of their first run; runs that were not fitted are in none. Cost: linear in runs.
std::vector<PooledGroup> pool_repeats(std::span<const RunResult> runs);

/// Pools one quantity. values, std_errors, systematic: one per run, those with errors that are not finite and positive
/// are not used; systematic may be empty.
PooledValue pool(std::string name, std::string unit, std::span<const double> values, std::span<const double> std_errors,
                 std::span<const double> systematic = {});

}  // namespace tribofit
