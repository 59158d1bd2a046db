#pragma once

#include <string>
#include <vector>

#include "tribofit/ingest/conditions.hpp"
#include "tribofit/ingest/instruments.hpp"
#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// Takes the conditions that neither the user nor the manifest stated from the instruments file.
ReadOptions with_declared_conditions(ReadOptions read, const Instruments& instruments);

/// Where the instruments file contradicts the conditions in use, or declares more than is used, as warnings.
/// rig_is_wanted: stiffness and ping frequency are used.
std::vector<std::string> warnings_beside_declared(const Conditions& used, const Instruments& instruments,
                                                  bool rig_is_wanted);

}  // namespace tribofit
