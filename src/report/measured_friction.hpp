#pragma once

#include <string>

#include "json_parts.hpp"
#include "report_parts.hpp"
#include "tribofit/segmentation/force_statistics.hpp"
#include "tribofit/segmentation/friction_levels.hpp"

// What is said of friction without a law.

namespace tribofit {

Facts force_facts(const ForceStatistics& force, const std::string& unit);
Json force_json(const ForceStatistics& force);

void add_friction_levels(const FrictionLevels& levels, const std::string& unit, Facts& facts);
Json friction_levels_json(const FrictionLevels& levels);

}  // namespace tribofit
