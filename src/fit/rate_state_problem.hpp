#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "rate_state_data.hpp"
#include "tribofit/fit/solver.hpp"

namespace tribofit::fit {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Friction of the simulated response less that measured, of some steps of a record together, with a constant and a
/// line of each step projected out. Unknowns: a, b, ln D_c (, b_2, ln D_c2), ln k.
class RateStateProblem : public Residuals {
 public:
  /// steps: in order of time. The record slides steadily before `first`, the first of them where none is given, and
  /// what it went through from there on is simulated, be its steps among them or not.
  RateStateProblem(const RateStateData& data, StateEvolution evolution, std::size_t states, Detrend detrend,
                   std::vector<std::size_t> steps, std::optional<std::size_t> first = std::nullopt);

  std::size_t count() const override { return rows_; }
  std::size_t parameter_count() const override { return 2 + 2 * states_; }
  bool evaluate(const double* p, double* residual, double* jacobian) const override;

  /// Friction less what is projected out, at every value, and its derivatives; false where sliding runs away.
  bool response(const double* p, Eigen::VectorXd& friction, RowMatrix* jacobian) const;
  const RateStateData& data() const { return data_; }
  StateEvolution evolution() const { return evolution_; }
  std::size_t states() const { return states_; }
  const std::vector<std::size_t>& steps() const { return steps_; }
  /// The same of other data with the same steps and values.
  RateStateProblem with_data(const RateStateData& data) const {
    return {data, evolution_, states_, detrend_, steps_, first_};
  }
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
  StateEvolution evolution_;
  std::size_t states_;
  Detrend detrend_;
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

}  // namespace tribofit::fit
