#pragma once

#include <string>

#include "report/json_parts.hpp"
#include "tribofit/workbench/session.hpp"

namespace tribofit::workbench {

/// What the server says of a session, as JSON.

/// Trace, laws, catalogue and choice to begin with.
Json begin_json(const WorkbenchSession& session);

/// A rung with its errors and parameters; without the parameters where it is only listed.
Json rung_json(const WorkbenchRung& rung, const Motion& motion, bool with_parameters);
Json rungs_json(const WorkbenchSession& session);

/// {"rung", "rungs", "turn", "report"}
Json picture_json(const WorkbenchPicture& picture, double turn, const WorkbenchSession& session);

/// A law over |v_r| [mm/s].
Json curve_json(const Curve& curve);
Json diagnosis_json(const WorkbenchDiagnosis& diagnosis);

}  // namespace tribofit::workbench
