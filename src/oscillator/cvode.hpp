#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace tribofit {

/// A stiff initial value problem of two unknowns, solved step by step by SUNDIALS CVODE (BDF, dense Newton with the
/// Jacobian given).
class Cvode {
 public:
  static constexpr std::size_t kSize = 2;
  using State = std::array<double, kSize>;
  using Jacobian = std::array<State, kSize>;  ///< [row][column]
  struct Problem {
    std::function<void(double t, const State& y, State& dy)> rates;
    std::function<void(double t, const State& y, Jacobian& jacobian)> jacobian;
  };
  struct Options {
    double relative_tolerance, absolute_tolerance, max_step;
  };

  /// Throws std::runtime_error where SUNDIALS cannot be set up (no memory).
  Cvode(Problem problem, double t, const State& y, const Options& options);
  ~Cvode();
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;

  /// One step, at most to `until`; false when the integrator gives up. Time and state afterwards: time(), state().
  bool step(double until);
  double time() const { return time_; }
  const State& state() const { return state_; }
  /// State within the step just made.
  State at(double t) const;
  /// Why step() was false, in the words of CVODE.
  const std::string& failure() const { return failure_; }

 private:
  struct Handles;

  Problem problem_;
  double time_;
  State state_;
  std::string failure_;
  std::unique_ptr<Handles> handles_;
};

}  // namespace tribofit
