#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace tribofit {

/// A stiff initial value problem y' = f(t, y) of two unknowns, solved step by step.
///
/// By rosenbrock4 of Boost.Odeint, which has the coefficients of RODAS (Hairer and Wanner, Solving Ordinary
/// Differential Equations II, 1996, IV.7): six stages, order 4 with an estimate of order 3, L-stable, no iteration.
/// Its order needs the exact derivatives of f, by y and by t.
class StiffIntegrator {
 public:
  static constexpr std::size_t kSize = 2;
  using State = std::array<double, kSize>;
  /// f and its derivatives at one point.
  struct Derivatives {
    std::array<State, kSize> by_state;  ///< [row][column]
    State by_time;
  };
  struct Problem {
    std::function<State(double t, const State& y)> rates;
    std::function<Derivatives(double t, const State& y)> derivatives;
  };
  /// The root mean square over the unknowns of (error estimate / (absolute + relative |y|)) is at most 1 in a step.
  struct Options {
    double relative_tolerance, absolute_tolerance;  ///< > 0
    double max_step;                                ///< > 0
  };

  StiffIntegrator(Problem problem, double t, const State& y, const Options& options);
  ~StiffIntegrator();
  StiffIntegrator(const StiffIntegrator&) = delete;
  StiffIntegrator& operator=(const StiffIntegrator&) = delete;

  /// One step, at most to `until`; false when no step is small enough: see failure(). Time and state afterwards:
  /// time(), state().
  bool step(double until);
  double time() const { return time_; }
  const State& state() const { return state_; }
  /// State within the step just made, by the interpolant of the method, of order 3.
  State at(double t) const;
  /// Why step() was false.
  const std::string& failure() const { return failure_; }

 private:
  struct Method;

  double time_;
  State state_;
  std::string failure_;
  std::unique_ptr<Method> method_;
};

}  // namespace tribofit
