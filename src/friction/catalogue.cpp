#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "tribofit/friction/effects/all.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"

namespace tribofit {

namespace {

/// Every alternative of Effect but the last (Formula), default-constructed.
template <std::size_t... I>
std::vector<Effect> make_catalogue(std::index_sequence<I...>) {
  return {Effect(std::in_place_index<I>)...};
}

}  // namespace

std::span<const Effect> effect_catalogue() {
  static const std::vector<Effect> catalogue =
      make_catalogue(std::make_index_sequence<std::variant_size_v<Effect> - 1>());
  return catalogue;
}

EffectInfo describe(const Effect& effect) {
  return std::visit([](const auto& e) { return e.info(); }, effect);
}

Effect make_effect(std::string_view key) {
  std::vector<std::string> known;
  for (const Effect& effect : effect_catalogue()) {
    known.push_back(describe(effect).key);
    if (known.back() == key) return effect;
  }
  const std::string near = likely_name(key, known);
  throw InputError("there is no effect '" + std::string(key) + "'",
                   (near.empty() ? "" : "did you mean '" + near + "'? ") + "`identify effects` lists them all");
}

}  // namespace tribofit
