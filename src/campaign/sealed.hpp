#pragma once

#include <optional>
#include <string>

#include "output/json.hpp"

namespace tribofit {

/// The object in a file that sealed() made (run_result.hpp); nothing where it is missing, damaged or no object.
std::optional<Json> read_sealed(const std::string& path);

}  // namespace tribofit
