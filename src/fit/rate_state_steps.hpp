#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tribofit/fit/rate_state.hpp"
#include "tribofit/fit/solver.hpp"

// The steps of a fit to velocity steps and holds, in their order.

namespace tribofit::fit {

/// The samples of velocity steps, and how the load point moved.
struct RateStateData {
  std::vector<LoadPointPhase> phases;
  std::vector<double> phase_displacement;  ///< of the load point at the begin of each phase [m]
  std::vector<VelocityStep> steps;
  std::vector<std::size_t> before;   ///< of each step: the phase of sliding before it, or the longest of several
  std::vector<std::size_t> leaving;  ///< the first phase that is not of that sliding
  std::vector<std::size_t> behind;   ///< the first phase of sliding behind it
  double reference_speed = 0;        ///< v0 [m/s]
  bool is_force = false;             ///< friction is in newtons

  /// Values, each the mean of `count` samples, in order of time; those of step s begin at begins[s]. scatter: squares
  /// of the samples about their mean, summed.
  std::vector<double> time, displacement, friction, count, scatter;
  std::vector<std::size_t> begins;

  std::size_t size() const { return time.size(); }
  std::size_t end_of(std::size_t step) const { return step + 1 < begins.size() ? begins[step + 1] : size(); }
  void set_phase_displacements();  ///< from the phases
  /// Of the load point at a time [m].
  double displacement_at(double t) const;
};

/// The shorter sliding beside a step, as far as its samples lie in it [s].
double shorter_beside(const VelocityStep& step);

/// Steps of a record with their samples. most: values of each step; neighbours are put together where there are more,
/// the closer to a change of speed the fewer. What cannot be used is said in `messages`.
RateStateData rate_state_data(const Motion& motion, const RateStateOptions& options, std::size_t most,
                              std::vector<std::string>& messages);

/// The same steps with fewer values, for a first search.
RateStateData thinned(const RateStateData& data, std::size_t most);

/// What is fitted to the steps: a law with a number of states, and the line that is taken off each step.
struct RateStateModel {
  StateEvolution evolution = StateEvolution::ageing;
  std::size_t states = 1;
  Detrend detrend = Detrend::none;
};

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Friction of the simulated response less that measured, of some steps of a record together, with a constant and a
/// line of each step projected out. Unknowns: a, b, ln D_c (, b_2, ln D_c2), ln k.
class RateStateProblem : public Residuals {
 public:
  /// steps: in order of time. The record slides steadily before `first`, the first of them where none is given, and
  /// what it went through from there on is simulated, be its steps among them or not.
  RateStateProblem(const RateStateData& data, const RateStateModel& model, std::vector<std::size_t> steps,
                   std::optional<std::size_t> first = std::nullopt);

  std::size_t count() const override { return rows_; }
  std::size_t parameter_count() const override { return 2 + 2 * model_.states; }
  bool evaluate(const double* p, double* residual, double* jacobian) const override;

  /// Friction less what is projected out, at every value, and its derivatives; false where sliding runs away.
  bool response(const double* p, Eigen::VectorXd& friction, RowMatrix* jacobian) const;
  const RateStateData& data() const { return data_; }
  const RateStateModel& model() const { return model_; }
  const std::vector<std::size_t>& steps() const { return steps_; }
  /// The same of other data with the same steps and values.
  RateStateProblem with_data(const RateStateData& data) const { return {data, model_, steps_, first_}; }
  /// First row of the k-th step, and behind the last.
  std::size_t row_of(std::size_t k) const { return first_rows_[k]; }
  /// Value of the data that a row stands for.
  std::size_t value_of(std::size_t row) const { return values_[row]; }
  /// Constant and slope at the k-th step, by rows of the step: columns of the design, without weights.
  Eigen::MatrixXd design_of(std::size_t k) const;
  /// Weights rows and takes constant and line out of them, step by step.
  void weigh(RowMatrix& rows) const;

 private:
  template <class T, std::size_t kStates>
  bool simulate(const T* p, T* friction) const;

  const RateStateData& data_;
  RateStateModel model_;
  std::vector<std::size_t> steps_;
  std::optional<std::size_t> first_;
  std::vector<std::size_t> first_rows_, values_;
  std::size_t rows_ = 0;
  std::vector<double> times_, root_count_;
  std::vector<LoadPointPhase> phases_;
  std::vector<Eigen::MatrixXd> bases_;  ///< orthonormal, of each step
};

/// Parameters that a simulation takes, of the unknowns of the search.
RateStateParameters<double> parameters_from(const double* p, std::size_t states);

/// The unknowns of a search: names, units, bounds and where they begin, as a person sees them and as they are searched.
struct RateStateUnknowns {
  std::vector<Parameter> parameters;  ///< a, b, D_c (, b_2, D_c2), k
  std::vector<bool> logarithmic;      ///< searched by its logarithm
  std::vector<double> lower, upper;   ///< of what is searched
  std::vector<std::vector<double>> starts;
  bool states_alike = true;  ///< two of them differ by name alone: D_c is the shorter distance

  double value(std::size_t k, double searched) const;  ///< SI
  double searched(std::size_t k, double value) const;
};

/// Bounds in the scales of the record, and starts from what friction does at its steps: the size of the peak behind a
/// step, what is left of it, and over which displacement it comes and goes. Values given by the user come first.
RateStateUnknowns unknowns_of(const RateStateData& data, std::size_t states, const std::vector<GivenParameter>& given);

/// The best of several searches on few values, refined on all of them. Not converged where from every start sliding
/// runs away.
Solution search(const RateStateData& data, const RateStateModel& model, const std::vector<std::size_t>& steps,
                const RateStateUnknowns& unknowns);

/// The same of several steps; where what they leave is far above what the first of them leaves by itself, also from its
/// values on, with one step more at a time.
Solution search_together(const RateStateData& data, const RateStateModel& model, const std::vector<std::size_t>& steps,
                         const RateStateUnknowns& unknowns);

/// A search from values that are nearly right.
Solution refine(const RateStateProblem& problem, const std::vector<double>& start, const RateStateUnknowns& unknowns);

/// A change of the load point's speed at a step: at its time or, of a hold, where it goes on. A drive that passes from
/// one speed to the other passes as it does, whenever that is: its phases move together.
struct Turn {
  std::size_t step = 0, first = 0, last = 0;  ///< phases that begin there
  bool ends_hold = false;
};

/// Those whose times are fitted: known within VelocityStep::slack alone.
std::vector<Turn> free_turns(const RateStateData& data);

/// Change of the simulated friction at the values of a problem with the time of a turn [1/s], by a difference; the rows
/// of other steps are zero. Empty where sliding runs away.
Eigen::VectorXd response_by_time(const RateStateProblem& problem, const std::vector<double>& p, const Turn& turn);

struct MovedSteps {
  double largest = 0;                 ///< [s]
  std::vector<std::size_t> at_limit;  ///< steps that what is known of their times held
};

/// Moves the steps to the times at which the response fits best, within what is known of them (VelocityStep::slack) and
/// between their neighbours, and refines the minimum: Gauss-Newton steps in the parameters and the times together.
MovedSteps refine_step_times(RateStateData& data, const RateStateModel& model, const RateStateUnknowns& unknowns,
                             Solution& minimum);

/// Makes a fit of a minimum: errors, intervals, mu_0 and trend of each step, stability.
RateStateFit fit_from(const RateStateProblem& problem, const RateStateUnknowns& unknowns, const Solution& minimum);

/// Nominal chance that noise alone, as the fit has it, does what the fitted answer to the steps does; NaN where it
/// cannot be computed, or where what is left is no noise: a law that fails is no answer that is missing.
double p_value_of_no_answer(const RateStateProblem& problem, const Solution& minimum, const RateStateFit& fit);

/// By how much the logarithm of the likelihood of what the other minimum leaves is below that of the best, with the
/// noise of the fit made of the best; NaN where it cannot be computed.
double log_likelihood_below(const RateStateProblem& best, const Solution& best_minimum, const RateStateProblem& other,
                            const Solution& other_minimum, const RateStateFit& fit);

/// Of the load point, over which the contact adapts to the steps: D_c of the slower state, and what the machine gives
/// way while friction changes.
double adapting_distance(const RateStateData& data, std::size_t states, const RateStateFit& fit);

/// a - b, and whether sliding is stable on this machine, from the values and their covariance.
void set_stability(const std::vector<double>& p, double freedom, RateStateFit& fit);
void set_correlations(RateStateFit& fit);

/// What a person should know of it.
void add_messages(RateStateFit& fit);

/// All steps of a record described together with a number of states, by each law.
struct StepsTogether {
  RateStateModel model;  ///< but for the law
  RateStateData data;    ///< with its steps where they were found to be
  RateStateUnknowns unknowns;
  std::vector<Solution> minima;       ///< of each law
  std::vector<RateStateFit> fits;     ///< and what it says
  std::size_t best = 0;               ///< of the laws
  std::vector<std::size_t> at_limit;  ///< steps whose times end at the limit of what is known of them
  std::vector<std::string> messages;

  const RateStateFit& best_fit() const { return fits[best]; }
  std::vector<std::size_t> all() const;
  RateStateModel model_of(std::size_t law) const { return {fits[law].evolution, model.states, model.detrend}; }
  RateStateProblem problem(std::size_t law) const { return {data, model_of(law), all()}; }
};

/// The line that is taken off each step is the one that leaves less, steps are moved to where friction answers them
/// where their times are not known, or where a recorded displacement turns elsewhere beyond chance, and both laws are
/// fitted.
StepsTogether fit_together(const RateStateData& data, LoadPointSource source, const RateStateOptions& options,
                           std::size_t states);

/// Nominal chance that what `fewer` leaves more than `more` is noise, by the likelihood with the noise of `more` and as
/// many values as `more` has fitted beyond it; NaN where it cannot be computed.
double p_value_of_more(const RateStateProblem& fewer, const Solution& fewer_minimum, const RateStateProblem& more,
                       const Solution& more_minimum, const RateStateFit& fit, std::size_t values);

}  // namespace tribofit::fit
