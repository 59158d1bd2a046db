#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "tribofit/friction/effect_pairs.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/friction/evaluate.hpp"

namespace tribofit {

Effect::Effect(const Effect&) = default;
Effect::Effect(Effect&&) noexcept = default;
Effect& Effect::operator=(const Effect&) = default;
Effect& Effect::operator=(Effect&&) noexcept = default;
Effect::~Effect() = default;

namespace {

constexpr std::size_t kBesideTheCatalogue = 4;  // alternatives of Effect: forms of others, and Formula

/// The alternatives of Effect that are in the catalogue, default-constructed.
template <std::size_t... I>
std::vector<Effect> make_catalogue(std::index_sequence<I...>) {
  return {Effect(std::in_place_index<I>)...};
}

}  // namespace

std::span<const Effect> effect_catalogue() {
  static const std::vector<Effect> catalogue =
      make_catalogue(std::make_index_sequence<std::variant_size_v<EffectAlternatives> - kBesideTheCatalogue>());
  return catalogue;
}

namespace {

bool shows_without_time(SketchView view) {
  constexpr std::array kViews = {SketchView::curve, SketchView::directions, SketchView::load, SketchView::temperature};
  return std::find(kViews.begin(), kViews.end(), view) != kViews.end();
}

EffectInfo own_words(const Effect& effect) {
  EffectInfo info = std::visit([](const auto& e) { return e.info(); }, effect);
  if (info.group != EffectGroup::user) info.needs.time |= !shows_without_time(info.sketch.view);
  info.kinematic_effect = is_kinematic(effect);
  return info;
}

/// The catalogue in its own words, each pair of look-alikes in both of its effects.
std::vector<EffectInfo> describe_catalogue() {
  std::vector<EffectInfo> infos;
  for (const Effect& effect : effect_catalogue()) infos.push_back(own_words(effect));
  const std::vector<EffectInfo> stated = infos;
  for (const EffectInfo& one : stated) {
    for (const LookAlike& pair : one.pairs) {
      const auto other =
          std::find_if(infos.begin(), infos.end(), [&](const EffectInfo& info) { return info.key == pair.key; });
      if (other != infos.end()) other->pairs.push_back({one.key, pair.test});
    }
  }
  return infos;
}

const std::vector<EffectInfo>& described_catalogue() {
  static const std::vector<EffectInfo> infos = describe_catalogue();
  return infos;
}

}  // namespace

EffectInfo describe(const Effect& effect) {
  const std::vector<EffectInfo>& catalogue = described_catalogue();
  if (effect.index() < catalogue.size()) return catalogue[effect.index()];
  EffectInfo info = own_words(effect);
  info.pairs = look_alikes(info.key);
  return info;
}

namespace {

template <class Has>
const Effect& effect_that(Has has) {
  const std::vector<EffectInfo>& infos = described_catalogue();
  return effect_catalogue()[static_cast<std::size_t>(std::find_if(infos.begin(), infos.end(), has) - infos.begin())];
}

}  // namespace

const Effect& effect_with(bool EffectInfo::*property) {
  return effect_that([&](const EffectInfo& info) { return info.*property; });
}

const Effect& effect_declared_by(InstrumentValue value) {
  return effect_that([&](const EffectInfo& info) { return info.declared_by == value; });
}

std::vector<LookAlike> look_alikes(std::string_view key) {
  for (const EffectInfo& info : described_catalogue()) {
    if (info.key == key) return info.pairs;
  }
  return {};
}

std::string discriminating_experiment(std::string_view key_a, std::string_view key_b) {
  for (const LookAlike& pair : look_alikes(key_a)) {
    if (pair.key == key_b) return pair.test;
  }
  return "";
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
