#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tribofit {

/// Rate-and-state friction with its state written out, for a contact that a spring loads (velocity steps, holds):
///
///   mu = mu_0 + a ln(v/v0) + sum_i b_i ln(v0 theta_i/D_i)
///
/// (J. H. Dieterich, J. Geophys. Res. 84 (1979) 2161; A. Ruina, J. Geophys. Res. 88 (1983) 10359). v0 is a choice: it
/// shifts mu_0 and nothing else. In steady sliding theta_i = D_i/v and mu = mu_0 + (a - sum b_i) ln(v/v0), which is the
/// law `logarithmic` with A = a - b. The effect `rate-state` is the memory over D_c of any law of sliding speed, for
/// records whose speed was measured; here the speed of the contact is an unknown that the spring decides.

/// How the contacts forget.
enum class StateEvolution {
  ageing,  ///< d theta/dt = 1 - v theta/D_c: they grow older at rest as well (Dieterich 1979)
  slip     ///< d theta/dt = -(v theta/D_c) ln(v theta/D_c): only sliding changes them (Ruina 1983)
};
inline constexpr std::array<StateEvolution, 2> state_evolutions = {StateEvolution::ageing, StateEvolution::slip};

/// "ageing", "slip": as --evolution and JSON have them.
std::string_view to_string(StateEvolution evolution);
/// "rate-state-ageing", "rate-state-slip": as JSON names the law of friction with that state (`ageing` alone is an
/// effect).
std::string law_name(StateEvolution evolution);
/// Who stated it and where.
std::string_view source_of(StateEvolution evolution);
/// The equation of theta, as people write it.
std::string_view equation_of(StateEvolution evolution);
std::optional<StateEvolution> find_state_evolution(std::string_view name);
std::vector<std::string> state_evolution_names();

/// State variables that friction may have at most: a second one is for records whose decay has two lengths.
inline constexpr std::size_t kMostStates = 2;

/// a, and b_i with D_i of each state variable.
template <class T>
struct RateStateParameters {
  T a = T(0.0);                              ///< direct effect [1]
  std::array<T, kMostStates> b = {};         ///< evolution effect [1]
  std::array<T, kMostStates> distance = {};  ///< D_i, over which it evolves [m]
  T stiffness = T(0.0);                      ///< k, of the machine per normal force [1/m]
};

/// Stiffness per normal force below which steady sliding under one state variable is not stable: (b - a)/D_c [1/m]
/// (Ruina 1983); negative where friction rises with speed and sliding is stable on any spring.
inline double critical_stiffness(double a, double b, double distance) {
  return (b - a) / distance;
}
/// The same of so many state variables: of two by Routh's criterion for sliding that is disturbed a little. At most
/// zero: sliding is stable on any spring. Friction of two states can rise with speed, and sliding be unstable on a soft
/// spring all the same, where the quick state alone falls; it may then be stable again on a much softer one.
double critical_stiffness(const RateStateParameters<double>& parameters, std::size_t states);

}  // namespace tribofit
