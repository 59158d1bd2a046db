#pragma once

#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/friction/effects/all.hpp"

/// The effect of that name. Usage error when there is none, with the nearest known name.
tribofit::Effect effect_named(const std::string& name);
/// Usage error: two effects are the same, cannot act together, or not on one of the laws.
void refuse_clashes(const std::vector<tribofit::Effect>& effects, const std::vector<tribofit::Law>& laws);
/// The keys of all laws, as in "a, b or c".
std::string list_of_laws();

/// What is typed as --start and --bounds, for the parameters that the laws with these effects have. Usage error
/// (UsageError) where there is no such parameter, with the nearest one, where a value cannot be read, or
/// where a start lies beyond its bounds.
std::vector<tribofit::GivenParameter> given_from(const Settings& settings, const std::vector<tribofit::Law>& laws,
                                                 const std::vector<tribofit::Effect>& effects);

/// What is typed as --cycles and --exclude. Usage error where it cannot be read.
tribofit::Selection selection_from(const Settings& settings);
