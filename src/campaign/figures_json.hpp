#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tribofit/campaign/figures.hpp"

namespace tribofit {

/// The figures of a run as one line of JSON, numbers to six digits. What is not known is null.
std::string figures_text(const RunFigures& figures);

/// The figures that figures_text() wrote. Throws nlohmann::ordered_json::exception for another object.
RunFigures figures_from(const nlohmann::ordered_json& json);

}  // namespace tribofit
