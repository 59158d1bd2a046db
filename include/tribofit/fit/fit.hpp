#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribofit/fit/observations.hpp"
#include "tribofit/friction/model.hpp"
#include "tribofit/ingest/instruments.hpp"

namespace tribofit {

/// How parameters are found.
enum class Protocol {
  published,  ///< [D] 3.2: mu_s and mu_k as means of the per-cycle maximum in stick and minimum in slip, then the decay
              ///< factor alone
  joint       ///< all parameters together
};
/// "published", "joint": as --protocol and JSON have them.
std::string_view to_string(Protocol protocol);
/// "per-cycle extremes", "joint fit": as people read them.
std::string protocol_text(Protocol protocol);

/// What a residual adds to the sum that is minimised, by its size u in units of the width (FitOptions::loss_scale).
enum class Loss {
  squares,  ///< u^2
  huber,    ///< u^2 below 1, 2 u - 1 above
  soft_l1   ///< 2 (sqrt(1 + u^2) - 1)
};

/// What is said of one parameter beforehand, in SI.
struct GivenParameter {
  std::string name;             ///< see FrictionModel::Slot::full_name(); models without it take no notice
  std::optional<double> start;  ///< the search begins here, from every start
  struct Bounds {
    double lower = 0, upper = 0;
  };
  std::optional<Bounds> bounds;  ///< in place of the plausible ones; where they are equal the value is held
};

struct FitOptions {
  Protocol protocol = Protocol::joint;
  Loss loss = Loss::squares;
  double loss_scale = 3;  ///< where the robust losses turn from squares to straight lines, in units of Floor::noise
  int starts = 5;         ///< starting points; the first comes from the data, the others are seeded; 0: a short look,
                          ///< whose intervals may be finite where those of a fit are open
  std::uint64_t seed = 1;
  int folds = 5;              ///< contiguous blocks of cycles held out in turn
  bool profile = false;       ///< profile likelihood intervals beside the others
  std::vector<double> start;  ///< values (SI) to begin with, instead of several starts; empty: from the data
  std::vector<GivenParameter> given;
  int threads = 1;  ///< that evaluate the model on long records (0: as many as there are); the result does not depend
                    ///< on it
};

/// Rise of the squares where a parameter is held at a value [SI] and all others are refitted, in units of the rise at
/// which its 95 % interval ends.
struct ProfilePoint {
  double value = 0, rise = 0;
};

/// A fitted value with what is known of its error.
struct FittedValue {
  double value = 0;
  double std_error = 0;                             ///< statistical, from cycle to cycle; infinite where not determined
  double lower95 = 0, upper95 = 0;                  ///< statistical 95 % interval; infinite where not determined
  double systematic = 0;                            ///< standard uncertainty from the declared instruments and the
                                                    ///< clocks; NaN: not known; 0: nothing is declared
  double profile_lower95 = 0, profile_upper95 = 0;  ///< NaN unless asked for or not determined by itself
  double start = 0;                                 ///< where the search began
  bool at_bound = false;
  /// false: the data fix only a combination of it with others, or nothing of it within its bounds; a message says so.
  bool determined = true;
};

/// A parameter with its uncertainty. SI; parameter.si converts to the unit people read.
struct FitParameter : FittedValue {
  Parameter parameter;                ///< name, unit and bounds
  std::string effect;                 ///< key; empty for the base law
  std::vector<ProfilePoint> profile;  ///< by value, from twice the half-width below to twice above; empty unless asked
                                      ///< for
  /// Interval over all models that these data do not distinguish; none where there is one model only.
  std::optional<GivenParameter::Bounds> range = {};
};

/// What the model leaves, over slip samples and break-aways (see Observations).
struct ErrorFigures {
  double rmse = 0;           ///< [1 or N]
  double mean_relative = 0;  ///< mean of [D] Eq 5 over slip samples, |(mu - model)/mu|
  double max_relative = 0;   ///< largest of [D] Eq 5
  double held_out_rmse = 0;  ///< on cycles held out from the fit
};

/// What even the true law would leave.
struct Floor {
  double noise = 0;          ///< sensor noise, standard deviation of a sample; what sampling leaves, if more [1 or N]
  double scatter = 0;        ///< standard deviation of the break-away level from cycle to cycle [1 or N]
  double level_scatter = 0;  ///< the same of all friction, in proportion [1]
  double slow_noise = 0;     ///< of 1/f noise over longer times than `noise` was taken over [1 or N]
  double rmse = 0;           ///< all of them, over the samples of the error
  double sampling = 0;       ///< what sampling leaves, where that is more than sensor noise: it is alike in all cycles
  std::string source;        ///< how the noise was found: "stick", "slip" or "sampling"
};

struct Correlation {
  std::size_t first = 0, second = 0;  ///< indices of parameters
  double value = 0;
};

/// How a fit came out. One that fails says why in `messages` and has converged == false.
struct FitSummary {
  ErrorFigures error;
  Floor floor;
  double explained = 0;   ///< share of the error above the noise floor that is explained, against constant friction
  double fastest = 0;     ///< the data reach up to this |v_r| [m/s]
  double stick_rmse = 0;  ///< with presliding: creep velocity in stick, measured against model [m/s]; else NaN
  double degrees_of_freedom = 1;  ///< of the t distribution of the statistical errors
  std::size_t cycles = 0;
  bool converged = false;
  std::vector<std::string> messages;
};

/// One fitted model.
struct Fit : FitSummary {
  FrictionModel model{ExponentialLaw{}};
  Protocol protocol = Protocol::joint;
  std::vector<FitParameter> parameters;
  double constant_rmse = 0;                    ///< what a constant |friction| would leave [1 or N]
  std::size_t observations = 0;                ///< samples
  double mean_load = 1, mean_temperature = 0;  ///< N0 [N] and T0 [degC] to which the parameters refer
  double disc_speed = 0;                       ///< mean omega of the slips [rad/s]; 0 where it is not known
  double slowest = 0;                     ///< the data reach down to this |v_r|; 0 where slips begin in stick [m/s]
  std::vector<Correlation> correlations;  ///< those above 0.9 in size, largest first
  std::vector<double> covariance;         ///< of the values (SI), row by row, statistical
  std::vector<double> cycle_squares;      ///< held-out sum of squares of each cycle
  std::vector<double> cycle_counts;       ///< residuals of each cycle
  std::vector<std::vector<double>> fold_parameters;  ///< values (SI) fitted with each fold held out
  std::vector<std::size_t> cycle_folds;              ///< fold in which each cycle was held out

  std::vector<double> values() const;
  /// Of two parameters, from the covariance; NaN where one of them has no error.
  double correlation(std::size_t first, std::size_t second) const;
  /// Fold in which a cycle was held out.
  std::size_t fold_of(std::size_t cycle) const { return cycle_folds.empty() ? 0 : cycle_folds.at(cycle); }
};

/// One record of several that are fitted together.
struct Record {
  const Motion* motion;
  const Segmentation* segmentation;
};

/// Fits a model to the observations of a trace.
///
/// Statistical errors come from the cycles: the influence of each cycle on each parameter (jackknife, one Newton step)
/// is a series in time whose standard_error_of_mean() is the standard error. So neither coloured noise nor a break-away
/// level that wanders breaks them. Errors on held-out cycles: contiguous blocks of cycles are left out in turn and the
/// rest refitted, by one Gauss-Newton step from the fit of all. `motion` serves the error figures on every sample.
/// Cost: linear in samples.
Fit fit_model(const FrictionModel& model, const Motion& motion, const Segmentation& segmentation,
              const Observations& observations, const Instruments& instruments = {}, const FitOptions& options = {});

/// The same for several records with all parameters shared; `observations` are theirs, joined in the same order. The
/// floor is the mean of theirs; what is uncertain in the instruments is so in all of them alike.
Fit fit_model(const FrictionModel& model, std::span<const Record> records, const Observations& observations,
              const Instruments& instruments = {}, const FitOptions& options = {});

/// Sensor noise and break-away scatter.
Floor floor_of(const RecordNoise& noise);
Floor estimate_floor(const Motion& motion, const Segmentation& segmentation);

/// Sets the noise floor of a fit and the share of the error above it that the model explains.
void set_floor(const Floor& floor, Fit& fit);

/// A fit tried on another record with every parameter frozen, at the N0 and T0 of the fit: its errors there, all of
/// them held out. A fit that failed stays failed, with a message.
Fit evaluate_frozen(const Fit& fit, const Motion& motion, const Segmentation& segmentation);

/// Standard error of the held-out RMSE, from cycle to cycle [1 or N]; NaN with fewer than three cycles, 0 where there
/// is no error.
double held_out_std_error(const Fit& fit);

/// Which of two fits predicts held-out cycles better.
struct Comparison {
  double difference = 0;  ///< mean over cycles of the squared error of `first` minus that of `second`
                          ///< [1 or N^2]
  double std_error = 0;
  double p_value = 1;  ///< two-sided
  bool first_better = false;
};
/// Paired over the cycles that both fits held out. Fewer than three cycles are not compared: the difference is
/// 0 and p_value 1.
Comparison compare_held_out(const Fit& first, const Fit& second);

/// mu(v) of a fit with its pointwise 95 % band (statistical) in steady sliding at the given speeds [m/s], at mean load
/// and temperature, at the start of the record and the mean speed of the disc. Empty for a fit that failed.
struct Curve {
  std::vector<double> velocity, mu, lower95, upper95;
};
/// threads: as in predict().
Curve law_curve(const Fit& fit, std::span<const double> velocity, int threads = 1);

/// Model friction at every sample of the slips (NaN in stick and outside), signed, at the N0 and T0 of the fit.
/// record: which of the records that were fitted together this is, from 0; it has phases of its own. threads: 0 for as
/// many as there are; the result is the same for any number.
std::vector<double> predict(const Fit& fit, const Motion& motion, const Segmentation& segmentation,
                            std::size_t record = 0, int threads = 1);

}  // namespace tribofit
