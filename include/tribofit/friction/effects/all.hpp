#pragma once

#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "tribofit/friction/effects/bristle.hpp"
#include "tribofit/friction/effects/rate_state.hpp"
#include "tribofit/friction/effects/viscous.hpp"
#include "tribofit/friction/formula.hpp"

namespace tribofit {

/// The one list of effects. Formula, last, is the user's own (see formula.hpp) and is not part of the catalogue.
using Effect = std::variant<Viscous, RateState, Bristle, Formula>;

/// Every effect of the catalogue, in its order.
std::span<const Effect> effect_catalogue();

/// What `effect` says about itself.
EffectInfo describe(const Effect& effect);

/// The effect of that key. Throws InputError that offers the nearest known key.
Effect make_effect(std::string_view key);

}  // namespace tribofit
