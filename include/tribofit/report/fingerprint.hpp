#pragma once

#include <string>

#include "tribofit/oscillator/fingerprint.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {

/// A fingerprint as a picture of characters, at most 80 columns and 20 lines, with its axes in the units people read.
std::string render_fingerprint(const Fingerprint& fingerprint, const TerminalOptions& options = {});

/// One effect in full, as render_effect() of terminal.hpp, with its picture.
std::string render_effect(const EffectInfo& effect, const Fingerprint& fingerprint,
                          const TerminalOptions& options = {});

}  // namespace tribofit
