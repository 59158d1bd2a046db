#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "tribofit/friction/effects/all.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"

namespace tribofit {

void refuse_same(std::span<const Effect> effects) {
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const std::string key = describe(effects[k]).key;
    const auto* formula = std::get_if<Formula>(&effects[k]);
    for (const Effect& earlier : effects.first(k)) {
      if (describe(earlier).key == key) {
        throw InputError("the effect '" + key + "' is given twice", "name each effect once");
      }
      const auto* other = std::get_if<Formula>(&earlier);
      if (formula != nullptr && other != nullptr && formula->same_as(*other)) {
        throw InputError("the formulas '" + describe(earlier).key + "' and '" + key + "' are the same effect twice",
                         "leave one of them out");
      }
    }
    if (formula == nullptr) continue;
    for (const Effect& known : effect_catalogue()) {
      if (describe(known).key != key) continue;
      throw InputError("the formula '" + key + "' is named as an effect of the catalogue is", "give it another name");
    }
  }
}

Effect make_effect(std::string_view name) {
  const Effect forms[] = {Effect(std::in_place_type<RateStateHealing>), Effect(std::in_place_type<ForceLowPass>),
                          Effect(std::in_place_type<VelocityGainByDirection>)};
  const std::size_t colon = name.find(':');
  std::vector<std::string> known;
  for (const Effect& effect : effect_catalogue()) known.push_back(describe(effect).key);
  const auto key = std::find(known.begin(), known.end(), name.substr(0, colon));
  if (key == known.end()) {
    const std::string near = likely_name(name.substr(0, colon), known);
    throw InputError("there is no effect '" + std::string(name) + "'",
                     (near.empty() ? "" : "did you mean '" + near + "'? ") + "`identify effects` lists them all");
  }
  const Effect& effect = effect_catalogue()[static_cast<std::size_t>(key - known.begin())];
  if (colon == std::string_view::npos) return effect;
  for (const Effect& form : forms) {
    if (describe(form).spelled() == name) return form;
  }
  if (name.find('=') != std::string_view::npos) {
    throw InputError("values of parameters ('" + std::string(name) + "') are for `identify simulate`; a fit finds them",
                     "write it as " + *key);
  }
  const std::vector<EffectForm> offered = describe(effect).forms;
  throw InputError("the effect '" + *key + "' has no form '" + std::string(name.substr(colon + 1)) + "'",
                   offered.empty() ? "write it as " + *key : "did you mean '" + *key + ":" + offered[0].name + "'?");
}

}  // namespace tribofit
