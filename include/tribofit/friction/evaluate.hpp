#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "tribofit/friction/contact_age.hpp"
#include "tribofit/friction/hooks.hpp"
#include "tribofit/friction/memory.hpp"
#include "tribofit/friction/model.hpp"
#include "tribofit/friction/one_derivative.hpp"
#include "tribofit/friction/read_through_low_pass.hpp"

namespace tribofit {

namespace detail {

/// Comparisons instead of the table of functions of std::visit: a visitor has nothing to do with most effects, and the
/// compiler leaves those out.
template <class Visitor, std::size_t... I>
void visit_effect(const Effect& effect, const Visitor& visit, std::index_sequence<I...>) {
  const std::size_t held = effect.index();
  (void)((held == I && (visit(*std::get_if<I>(&effect)), true)) || ...);
}

}  // namespace detail

/// Calls visit(effect, parameters of that effect) for every effect of the model, in order.
template <class T, class Visitor>
void for_each_effect(const FrictionModel& model, const T* p, Visitor&& visit) {
  constexpr auto kAlternatives = std::make_index_sequence<std::variant_size_v<EffectAlternatives>>();
  for (std::size_t k = 0; k < model.effects().size(); ++k) {
    detail::visit_effect(
        model.effects()[k], [&](const auto& effect) { visit(effect, p + model.offset(k)); }, kAlternatives);
  }
}

/// Parameters of the base law for one slip, after every effect that adjusts them.
template <class T>
LawValues<T> law_for(const FrictionModel& model, const T* p, const Slip& slip) {
  LawValues<T> law = model.law_values(p);
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::Adjusts<E, T>) effect.adjust(q, slip, law);
  });
  return law;
}

/// Friction that a rigid stick reaches at break-away by the law alone.
template <class T>
T law_at_rest(const FrictionModel& model, const LawValues<T>& law) {
  return std::visit([&]<class L>(const L&) { return L::at_rest(law.q.data()); }, model.law());
}

namespace detail {

/// Speeds [m/s] become reduced speeds, in place, where the law has one.
template <class T>
void reduce_speed(const FrictionModel& model, const LawValues<T>& law, std::span<T> speed) {
  std::visit(
      [&]<class L>(const L&) {
        if constexpr (hooks::ReducesSpeed<L>) {
          const T steepness = L::steepness(law.q.data());
          for (T& x : speed) x = steepness * x;
        }
      },
      model.law());
}

/// Reduced speeds become friction of the law, in place. variance: of v_r within each sample [m^2/s^2], or empty.
template <class T>
void apply_law(const FrictionModel& model, const LawValues<T>& law, std::span<const double> variance, std::span<T> x) {
  std::visit(
      [&]<class L>(const L&) {
        const auto q = law.q;  // of its own: nothing written to x can change it
        if (variance.empty()) {
          for (T& value : x) value = L::friction(q.data(), value);
          return;
        }
        T scale = T(1.0);
        if constexpr (hooks::ReducesSpeed<L>) {
          const T steepness = L::steepness(q.data());
          scale = steepness * steepness;
        }
        for (std::size_t i = 0; i < x.size(); ++i) x[i] = L::mean_friction(q.data(), x[i], T(scale * variance[i]));
      },
      model.law());
}

}  // namespace detail

/// Steady friction f(v) [1] at one instant, >= 0, before any memory.
/// equivalent_speed: where contacts have an age, the speed at which the base law is taken instead of v [m/s].
template <class T>
T steady_friction(const FrictionModel& model, const T* p, const LawValues<T>& law, SlidingState<T> at,
                  const T* equivalent_speed = nullptr) {
  using std::abs;
  T share = T(1.0);
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::AveragesOverContact<E, T>) {
      const LocalSliding<T> local = E::average_over_contact(effect.rim_speed(q, at.disc_speed), T(abs(at.velocity)));
      share = local.share;
      at.velocity = at.direction * local.speed;
    }
  });
  T x = equivalent_speed != nullptr ? *equivalent_speed : T(abs(at.velocity));
  detail::reduce_speed(model, law, std::span<T>(&x, 1));
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::TransformsSpeed<E, T>) x = effect.transform_speed(q, x);
  });
  T mu = std::visit([&]<class L>(const L&) { return L::friction(law.q.data(), x); }, model.law());
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::Steadies<E, T>) mu = effect.steady(q, at, mu);
  });
  return share * mu;
}

namespace detail {

/// A slip as seen by a contact whose parts slide at several speeds.
template <class T>
struct LocalSlip {
  std::vector<T> velocity, share;  ///< of every sample, as in LocalSliding; empty: all of the contact slides at v_r
};

/// velocity: v_r, of which no derivatives are taken.
template <class T>
LocalSlip<T> local_slip(const FrictionModel& model, const T* p, const Slip& slip, std::span<const T> velocity) {
  LocalSlip<T> out;
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::AveragesOverContact<E, T>) {
      using N = WithOneDerivative<T>;
      const T rim = effect.rim_speed(q, slip.disc_speed);
      const N rim_variable = as_variable(rim), slowest = E::slowest_reading(rim_variable);
      out.velocity.reserve(velocity.size());
      out.share.reserve(velocity.size());
      for (const T& v : velocity) {
        const double speed = slip.speed(scalar_part(v));
        const LocalSliding<N> local =
            E::average_over_contact(rim_variable, speed < scalar_part(slowest) ? slowest : N(speed));
        out.velocity.push_back(slip.direction * by_parameters(local.speed, rim));
        out.share.push_back(by_parameters(local.share, rim));
      }
    }
  });
  return out;
}

/// The highest steady friction from rest on [1]: `at_rest`, or less where a contact never sticks as a whole. first: the
/// first value of a slip.
template <class T>
T peak_friction(const FrictionModel& model, const T* p, const LawValues<T>& law, const T& at_rest, const Slip& first) {
  T rim = T(0.0);
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::AveragesOverContact<E, T>) rim = effect.rim_speed(q, first.disc_speed);
  });
  if (!(scalar_part(rim) > 0)) return at_rest;
  const auto friction_at = [&first, &model]<class N>(const N* own, const LawValues<N>& own_law, const N& speed) {
    SlidingState<N> at = first.at(0, N(first.direction * speed));
    at.acceleration = 0;
    return steady_friction(model, own, own_law, at);
  };
  // Looked for with the values alone; friction there carries their derivatives.
  std::vector<double> values(model.parameters().size());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = scalar_part(p[k]);
  LawValues<double> law_values;
  for (std::size_t k = 0; k < law.q.size(); ++k) law_values.q[k] = scalar_part(law.q[k]);
  double peak = 0, speed_in_rims = 0;
  for (double v = 0.8; v < 40; v *= 1.15) {
    const double mu = friction_at(values.data(), law_values, v * scalar_part(rim));
    if (mu > peak) peak = mu, speed_in_rims = v;
  }
  return peak > 0 ? friction_at(p, law, T(speed_in_rims * rim)) : T(0.0);
}

}  // namespace detail

/// Steady friction f(v) [1] at every sample of a slip: as above, each effect visited once. Contacts with an age carry
/// it through the slip.
template <class T>
void steady_friction(const FrictionModel& model, const T* p, const LawValues<T>& law, const Slip& slip,
                     std::span<const T> velocity, std::span<T> mu) {
  const std::size_t n = slip.size();
  const detail::LocalSlip<T> local = detail::local_slip(model, p, slip, velocity.first(n));
  const bool is_local = !local.share.empty();
  if (is_local) velocity = local.velocity;
  for (std::size_t i = 0; i < n; ++i) mu[i] = slip.speed(velocity[i]);
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::HasContactAge<E, T>) detail::equivalent_speeds(effect.renewal_distance(q), slip, velocity, mu);
  });
  detail::reduce_speed(model, law, mu.first(n));
  bool skips_variance = is_local;  // it is that of v_r, not of a local or bent speed
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::TransformsSpeed<E, T>) {
      for (std::size_t i = 0; i < n; ++i) mu[i] = effect.transform_speed(q, mu[i]);
      skips_variance = true;
    }
  });
  detail::apply_law(model, law, skips_variance ? std::span<const double>() : slip.velocity_variance, mu.first(n));
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::Steadies<E, T>) {
      for (std::size_t i = 0; i < n; ++i) mu[i] = effect.steady(q, slip.at(i, velocity[i]), mu[i]);
    }
  });
  for (std::size_t i = 0; i < n && is_local; ++i) mu[i] = local.share[i] * mu[i];
}

namespace detail {

/// |mu| that a rigid stick before `slip` reaches, before anything modulates it: the law at rest, or at the speed that
/// stands for the age of the contacts.
template <class T>
T friction_at_rest(const FrictionModel& model, const T* p, const LawValues<T>& law, const Slip& slip) {
  T level = law_at_rest(model, law);
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::HasContactAge<E, T>) {
      SlidingState<T> at;
      at.velocity = T(0.0 * p[0]);
      const T speed = speed_at_break_away(effect.renewal_distance(q), slip);
      level = steady_friction(model, p, law, at, &speed);
    }
  });
  return level;
}

/// Carries every memory through a slip, in place; whether friction is signed then, as that of one which acts in stick.
/// at_rest(): |mu| that a rigid stick before it reaches.
template <class T, class AtRest>
bool remember_all(const FrictionModel& model, const T* p, const LawValues<T>& law, const Slip& slip,
                  const AtRest& at_rest, std::span<const T> velocity, std::span<T> mu) {
  bool is_signed = false;
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::Remembers<E, T>) {
      const auto steady_at = [&](const SlidingState<T>& at) { return steady_friction(model, p, law, at); };
      remember(effect, q, slip, at_rest(), steady_at, velocity, mu);
      is_signed = hooks::ActsInStick<E>;
    }
  });
  return is_signed;
}

/// The first value of a slip in every channel.
inline Slip first_value_of(const Slip& slip) {
  Slip first = slip;
  for (auto* channel : {&first.time, &first.velocity, &first.velocity_variance, &first.acceleration, &first.angle,
                        &first.distance, &first.reversal_distance, &first.load, &first.temperature}) {
    if (!channel->empty()) *channel = channel->first(1);
  }
  return first;
}

/// Signed friction where the lead before `slip` ends, of a contact that creeps there: no line leads to a break-away.
template <class T>
T friction_after_creep(const FrictionModel& model, const T* p, const LawValues<T>& law, const Slip& slip) {
  Slip last = first_value_of(slip);
  const std::size_t before = slip.lead_time.size() - 1;
  last.time = slip.lead_time.last(1);
  last.velocity = slip.lead_velocity.last(1);
  last.lead_time = slip.lead_time.first(before);
  last.lead_velocity = slip.lead_velocity.first(before);
  const T velocity = T(last.velocity[0] + 0.0 * p[0]);
  T mu;
  steady_friction(model, p, law, last, std::span<const T>(&velocity, 1), std::span<T>(&mu, 1));
  const auto at_rest = [level = mu] { return level; };
  const bool is_signed =
      remember_all(model, p, law, last, at_rest, std::span<const T>(&velocity, 1), std::span<T>(&mu, 1));
  return is_signed ? mu : T(slip.direction * mu);
}

/// Signed friction at the break-away that begins `slip`; with `sensed`, as the sensor reads it.
template <class T>
T break_away(const FrictionModel& model, const T* p, const Slip& slip, bool sensed) {
  Slip first = first_value_of(slip);
  first.time = {&slip.break_away_time, 1};
  SlidingState<T> at = first.at(0, T(0.0 * p[0]));
  at.acceleration = 0;
  const LawValues<T> law = law_for(model, p, slip);
  T mu = model.acts_in_stick() && !slip.lead_time.empty()
             ? friction_after_creep(model, p, law, slip)
             : T(slip.direction * peak_friction(model, p, law, friction_at_rest(model, p, law, slip), first));
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::Modulates<E, T>) {
      mu = effect.modulate(q, at, mu);
    } else if constexpr (hooks::ModulatesAll<E, T>) {
      effect.modulate_all(q, first, std::span<const T>(&at.velocity, 1), std::span<T>(&mu, 1));
    }
    if (!sensed) return;
    // The line through the stick before break-away knows nothing of what break-away strikes.
    at.since_break_away = std::numeric_limits<double>::quiet_NaN();
    if constexpr (hooks::FiltersBreakAwayReading<E, T>) {
      mu = effect.filter_break_away_reading(q, slip, mu);
    } else if constexpr (hooks::AddsToReading<E, T>) {
      mu = effect.add_to_reading(q, at, mu);
    }
  });
  return sensed ? T(mu - lag_of_ramp(slip)) : mu;
}

}  // namespace detail

/// |mu| that the model expects to be read at the break-away which begins `slip` [1], after every effect on the level.
/// A contact that creeps has none: of it, friction where the lead ends.
template <class T>
T break_away_level(const FrictionModel& model, const T* p, const Slip& slip) {
  if (model.has_values_of(slip.record)) {
    const std::vector<T> own = model.values_of(slip.record, p);
    return slip.direction * detail::break_away(model, own.data(), slip, true);
  }
  return slip.direction * detail::break_away(model, p, slip, true);
}

/// Friction of the model at every sample of a slip, signed as v_r is.
///
/// p: parameters in SI, model.parameters().size() of them, of which those of slip.record are taken; velocity: v_r
/// [m/s], a constant: contacts with an age, or that spin, take no derivatives of it; mu: one value a sample, written.
/// Cost: linear in samples; one pass per memory.
template <class T>
void evaluate(const FrictionModel& model, const T* p, const Slip& slip, std::span<const T> velocity, std::span<T> mu) {
  std::vector<T> own;
  if (model.has_values_of(slip.record)) {
    own = model.values_of(slip.record, p);
    p = own.data();
  }
  const LawValues<T> law = law_for(model, p, slip);
  const std::size_t n = slip.size();
  steady_friction(model, p, law, slip, velocity, mu);
  const auto at_rest = [&] { return detail::friction_at_rest(model, p, law, slip); };
  const bool is_signed =
      model.state_count() > 0 && n > 0 && detail::remember_all(model, p, law, slip, at_rest, velocity, mu);
  if (!is_signed && slip.direction < 0) {
    for (std::size_t i = 0; i < n; ++i) mu[i] = T(-mu[i]);
  }
  for_each_effect(model, p, [&]<class E>(const E& effect, const T* q) {
    if constexpr (hooks::ModulatesAll<E, T>) {
      if (n > 0) effect.modulate_all(q, slip, velocity, mu);
    } else if constexpr (hooks::Modulates<E, T>) {
      for (std::size_t i = 0; i < n; ++i) mu[i] = effect.modulate(q, slip.at(i, velocity[i]), mu[i]);
    }
    if constexpr (hooks::AddsToReadings<E, T>) {
      effect.add_to_readings(q, slip, mu);
    } else if constexpr (hooks::AddsToReading<E, T>) {
      for (std::size_t i = 0; i < n; ++i) mu[i] = effect.add_to_reading(q, slip.at(i, velocity[i]), mu[i]);
    }
    if constexpr (hooks::FiltersReading<E, T>) {
      effect.filter_reading(q, slip, slip.from_stick ? detail::break_away(model, p, slip, false) : T(0.0 * p[0]), mu);
    }
  });
  if (slip.friction_low_pass > 0)
    detail::read_through_low_pass(slip, slip.from_stick ? detail::break_away(model, p, slip, false) : T(0.0 * p[0]),
                                  mu);
}

// Compiled once, in evaluate.cpp.
extern template LawValues<double> law_for(const FrictionModel&, const double*, const Slip&);
extern template double steady_friction(const FrictionModel&, const double*, const LawValues<double>&,
                                       SlidingState<double>, const double*);
extern template void steady_friction(const FrictionModel&, const double*, const LawValues<double>&, const Slip&,
                                     std::span<const double>, std::span<double>);
extern template double break_away_level(const FrictionModel&, const double*, const Slip&);
extern template void evaluate(const FrictionModel&, const double*, const Slip&, std::span<const double>,
                              std::span<double>);

}  // namespace tribofit
