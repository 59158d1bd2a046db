#pragma once

#include "recording.hpp"

namespace tribofit {

/// Whether a force was recorded over an area [Pa].
bool is_stress(const FileRecord& run, Channel channel);

/// Throws InputError where a stress stands over a force or the other way round, which is no coefficient, and for a
/// shear stress alone.
void refuse_stress_beside_force(const FileRecord& run);

}  // namespace tribofit
