#include "tribofit/friction/state_evolution.hpp"

#include <cmath>

namespace tribofit {

namespace {

// In the order of StateEvolution; behind the prefix the name of the state alone.
constexpr std::array<std::string_view, 2> kLawNames = {"rate-state-ageing", "rate-state-slip"};
constexpr std::string_view kPrefix = "rate-state-";

}  // namespace

std::string_view to_string(StateEvolution evolution) {
  return kLawNames.at(static_cast<std::size_t>(evolution)).substr(kPrefix.size());
}

std::string_view equation_of(StateEvolution evolution) {
  return evolution == StateEvolution::ageing ? "d theta/dt = 1 - v theta/D_c"
                                             : "d theta/dt = -(v theta/D_c) ln(v theta/D_c)";
}

std::string law_name(StateEvolution evolution) {
  return std::string(kLawNames.at(static_cast<std::size_t>(evolution)));
}

std::string_view source_of(StateEvolution evolution) {
  return evolution == StateEvolution::ageing
             ? "J. H. Dieterich, J. Geophys. Res. 84 (1979) 2161, doi:10.1029/JB084iB05p02161"
             : "A. Ruina, J. Geophys. Res. 88 (1983) 10359, doi:10.1029/JB088iB12p10359";
}

std::optional<StateEvolution> find_state_evolution(std::string_view name) {
  for (const StateEvolution evolution : state_evolutions) {
    if (name == to_string(evolution)) return evolution;
  }
  return std::nullopt;
}

std::vector<std::string> state_evolution_names() {
  std::vector<std::string> names;
  for (const StateEvolution evolution : state_evolutions) names.emplace_back(to_string(evolution));
  return names;
}

double critical_stiffness(const RateStateParameters<double>& parameters, std::size_t states) {
  const auto& [a, b, distance, stiffness] = parameters;
  if (states == 1) return critical_stiffness(a, b[0], distance[0]);
  // In units of the speed, and with l = 1/D, disturbances grow as the roots of
  // a s^3 + (k - p) s^2 + (k (l_1 + l_2) - q) s + k l_1 l_2; at the critical stiffness the product of the middle
  // coefficients is that of the outer ones.
  const double first = 1 / distance[0], second = 1 / distance[1], sum = first + second, product = first * second;
  const double p = b[0] * first + b[1] * second - a * sum, q = (b[0] + b[1] - a) * product;
  const double half = 0.5 * (q + p * sum + a * product) / sum, square = half * half - p * q / sum;
  return square < 0 ? 0 : half + std::sqrt(square);
}

}  // namespace tribofit
