#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/json_parts.hpp"
#include "tribofit/workbench/session.hpp"

namespace tribofit::workbench {

/// Choices as JSON, in the units people read: {"law", "effects", "formulas", "start": {NAME: VALUE},
/// "bounds": {NAME: [LOWER, UPPER]}, "cycles": [FIRST, LAST] or null, "excluded": [[FROM, TO]]}.

/// JSON of a page or of a file, not more than a few levels deep. Throws InputError with the place where it is broken.
Json parsed(std::string_view text, const std::string& what);

/// The model of a choice. Throws InputError for effects that do not exist or do not go together, and formulas that do
/// not parse.
FrictionModel model_of(const WorkbenchChoice& choice);
/// Its effects, formulas among them.
std::vector<Effect> effects_of(const WorkbenchChoice& choice);

Json choice_json(const WorkbenchChoice& choice);
/// Its "cycles" and "excluded": the same for the same part of a record.
Json selection_json(const Selection& selection);
/// {"mu_s": 0.5} as names and values. Throws InputError for values that are not numbers.
std::vector<std::pair<std::string, double>> values_from(const Json& json);
/// Throws InputError for what is not a choice: unknown names and values that are not numbers.
WorkbenchChoice choice_from(const Json& json);

/// The part of the command line that says the choice.
std::vector<std::string> arguments_of(const WorkbenchChoice& choice);

/// Both are the same choice.
bool same(const WorkbenchChoice& a, const WorkbenchChoice& b);

/// What the server says of a session, as JSON.

/// Trace, laws, catalogue and choice to begin with.
Json begin_json(const WorkbenchSession& session);

/// {"rung", "rungs", "turn", "report"}
Json picture_json(const WorkbenchPicture& picture, double turn, const WorkbenchSession& session);

/// A law over |v_r| [mm/s].
Json curve_json(const Curve& curve);
Json diagnosis_json(const WorkbenchDiagnosis& diagnosis);

}  // namespace tribofit::workbench
