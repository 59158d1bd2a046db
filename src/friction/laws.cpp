#include <cmath>
#include <utility>

#include "tribofit/friction/evaluate.hpp"
#include "tribofit/friction/laws/all.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"

namespace tribofit {

namespace {

template <std::size_t... I>
std::vector<Law> every_law(std::index_sequence<I...>) {
  return {Law(std::in_place_index<I>)...};
}

}  // namespace

std::span<const Law> law_catalogue() {
  static const std::vector<Law> catalogue = every_law(std::make_index_sequence<std::variant_size_v<Law>>());
  return catalogue;
}

LawInfo describe(const Law& law) {
  return std::visit([](const auto& l) { return l.info(); }, law);
}

std::string_view to_string(const Law& law) {
  return std::visit([]<class L>(const L&) { return L::key; }, law);
}

std::vector<std::string> law_keys() {
  std::vector<std::string> keys;
  for (const Law& law : law_catalogue()) keys.emplace_back(to_string(law));
  return keys;
}

std::optional<Law> find_law(std::string_view key) {
  for (const Law& law : law_catalogue()) {
    if (to_string(law) == key) return law;
  }
  return std::nullopt;
}

Law make_law(std::string_view key) {
  if (const std::optional<Law> law = find_law(key)) return *law;
  throw InputError("there is no law '" + std::string(key) + "'",
                   "did you mean '" + nearest_name(key, law_keys()) + "'?");
}

bool constant_in_slip(const Law& law) {
  return describe(law).constant_in_slip;
}

bool has_reduced_speed(const Law& law) {
  return std::visit([]<class L>(const L&) { return hooks::ReducesSpeed<L>; }, law);
}

std::optional<double> remaining_fall(const Law& law, std::span<const double> q, double v) {
  return std::visit(
      [&]<class L>(const L&) -> std::optional<double> {
        if constexpr (requires(double x) { L::remaining_fall(x); }) {
          return L::remaining_fall(L::steepness(q.data()) * v);
        } else {
          return std::nullopt;
        }
      },
      law);
}

double break_away_left(const Law& law, std::span<const double> q, double v) {
  return std::visit(
      [&]<class L>(const L&) {
        if constexpr (hooks::ReducesSpeed<L>) {
          return std::exp(-L::steepness(q.data()) * v);
        } else {
          std::vector<double> raised(q.begin(), q.end());
          raised[0] += 1;
          return L::friction(raised.data(), v) - L::friction(q.data(), v);
        }
      },
      law);
}

double friction_at_rest(const Law& law, std::span<const double> q) {
  return std::visit([&]<class L>(const L&) { return L::at_rest(q.data()); }, law);
}

bool is_possible(const Law& law, std::span<const double> q) {
  const std::vector<Parameter> parameters = describe(law).parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (parameters[k].lower >= 0 && !(q[k] >= 0)) return false;
  }
  return friction_at_rest(law, q) > 0;
}

double kinetic_friction(const Law& law, std::span<const double> q, double fastest) {
  if (describe(law).two_levels) return q[1];
  return std::visit([&]<class L>(const L&) { return L::friction(q.data(), fastest); }, law);
}

}  // namespace tribofit
