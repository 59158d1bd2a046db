#pragma once

#include "recording.hpp"
#include "tribofit/ingest/trace.hpp"

namespace tribofit {

/// Makes a trace of a recording: friction from mu, force or torque; velocity in m/s; steps with their conditions.
/// Throws InputError when friction or velocity cannot be made of what there is.
Trace assemble(FileRecord run, const ReadOptions& options);

}  // namespace tribofit
