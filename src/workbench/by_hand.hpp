#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tribofit/workbench/session.hpp"

namespace tribofit::workbench {

/// See WorkbenchSession::curve(). rungs: every model visited.
Curve curve_by_hand(const std::vector<WorkbenchRung>& rungs, const WorkbenchChoice& choice,
                    const std::vector<std::pair<std::string, double>>& values);

}  // namespace tribofit::workbench
