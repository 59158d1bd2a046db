#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "tribofit/friction/effect_pairs.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/friction/evaluate.hpp"

namespace tribofit {

namespace {

constexpr std::size_t kBesideTheCatalogue = 2;  // alternatives of Effect: the form of rate-state, and Formula

/// The alternatives of Effect that are in the catalogue, default-constructed.
template <std::size_t... I>
std::vector<Effect> make_catalogue(std::index_sequence<I...>) {
  return {Effect(std::in_place_index<I>)...};
}

}  // namespace

std::span<const Effect> effect_catalogue() {
  static const std::vector<Effect> catalogue =
      make_catalogue(std::make_index_sequence<std::variant_size_v<Effect> - kBesideTheCatalogue>());
  return catalogue;
}

EffectInfo describe(const Effect& effect) {
  EffectInfo info = std::visit([](const auto& e) { return e.info(); }, effect);
  info.kinematic_effect = is_kinematic(effect);
  info.pairs = look_alikes(info.key);
  return info;
}

std::string_view to_string(EffectGroup group) {
  switch (group) {
    case EffectGroup::friction:
      return "friction";
    case EffectGroup::rig:
      return "rig";
    case EffectGroup::measurement:
      return "measurement";
    case EffectGroup::user:
      break;
  }
  return "your own";
}

bool is_kinematic(const Effect& effect) {
  return std::visit([]<class E>(const E&) { return hooks::KinematicEffect<E>; }, effect);
}

}  // namespace tribofit
