#pragma once

#include <string>

#include "tribofit/report/terminal.hpp"

namespace tribofit {

struct DiagnosedTraces;  // diagnosis/diagnosis.hpp

/// What a person reads after a diagnosis, in this order: what was diagnosed; the ladder of held-out errors as it falls,
/// with bars against the floor; where the base law fails; the verdict in one sentence; the added effects with their
/// parameters; what these data cannot tell apart and the experiment that would; what they cannot show at all; how the
/// finding did on runs that took no part; a closed form of what no effect explains; the next command to type, with the
/// user's own options.
///
/// No line but a word longer than the width is wider than options.width (at least 40 columns).
std::string render_diagnosis(const DiagnosedTraces& result, const TerminalOptions& options = {});

}  // namespace tribofit
