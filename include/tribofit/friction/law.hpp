#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tribofit/friction/friction_curve.hpp"
#include "tribofit/friction/parameter.hpp"

namespace tribofit {

/// How to add a law
/// ----------------
/// 1. One header in friction/laws/: a type without data, with the static members below.
/// 2. Its name in the list of friction/laws/all.hpp.
/// 3. One test in tests/friction/.
/// The command line, the help, the JSON, the tables, the workbench, the studies, the simulation and the contract tests
/// find it through the list.
///
/// A law is steady friction mu(v) of the speed v = |v_r|; every model starts from one. Members that compute are
/// templates over the number type T (double, or a dual number for derivatives) and take the law's own parameters q in
/// SI, in the order of info():
///
///   key                                     name on the command line and in JSON
///   LawInfo info()                          what it says about itself; the equation begins "mu = " and names every
///                                           parameter
///   std::vector<double> start(const FrictionCurve&)   where a fit begins, from the data, SI; see best_fall() and
///                                           line_over() there
///   T at_rest(q)                            friction that a rigid stick reaches at break-away
///   T steepness(q)                          only where friction depends on the reduced speed x = steepness v [s/m]
///   T friction(q, const T& x)               steady friction at x; at the speed v where there is no steepness
///   T mean_friction(q, const T& x, const T& variance)   its mean over speeds with a small variance about x, for
///                                           samples that are means over a few neighbours
///   T remaining_fall(const T& x)            only for laws with two levels that have a steepness: how much of the way
///                                           from mu_s to mu_k is still to come at x, 1 at rest and 0 at high speed
///
/// LogarithmicLaw is an example without levels, GaussianLaw one with them.
///
/// Laws that fall from mu_s to mu_k by a shape of the reduced speed take all but key, info, steepness, shape and
/// mean_shape from TwoLevelLaw.
///
/// What effects do to a law is the same for all: what comes on top of break-away (ageing, the scatter from cycle to
/// cycle) is added to the first parameter, which therefore moves at_rest() by as much; what scales friction
/// (asymmetry) scales every parameter that says so; what acts on the reduced speed (stribeck-exponent) is refused by
/// laws without one; contacts with an age take the law at another speed.

/// No law has more parameters than this.
inline constexpr std::size_t kMostLawParameters = 6;

/// What a law says about itself.
struct LawInfo {
  std::string statement;  ///< physical meaning in one sentence
  std::string equation;   ///< in plain text
  std::string source;     ///< with DOI where there is one
  std::vector<Parameter> parameters;
  /// The first two parameters are the levels of friction at break-away and at high speed (mu_s, mu_k).
  bool two_levels = false;
  bool constant_in_slip = false;  ///< friction in slip does not depend on speed
  /// It changes within a few samples of rest, so that it is fitted at full resolution, as effects are.
  bool steep_at_rest = false;

  /// Two levels and at most one more parameter, which the protocol of per-cycle extremes ([D] 3.2) can find one after
  /// another.
  bool has_per_cycle_extremes() const { return two_levels && parameters.size() <= 3; }
};

/// Parameters of a law in SI during one slip, where effects may have changed them. Where friction is a force, those
/// that scale with friction are in newtons.
template <class T>
struct LawValues {
  std::array<T, kMostLawParameters> q{};
  std::uint32_t scaled = 0;  ///< bit k: parameter k scales with friction

  /// Raises friction at break-away.
  void raise_break_away(const T& by) { q[0] += by; }
  /// Scales friction at every speed.
  void scale_friction(const T& by) {
    for (std::size_t k = 0; k < kMostLawParameters; ++k) {
      if ((scaled >> k & 1U) != 0) q[k] *= by;
    }
  }
};

/// Static friction and kinetic friction, the levels of a law that falls from one to the other.
inline constexpr const char *static_level_name = "mu_s", *kinetic_level_name = "mu_k";
inline Parameter static_level() {
  return {.name = static_level_name,
          .description = "static friction, the level at break-away",
          .upper = 5,
          .start = 0.5,
          .scales_with_friction = true};
}
inline Parameter kinetic_level() {
  return {.name = kinetic_level_name,
          .description = "kinetic friction, the level at high speed",
          .upper = 5,
          .start = 0.3,
          .scales_with_friction = true};
}

/// A decay factor in s/mm, which the steepness is.
inline Parameter decay_factor(std::string name, double start) {
  return {.name = std::move(name),
          .description = "decay of friction with speed",
          .unit = "s/mm",
          .si = 1e3,
          .lower = 1e-4,
          .upper = 10,
          .start = start,
          .bound_scaling = BoundScaling::against_speed};
}

/// mu = mu_k + (mu_s - mu_k) shape(x), x = steepness v: what laws have in common whose friction falls from mu_s to
/// mu_k. mu_s > mu_k is not assumed: friction that rises with speed is a normal case.
///
/// Self: has `T shape(const T& x)`, 1 at rest and 0 at high speed, and `T mean_shape(const T& x, const T& variance)`.
/// Its parameters are mu_s, mu_k and one that sets the steepness, given by `T steepness(q)` and found for a steepness
/// by `double for_steepness(double)`.
template <class Self>
struct TwoLevelLaw {
  template <class T>
  static T at_rest(const T* q) {
    return q[0];
  }
  template <class T>
  static T friction(const T* q, const T& x) {
    return q[1] + (q[0] - q[1]) * Self::shape(x);
  }
  template <class T>
  static T mean_friction(const T* q, const T& x, const T& variance) {
    return q[1] + (q[0] - q[1]) * Self::mean_shape(x, variance);
  }
  template <class T>
  static T remaining_fall(const T& x) {
    return Self::shape(x);
  }
  /// The steepness of a grid for which the two levels, which follow from it linearly, fit the data best.
  static std::vector<double> start(const FrictionCurve& curve) {
    const FrictionCurve::Fall best = curve.best_fall([](double x) { return Self::shape(x); });
    return {best.at_rest, best.at_high_speed, Self::for_steepness(best.steepness)};
  }
};

}  // namespace tribofit
