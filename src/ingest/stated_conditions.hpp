#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raw_table.hpp"
#include "tribofit/ingest/conditions.hpp"
#include "tribofit/ingest/instruments.hpp"
#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// The condition that a file means by a name (ColumnName::base); nullptr: none.
const ConditionInfo* find_condition(std::string_view base);

/// A condition [SI] as a cell states it: with a unit of its own ("15mm"), else in that of its column. A bare load is in
/// N. Throws InputError, without a place, for what is not a number, has no unit or a wrong one, and for a value that
/// cannot be.
double condition_in_cell(const std::string& text, const ConditionInfo& info, const std::string& column,
                         const std::string& unit);

/// Whether the cell is a number without a unit.
bool is_bare_number(const std::string& text);

/// What facts of a file state of the test.
struct StatedConditions {
  Conditions conditions;           ///< SI, source "file"
  std::vector<std::string> notes;  ///< what looks like one and was not used
};

/// Friction radius, disc speed and load among the facts ("Radius [mm]: 15", "Set Force = -200", a property). A linear
/// speed is turned into that of the disc where the radius is stated too; a load below zero is compression. A radius
/// without a unit has that of the lengths in the table, a load that of its load column, where there is one; a value
/// without a unit is not used otherwise. Of two facts the first is taken.
StatedConditions conditions_in(std::span<const RawFact> facts, const RawTable& table);

/// Takes the conditions that neither the user nor the manifest stated from the instruments file.
ReadOptions with_declared_conditions(ReadOptions read, const Instruments& instruments);

/// Where the instruments file contradicts the conditions in use, or declares more than is used, as warnings.
/// rig_is_wanted: stiffness and ping frequency are used.
std::vector<std::string> warnings_beside_declared(const Conditions& used, const Instruments& instruments,
                                                  bool rig_is_wanted);

}  // namespace tribofit
