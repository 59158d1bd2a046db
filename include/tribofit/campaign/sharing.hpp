#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/pool.hpp"

namespace tribofit {

/// Which parameters of a law the runs of a campaign have in common. One that is not named is free in every run.
struct Sharing {
  /// One value for all runs, or, with a condition ("radius", "speed", "load" or a further column), one for each of its
  /// values.
  struct Common {
    std::string parameter, condition;
  };
  std::vector<Common> common;
};

/// Reads "alpha" (share) and "mu_s:radius" (vary; the condition is required). Throws InputError, also for a parameter
/// that is named twice.
Sharing sharing_from(const std::vector<std::string>& share, const std::vector<std::string>& vary);

/// A campaign in which some parameters are common to runs.
struct SharedFit {
  struct Parameter {
    std::string name, condition;      ///< condition empty: one value for all runs
    std::vector<std::string> levels;  ///< values of the condition, as shown; one empty text where there is none
    std::vector<PooledValue> values;  ///< one a level

    /// "mu_s at radius 9 mm".
    std::string at(std::size_t level) const {
      return condition.empty() ? name : name + " at " + condition + " " + levels[level];
    }
  };
  /// Parameters of one run, given what is common: those that are free move with the common ones, as far as the run's
  /// own data tie them together.
  struct OfRun {
    std::size_t run = 0;                   ///< index of the results given
    std::vector<double> value, std_error;  ///< in the order and units of the law's parameters
  };

  /// Whether the runs allow what they are made to share.
  struct Test {
    double p_value = std::numeric_limits<double>::quiet_NaN();  ///< that they differ by chance alone; NaN: not tested
    double ratio = 1;  ///< how much more they differ, in squares, than their own errors say
    bool is_refused = false;
    std::string most_different;  ///< name of the run
    /// Held-out error of the runs fitted together and each by itself [1 or N]; p-value of the difference.
    double held_out_together = std::numeric_limits<double>::quiet_NaN();
    double held_out_alone = std::numeric_limits<double>::quiet_NaN(), held_out_p_value = 1;
  };

  std::string law;
  bool is_joint = false;  ///< one fit of all samples; otherwise the single fits together
  Test test;
  std::vector<std::string> names, units;  ///< of all parameters of the law
  std::vector<Parameter> common;
  std::vector<OfRun> runs;
  std::vector<std::string> notes;  ///< runs or parameters that are not used, and why
};

/// Fits the runs of a campaign together, one fit for each law.
///
/// With `results`, all samples of all runs are fitted at once, as each run keeps them condensed: what no run knows by
/// itself comes out where all together know it. Whether the runs allow the sharing is tested by what each pulls at the
/// common values; where they do not, and each run knows what is shared, or where there is no such fit (too many
/// values, effects that act on more than speed), the single fits are combined:
///
/// Run i states y_i = (s_i, f_i) with covariance V_i. For the common parameters s_i = level + u_i + e_i with u_i the
/// scatter between runs; a free parameter has no such prior, so the runs' marginal for s_i alone gives what is common
/// (generalised least squares with the free parameters profiled out), level by level as in pool(). Then
/// f_i = y_f + V_fs V_ss^-1 (s^_i - y_s), with s^_i the best prediction of the run's own value. This is the two-stage
/// form of a mixed model (L. B. Sheiner, S. L. Beal; M. Davidian, D. M. Giltinan, Nonlinear Models for Repeated
/// Measurement Data, 1995, ch. 5): exact where the runs' likelihoods are normal. Throws InputError for a parameter no
/// law has and for a condition the runs do not state, with the nearest known name. runs: those of `results`.
std::vector<SharedFit> fit_shared(std::span<const RunResult> runs, const Sharing& sharing,
                                  const ResultReader* results = nullptr);

}  // namespace tribofit
