#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

/// What is taken off friction within each stretch beside a constant.
enum class Detrend {
  automatic,     ///< a line over the displacement of the load point or over time, whichever leaves less
  displacement,  ///< a line over the displacement of the load point
  time,          ///< a line over time
  none           ///< nothing
};
/// "auto", "displacement", "time", "none": as --detrend and JSON have them.
std::string_view to_string(Detrend detrend);
std::vector<std::string> detrend_names();
std::optional<Detrend> find_detrend(std::string_view name);

/// How velocity steps and holds are fitted.
struct RateStateOptions {
  std::vector<StateEvolution> evolutions = {state_evolutions.begin(), state_evolutions.end()};
  std::size_t states = 0;  ///< state variables, 1 or 2; 0: a second where it describes the steps better beyond chance
  Detrend detrend = Detrend::automatic;
  double reference_speed = 0;  ///< v0 [m/s]; 0: the speed of the load point before the first step
  double from = -std::numeric_limits<double>::infinity();  ///< [s]: nothing before is used
  double to = std::numeric_limits<double>::infinity();     ///< [s]: nothing after is used
  std::vector<GivenParameter> given =
      {};                         ///< starts and bounds of a, b, D_c, k (b_2, D_c2), SI; other kinds refuse them
  bool given_in_newtons = false;  ///< values of a, b or k among them: friction has to be a force
  std::vector<Selection::Stretch> excluded = {};  ///< samples that are left out
  bool each_step = true;                          ///< every step by itself, too
  int threads = 1;                                ///< 0: as many as there are; the result does not depend on it
};

/// A change of the speed of the load point with the samples that show what friction does: from within the sliding
/// before it until sliding before the next one. A hold is one of them, from where the load point stops.
struct VelocityStep {
  double time = 0;      ///< at which the speed changes [s], as friction answers it
  double recorded = 0;  ///< the same as it was stated or recorded [s]
  double time_std_error = std::numeric_limits<double>::quiet_NaN();  ///< of `time` [s]; NaN: it was not fitted
  double before = 0, after = 0;  ///< speeds of the load point [m/s]; of a hold those of sliding around it
  double hold = 0;               ///< time at rest [s]; 0: none
  double displacement = 0;       ///< of the load point at `time` [m]
  double from = 0, to = 0;       ///< times between which its samples lie [s]
  std::size_t samples = 0;
  double slack = 0;     ///< by which `recorded` may be wrong [s]; 0: it is known
  double interval = 0;  ///< shortest sampling interval behind the step [s]
};

/// Rate-and-state friction fitted to steps together (`step` is empty) or to one of them.
struct RateStateFit : FitSummary {
  RateStateFit() {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    error = {0, unknown, unknown, unknown};
    explained = stick_rmse = fastest = unknown;
    floor.source = "residuals";
  }
  StateEvolution evolution = StateEvolution::ageing;
  std::optional<std::size_t> step;
  std::size_t states = 1;                ///< state variables
  std::vector<FitParameter> parameters;  ///< a, b, D_c, k; with two states b_2 and D_c2 behind D_c
  std::vector<double> covariance;        ///< of ln D and ln k, and the others as they are, row by row
  Estimate rate_dependence;              ///< a - b (of all states) [1]; NaN where a bound holds one of them
  double rate_dependence_lower95 = 0, rate_dependence_upper95 = 0;
  /// [1/m], (b - a)/D_c of one state, below which steady sliding is unstable, and k over it; NaN where friction does
  /// not fall with speed beyond doubt (of two states, where it rises, unless k_c is known to a factor).
  double critical_stiffness = std::numeric_limits<double>::quiet_NaN();
  double stiffness_ratio = std::numeric_limits<double>::quiet_NaN(), stiffness_ratio_lower95 = 0,
         stiffness_ratio_upper95 = 0;
  std::vector<Estimate> base_friction;  ///< mu_0 of each step of the fit, at v0 and at the time of the step
  std::vector<Estimate> trend;          ///< slope of the line taken off [1/m or 1/s]
  double noise_time = 0;                ///< over which what is left wanders by floor.slow_noise [s]; 0: it does not
  /// It leaves more behind the steps than elsewhere, and noise alone would not; nothing where that cannot be judged.
  std::optional<bool> lacks;
  std::size_t samples = 0;
  std::vector<double> time_std_error;     ///< of each step of the fit [s]; NaN: its time was not fitted
  std::vector<Correlation> correlations;  ///< above 0.9 in size
};

/// One hold.
struct HoldMeasures {
  std::size_t step = 0;    ///< index of the step
  double duration = 0;     ///< [s]
  Estimate sliding, peak;  ///< friction before it, and the largest afterwards [1]
  double minimum = 0;      ///< friction at its end [1]
  double healing = 0;      ///< peak less sliding [1]
  double relaxation = 0;   ///< sliding less minimum [1]
};

/// How static friction grows with the time at rest.
struct Healing {
  std::vector<HoldMeasures> holds;
  Estimate per_decade;  ///< growth of the peak for a tenfold time at rest [1]; NaN for fewer than three holds
  double per_decade_model = std::numeric_limits<double>::quiet_NaN();  ///< the same of the response that was fitted
};

/// Friction over time as it was used and as the best fit has it, thinned.
struct RateStateCurve {
  std::size_t step = 0;
  std::vector<double> time, displacement, friction, model;  ///< [s], [m], [1], [1]
  std::vector<double> other;                                ///< the best fit of the other law; empty: there is none
};

/// What the steps say of a second state variable.
enum class SecondState {
  not_compared,   ///< the number was stated, or one leaves white noise alone
  not_needed,     ///< it describes them no better than chance would
  found,          ///< it does, and was taken
  not_determined  ///< it does, and they do not determine what it adds, or a beside it
};

/// Chance that what answers the steps is noise, above which nothing is said of the law. It is nominal: D_c and k are
/// free to fit what noise there is.
inline constexpr double kChanceOfNoAnswer = 1e-4;

/// All that velocity steps and holds say.
struct RateStateAnalysis {
  double reference_speed = 0;  ///< v0 [m/s]
  std::string reference_source;
  Detrend detrend = Detrend::automatic;  ///< as it was done
  std::vector<VelocityStep> steps;
  std::vector<RateStateFit> fits;  ///< one for each law, all steps together
  std::size_t best = 0;            ///< in `fits`
  std::size_t states = 1;          ///< state variables of the fits
  SecondState second_state = SecondState::not_compared;
  /// Chance that what one state leaves more than two is noise; NaN: not compared, as where white noise is all it
  /// leaves.
  double states_p_value = std::numeric_limits<double>::quiet_NaN();
  /// Nominal chance that noise alone answers the steps so well; NaN: not compared, as where what is left is no noise.
  double answer_p_value = std::numeric_limits<double>::quiet_NaN();
  double law_p_value =
      std::numeric_limits<double>::quiet_NaN();  ///< bound of the chance that the other law is true; NaN: not compared
  std::vector<RateStateFit> each;                ///< of each step by itself, the best law
  double sharing_p_value = std::numeric_limits<double>::quiet_NaN();  ///< that all steps have the same values
  std::optional<Healing> healing;
  std::vector<RateStateCurve> curves;
  std::vector<std::string> messages;
  std::string reason;  ///< why nothing was fitted; empty: it was

  bool fitted() const { return !fits.empty() && fits[best].converged; }
  /// Friction answers the steps by more than noise would.
  bool is_answered() const { return fitted() && !(answer_p_value > kChanceOfNoAnswer); }
};

/// Fits a, b, D_c and the stiffness k per normal force to the whole simulated response of a record of velocity steps or
/// holds (`motion.load_point` says how the load point moved): d mu/dt = k (v_lp - v), from steady sliding at the first
/// speed. Steps are moved to where friction answers them where that is another time beyond chance, and a second state
/// variable is taken where it is asked for beyond chance. Constants and lines of each stretch are projected out (G. H.
/// Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413), so that the search has no more unknowns however many steps
/// there are.
///
/// Statistical errors: least squares, whose covariance is computed with noise that is white in part and in part wanders
/// with a correlation exp(-dt/tau), sizes and tau by restricted maximum likelihood from what is left; a, b with normal
/// intervals, D_c and k in the logarithm. The laws are compared by the likelihood of what they leave, and on steps
/// held out.
///
/// Throws Stopped within a StopScope that says so. Cost: linear in samples; some hundred simulations of the record.
RateStateAnalysis fit_rate_state(const Motion& motion, const RateStateOptions& options = {});

}  // namespace tribofit
