#include "tribofit/friction/model.hpp"

#include <algorithm>
#include <utility>

#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

namespace {

bool in_stick(const Effect& effect) {
  return std::visit([]<class E>(const E&) { return hooks::ActsInStick<E>; }, effect);
}

/// The contacts have an age, which counts the time of a rigid stick.
bool ages(const Effect& effect) {
  return std::visit([]<class E>(const E&) { return hooks::HasContactAge<E, double>; }, effect);
}

void refuse_idle(const std::vector<Effect>& effects, const Law& law) {
  for (const Effect& effect : effects) {
    const std::string why = obstacle_on(law, effect);
    if (why.empty()) continue;
    throw InputError("the effect '" + describe(effect).spelled() + "' cannot act: " + why,
                     "leave the effect out, or choose another law");
  }
}

void refuse_two_of_stick(const std::vector<Effect>& effects) {
  const auto creeping = std::count_if(effects.begin(), effects.end(), in_stick);
  if (creeping > 1) throw InputError("two effects that act in stick cannot be combined", "leave one of them out");
  const auto ageing = std::find_if(effects.begin(), effects.end(), ages);
  if (creeping == 0 || ageing == effects.end()) return;
  throw InputError("the effect '" + describe(*ageing).spelled() +
                       "' counts the time at rest and cannot be combined with one that lets the block creep in stick",
                   "leave one of them out");
}

}  // namespace

std::string obstacle_on(const Law& law, const Effect& effect) {
  const bool transforms = std::visit([]<class E>(const E&) { return hooks::TransformsSpeed<E, double>; }, effect);
  if (!transforms || has_reduced_speed(law)) return {};
  return "the " + std::string(to_string(law)) + " law has no scale of speed that it could change";
}

FrictionModel::FrictionModel(Law law, std::vector<Effect> effects, std::size_t records)
    : law_(law), effects_(std::move(effects)), records_(records) {
  // One order for any order given. A memory that acts in stick comes after those of rigid stick: it turns |mu| into
  // signed mu.
  std::stable_sort(effects_.begin(), effects_.end(), [&](const Effect& a, const Effect& b) {
    return std::pair(in_stick(a), a.index()) < std::pair(in_stick(b), b.index());
  });
  refuse_same(effects_);
  refuse_two_of_stick(effects_);
  refuse_idle(effects_, law_);
  for (const Parameter& parameter : describe(law_).parameters) {
    if (parameter.scales_with_friction) scaled_ |= 1U << slots_.size();
    slots_.push_back({parameter, ""});
  }
  base_count_ = slots_.size();
  for (const Effect& effect : effects_) {
    const EffectInfo info = describe(effect);
    offsets_.push_back(slots_.size());
    for (const Parameter& parameter : info.parameters) slots_.push_back({parameter, info.key});
    for (std::size_t k = 0; k < info.parameters.size() && records_ > 1; ++k) {
      if (!info.parameters[k].periodic || info.parameters[k].scope != ParameterScope::record) continue;
      own_.push_back({offsets_.back() + k, slots_.size()});
      for (std::size_t record = 2; record <= records_; ++record) {
        slots_.push_back({info.parameters[k], info.key});
        slots_.back().parameter.name += "[" + std::to_string(record) + "]";
        slots_.back().parameter.description += " in record " + std::to_string(record);
      }
    }
    std::visit(
        [&]<class E>(const E&) {
          if constexpr (hooks::Remembers<E, double> || hooks::HasContactAge<E, double>) ++state_count_;
        },
        effect);
  }
}

std::size_t FrictionModel::offset_of(std::string_view key) const {
  const auto at = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& slot) { return slot.effect == key; });
  return static_cast<std::size_t>(at - slots_.begin());
}

std::size_t FrictionModel::count_of(std::string_view key) const {
  return static_cast<std::size_t>(
      std::count_if(slots_.begin(), slots_.end(), [&](const Slot& slot) { return slot.effect == key; }));
}

bool FrictionModel::is_of_further_record(std::size_t k) const {
  return std::any_of(own_.begin(), own_.end(),
                     [&](const Own& own) { return k >= own.further && k < own.further + records_ - 1; });
}

std::size_t FrictionModel::slot_of(std::size_t k, std::size_t record) const {
  if (!has_values_of(record)) return k;
  const auto own = std::find_if(own_.begin(), own_.end(), [k](const Own& o) { return o.first == k; });
  return own == own_.end() ? k : own->further + record - 1;
}

std::vector<std::string> FrictionModel::effect_keys() const {
  std::vector<std::string> keys;
  for (const Effect& effect : effects_) keys.push_back(describe(effect).key);
  return keys;
}

std::vector<std::string> FrictionModel::effect_names() const {
  std::vector<std::string> names;
  for (const Effect& effect : effects_) names.push_back(describe(effect).spelled());
  return names;
}

Channels FrictionModel::needs() const {
  Channels all;
  for (const Effect& effect : effects_) {
    const Channels c = describe(effect).needs;
    all.acceleration |= c.acceleration;
    all.angle |= c.angle;
    all.distance |= c.distance;
    all.reversal_distance |= c.reversal_distance;
    all.load |= c.load;
    all.temperature |= c.temperature;
    all.stick_time |= c.stick_time;
    all.lead |= c.lead;
    all.force |= c.force;
    all.plateau |= c.plateau;
    all.time |= c.time;
  }
  return all;
}

bool FrictionModel::acts_in_stick() const {
  return std::any_of(effects_.begin(), effects_.end(), in_stick);
}

bool FrictionModel::acts_with(const Effect& effect) const {
  if (!obstacle_on(law_, effect).empty()) return false;
  if (in_stick(effect)) return !acts_in_stick() && std::none_of(effects_.begin(), effects_.end(), ages);
  return !ages(effect) || !acts_in_stick();
}

std::string FrictionModel::name() const {
  std::string text(to_string(law_));
  for (const std::string& name : effect_names()) text += " + " + name;
  return text;
}

}  // namespace tribofit
