#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tribofit/friction/laws/coulomb.hpp"
#include "tribofit/friction/laws/exponential.hpp"
#include "tribofit/friction/laws/fractional.hpp"
#include "tribofit/friction/laws/gaussian.hpp"
#include "tribofit/friction/laws/logarithmic.hpp"

namespace tribofit {

/// The one list of laws, in the order in which they are offered.
using Law = std::variant<ExponentialLaw, FractionalLaw, CoulombLaw, LogarithmicLaw, GaussianLaw>;

/// Laws have no data: they are the same where they are of one type.
template <class L>
requires std::is_empty_v<L> && std::is_constructible_v<Law, L>
constexpr bool operator==(const L&, const L&) {
  return true;
}

/// Every law, in the order of the list.
std::span<const Law> law_catalogue();

/// What `law` says about itself.
LawInfo describe(const Law& law);

/// Its key: "exponential".
std::string_view to_string(const Law& law);

/// Keys of all laws.
std::vector<std::string> law_keys();

/// The law of that key, or nothing.
std::optional<Law> find_law(std::string_view key);

/// The law of that key. Throws InputError that offers the nearest known one.
Law make_law(std::string_view key);

/// Friction in slip does not depend on speed.
bool constant_in_slip(const Law& law);

/// Friction depends on speed through a reduced speed x = steepness v, on which effects may act.
bool has_reduced_speed(const Law& law);

/// How much of the way from mu_s to mu_k is still to come at the speed v [m/s], 1 at rest and 0 at high speed; nothing
/// for laws that do not level off. q: parameters of the law in SI.
std::optional<double> remaining_fall(const Law& law, std::span<const double> q, double v);

/// How much of what is added to friction at break-away is left at the speed v > 0 [m/s]: it fades as the reduced speed
/// grows; without one, as the first parameter acts.
double break_away_left(const Law& law, std::span<const double> q, double v);

/// Friction of the law alone that a rigid stick reaches at break-away. q: parameters of the law in SI.
double friction_at_rest(const Law& law, std::span<const double> q);

/// Friction at rest is positive, and no parameter is negative whose bounds are not. q: parameters of the law in SI.
bool is_possible(const Law& law, std::span<const double> q);

/// Kinetic friction of the law alone: mu_k where it has this level, otherwise friction at the speed `fastest` [m/s].
double kinetic_friction(const Law& law, std::span<const double> q, double fastest);

}  // namespace tribofit
