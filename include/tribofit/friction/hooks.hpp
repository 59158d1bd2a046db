#pragma once

#include <span>

#include "tribofit/friction/effect.hpp"
#include "tribofit/friction/law.hpp"
#include "tribofit/friction/slip.hpp"

namespace tribofit {

/// Which of the hooks an effect or a law has; see effect.hpp and law.hpp for what they mean.
namespace hooks {

template <class E, class T>
concept Adjusts = requires(const E e, const T* p, const Slip& s, LawValues<T>& l) {
  e.adjust(p, s, l);
};
template <class E, class T>
concept TransformsSpeed = requires(const E e, const T* p, const T& x) {
  e.transform_speed(p, x);
};
template <class E, class T>
concept AveragesOverContact = requires(const E e, const T* p, const T& x) {
  E::average_over_contact(e.rim_speed(p, 0.0), x);
  E::slowest_reading(x);
};
template <class E, class T>
concept Steadies = requires(const E e, const T* p, const SlidingState<T>& x, const T& mu) {
  e.steady(p, x, mu);
};
template <class E, class T>
concept HasContactAge = requires(const E e, const T* p) {
  e.renewal_distance(p);
};
template <class E, class T>
concept Remembers = requires(const E e, const T* p, const SlidingState<T>& x, const T& mu) {
  e.relaxation(p, x, mu);
};
template <class E, class T>
concept Outputs = requires(const E e, const T* p, const SlidingState<T>& x, const T& mu) {
  e.output(p, x, mu, mu);
};
template <class E, class T>
concept Modulates = requires(const E e, const T* p, const SlidingState<T>& x, const T& mu) {
  e.modulate(p, x, mu);
};
template <class E, class T>
concept ModulatesAll = requires(const E e, const T* p, const Slip& s, std::span<const T> v, std::span<T> mu) {
  e.modulate_all(p, s, v, mu);
};
template <class E, class T>
concept AddsToReading = requires(const E e, const T* p, const SlidingState<T>& x, const T& mu) {
  e.add_to_reading(p, x, mu);
};
template <class E, class T>
concept AddsToReadings = AddsToReading<E, T> && requires(const E e, const T* p, const Slip& s, std::span<T> mu) {
  e.add_to_readings(p, s, mu);
};
template <class E, class T>
concept FiltersReading = requires(const E e, const T* p, const Slip& s, const T& level, std::span<T> mu) {
  e.filter_reading(p, s, level, mu);
};
template <class E, class T>
concept FiltersBreakAwayReading = requires(const E e, const T* p, const Slip& s, const T& level) {
  e.filter_break_away_reading(p, s, level);
};
/// Only the sensor sees it: the interface does not feel it.
template <class E>
concept SensorEffect = AddsToReading<E, double> || FiltersReading<E, double>;
template <class E>
concept KinematicEffect = requires {
  requires E::kinematic_effect;
};
template <class E>
concept ActsInStick = requires {
  requires E::acts_in_stick;
};

/// A law whose friction depends on a reduced speed, on which effects may act.
template <class L>
concept ReducesSpeed = requires(const double* q) {
  L::steepness(q);
};

}  // namespace hooks

}  // namespace tribofit
