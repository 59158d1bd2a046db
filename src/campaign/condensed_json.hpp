#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tribofit/campaign/condensed.hpp"

namespace tribofit {

/// A condensed run as one line of JSON, numbers to eight digits. What is not known is null.
std::string condensed_text(const CondensedRun& run);

/// The run that condensed_text() wrote. Throws nlohmann::ordered_json::exception for another object.
CondensedRun condensed_from(const nlohmann::ordered_json& json);

}  // namespace tribofit
