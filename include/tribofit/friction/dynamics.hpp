#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tribofit/friction/model.hpp"
#include "tribofit/friction/slip.hpp"

namespace tribofit {

/// A friction model with its parameters, instant by instant, as a simulation needs it.
///
/// The memories of the model are states beside those of the block: d phi/dt = rate (target - phi).
/// What sensors do to the reading is not part of it. One object must not be used from two threads at once.
class FrictionDynamics {
 public:
  /// p: parameters in SI, in the order of model.parameters(). Throws std::invalid_argument on a wrong count.
  FrictionDynamics(FrictionModel model, std::vector<double> p);

  const FrictionModel& model() const { return model_; }
  std::span<const double> parameters() const { return p_; }
  std::size_t state_count() const { return model_.state_count(); }
  bool acts_in_stick() const { return model_.acts_in_stick(); }

  /// Opens a stick, with the states of the memories in which it begins.
  void begin_stick(std::span<const double> state);

  /// Opens a slip: parameters of the law for the stick time before it and its direction (+1, -1), with `offset`
  /// on break-away (its scatter [1]). Models that act in stick keep one law from begin_slip to the next.
  void begin_slip(double stick_time, double direction, double offset = 0);

  /// |mu| at which this slip breaks away, at rest, at the instant `at` (its velocity is ignored) [1].
  double break_away_friction(const SlidingState<double>& at) const;

  /// Memory states at break-away of a rigid stick.
  void states_at_break_away(std::span<double> state) const;

  /// Memory states in steady sliding, where none of them changes any more, at the speed and conditions of `at`.
  /// Newton's method from the states at break-away; throws InputError where it finds none.
  void steady_states(const SlidingState<double>& at, std::span<double> state) const;

  /// Signed mu at an instant [1].
  double friction(const SlidingState<double>& at, std::span<const double> state) const;

  /// d state/dt [1/s each].
  void rates(const SlidingState<double>& at, std::span<const double> state, std::span<double> rate) const;

 private:
  double friction_at_rest() const;
  double run(const SlidingState<double>& now, std::span<const double> state, std::span<double> rate,
             bool want_rates) const;

  FrictionModel model_;
  std::vector<double> p_;
  LawValues<double> law_{};
  double direction_ = 1;
  double age_left_ = 0, age_ = 0;  ///< of contacts with an age: when the stick began, and when it ends [s]
};

}  // namespace tribofit
