#pragma once

#include <span>
#include <string>
#include <vector>

#include "raw_table.hpp"
#include "tribofit/ingest/conditions.hpp"

namespace tribofit {

/// What facts of a file state of the test.
struct StatedConditions {
  Conditions conditions;           ///< SI, source "file"
  std::vector<std::string> notes;  ///< what looks like one and was not used
};

/// Friction radius, disc speed and load among the facts ("Radius [mm]: 15", "Set Force = -200", a property). A linear
/// speed is turned into that of the disc where the radius is stated too; a load below zero is compression. A radius
/// without a unit has that of the lengths in the table, a load that of its load column, where there is one; a value
/// without a unit is not used otherwise. Of two facts the first is taken.
StatedConditions stated_conditions(std::span<const RawFact> facts, const RawTable& table);

}  // namespace tribofit
