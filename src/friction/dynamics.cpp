#include "tribofit/friction/dynamics.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "statistics/linear_algebra.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

namespace {

/// A slip of one sample, for hooks that take whole slips.
struct OneSample {
  double time, velocity, acceleration, angle, distance, reversal_distance, load, temperature;
  Slip slip;

  explicit OneSample(const SlidingState<double>& at)
      : time(at.time),
        velocity(at.velocity),
        acceleration(at.acceleration),
        angle(at.angle),
        distance(at.distance),
        reversal_distance(at.reversal_distance),
        load(at.load),
        temperature(at.temperature) {
    const auto one = [](const double& x) { return std::span<const double>(&x, 1); };
    slip.time = one(time);
    slip.velocity = one(velocity);
    slip.acceleration = one(acceleration);
    slip.angle = one(angle);
    slip.distance = one(distance);
    slip.reversal_distance = one(reversal_distance);
    slip.earlier_strokes = at.earlier_strokes;
    slip.load = one(load);
    slip.temperature = one(temperature);
    slip.stick_time = at.stick_time;
    slip.direction = at.direction;
    slip.mean_load = at.mean_load;
    slip.mean_temperature = at.mean_temperature;
    slip.disc_speed = at.disc_speed;
  }
  OneSample(const OneSample&) = delete;
  OneSample& operator=(const OneSample&) = delete;
};

double modulated(const FrictionModel& model, const double* p, const SlidingState<double>& at, double mu) {
  for_each_effect(model, p, [&]<class E>(const E& effect, const double* q) {
    if constexpr (hooks::Modulates<E, double>) {
      mu = effect.modulate(q, at, mu);
    } else if constexpr (hooks::ModulatesAll<E, double>) {
      const OneSample one(at);
      effect.modulate_all(q, one.slip, std::span<const double>(&one.velocity, 1), std::span<double>(&mu, 1));
    }
  });
  return mu;
}

}  // namespace

FrictionDynamics::FrictionDynamics(FrictionModel model, std::vector<double> p)
    : model_(std::move(model)), p_(std::move(p)) {
  if (p_.size() != model_.parameters().size()) {
    throw std::invalid_argument("FrictionDynamics: wrong number of parameters");
  }
  law_ = model_.law_values(p_.data());
}

void FrictionDynamics::begin_stick(std::span<const double> state) {
  age_left_ = 0;
  std::size_t k = 0;
  for_each_effect(model_, p_.data(), [&]<class E>(const E&, const double*) {
    if constexpr (hooks::HasContactAge<E, double>) age_left_ = state[k];
    if constexpr (hooks::HasContactAge<E, double> || hooks::Remembers<E, double>) ++k;
  });
}

void FrictionDynamics::begin_slip(double stick_time, double direction, double offset) {
  Slip slip;
  slip.stick_time = stick_time;
  slip.direction = direction;
  slip.from_stick = true;
  law_ = law_for(model_, p_.data(), slip);
  law_.raise_break_away(offset);
  direction_ = direction;
  age_ = age_left_ + stick_time;
}

/// |mu| of a rigid stick at this break-away, before anything modulates it.
double FrictionDynamics::friction_at_rest() const {
  double level = law_at_rest(model_, law_);
  for_each_effect(model_, p_.data(), [&]<class E>(const E& effect, const double* q) {
    if constexpr (hooks::HasContactAge<E, double>) {
      const double speed = detail::equivalent_speed(effect.renewal_distance(q), age_);
      level = steady_friction(model_, p_.data(), law_, SlidingState<double>{.velocity = 0}, &speed);
    }
  });
  return level;
}

double FrictionDynamics::break_away_friction(const SlidingState<double>& at) const {
  SlidingState<double> rest = at;
  rest.velocity = 0;
  rest.direction = direction_;
  return direction_ * modulated(model_, p_.data(), rest, direction_ * friction_at_rest());
}

void FrictionDynamics::states_at_break_away(std::span<double> state) const {
  const double level = friction_at_rest();
  std::size_t k = 0;
  for_each_effect(model_, p_.data(), [&]<class E>(const E&, const double*) {
    if constexpr (hooks::HasContactAge<E, double>) state[k++] = age_;
    if constexpr (hooks::Remembers<E, double>) state[k++] = level;
  });
}

void FrictionDynamics::steady_states(const SlidingState<double>& at, std::span<double> state) const {
  states_at_break_away(state);
  const auto n = static_cast<Eigen::Index>(state.size());
  Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(state.data(), n);
  const auto rates_of = [&](const Eigen::VectorXd& z) {
    Eigen::VectorXd rate(n);
    rates(at, std::span<const double>(z.data(), state.size()), std::span<double>(rate.data(), state.size()));
    return rate;
  };
  constexpr int kMostIterations = 30;
  for (int i = 0; n > 0; ++i) {
    const Eigen::VectorXd rate = rates_of(y);
    Eigen::MatrixXd jacobian(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      Eigen::VectorXd shifted = y;
      shifted[k] += y[k] == 0 ? 1e-9 : 1e-6 * y[k];
      jacobian.col(k) = (rates_of(shifted) - rate) / (shifted[k] - y[k]);
    }
    const Eigen::VectorXd step = least_squares(jacobian, -rate);
    if (!step.allFinite() || i == kMostIterations) {
      throw InputError("the memory of the friction law does not come to rest at a speed of " +
                           std::to_string(1e3 * at.velocity) + " mm/s",
                       "check that its effects have plausible parameters");
    }
    y += step;
    if (step.norm() <= 1e-12 * y.norm()) break;
  }
  std::copy(y.data(), y.data() + n, state.begin());
}

double FrictionDynamics::run(const SlidingState<double>& now, std::span<const double> state, std::span<double> rate,
                             bool want_rates) const {
  if (model_.effects().empty()) {  // simulations spend most of their time here
    double mu = std::abs(now.velocity);
    detail::reduce_speed(model_, law_, std::span<double>(&mu, 1));
    detail::apply_law(model_, law_, {}, std::span<double>(&mu, 1));
    return (now.velocity != 0 ? now.velocity : now.direction) < 0 ? -mu : mu;
  }
  SlidingState<double> at = now;
  if (at.velocity != 0) at.direction = at.velocity < 0 ? -1 : 1;
  double speed = std::abs(at.velocity);
  std::size_t k = 0;
  for_each_effect(model_, p_.data(), [&]<class E>(const E& effect, const double* q) {
    if constexpr (hooks::HasContactAge<E, double>) {
      const double distance = effect.renewal_distance(q);
      if (want_rates) rate[k] = 1 - speed / distance * state[k];
      speed = detail::equivalent_speed(distance, state[k]);
    }
    if constexpr (hooks::HasContactAge<E, double> || hooks::Remembers<E, double>) ++k;
  });
  const bool aged = speed != std::abs(at.velocity);
  double mu = steady_friction(model_, p_.data(), law_, at, aged ? &speed : nullptr);
  k = 0;
  bool is_signed = false;
  for_each_effect(model_, p_.data(), [&]<class E>(const E& effect, const double* q) {
    if constexpr (hooks::Remembers<E, double>) {
      const Relaxation<double> r = effect.relaxation(q, at, mu);
      if (want_rates) rate[k] = r.rate * (r.target - state[k]);
      if constexpr (hooks::Outputs<E, double>) {
        mu = effect.output(q, at, mu, state[k]);
      } else {
        mu = state[k];
      }
      is_signed = hooks::ActsInStick<E>;
      ++k;
    }
    if constexpr (hooks::HasContactAge<E, double>) ++k;
  });
  if (!is_signed && at.direction < 0) mu = -mu;
  return want_rates ? mu : modulated(model_, p_.data(), at, mu);
}

double FrictionDynamics::friction(const SlidingState<double>& at, std::span<const double> state) const {
  return run(at, state, {}, false);
}

void FrictionDynamics::rates(const SlidingState<double>& at, std::span<const double> state,
                             std::span<double> rate) const {
  run(at, state, rate, true);
}

}  // namespace tribofit
