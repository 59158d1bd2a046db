#pragma once

#include <vector>

#include "settings.hpp"

/// What is typed as --start and --bounds, for the parameters that the laws with these effects have. Wrong usage
/// (CLI::ValidationError) where there is no such parameter, with the nearest one, where a value cannot be read, or
/// where a start lies beyond its bounds.
std::vector<tribofit::GivenParameter> given_from(const Settings& settings, const std::vector<tribofit::BaseLaw>& laws,
                                                 const std::vector<tribofit::Effect>& effects);

/// What is typed as --cycles and --exclude. Wrong usage where it cannot be read.
tribofit::Selection selection_from(const Settings& settings);
