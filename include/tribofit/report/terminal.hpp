#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

struct Identification;  // fit/identification.hpp

struct TerminalOptions {
  bool colour = false;
  bool unicode = false;                ///< bars and plus-minus signs beyond ASCII can be shown
  std::size_t width = 100;             ///< columns; sentences are broken there
  bool instruments_declared = false;   ///< an instruments file was given
  bool csv_written = false;            ///< the CSV folder of this result exists already
  std::vector<std::string> arguments;  ///< the user's own options without traces and outputs, for the next command
  std::vector<std::string> inputs;     ///< traces and folders as the user named them; empty: the path of the trace
};

/// What a person reads after a run: trace and conditions, health, stick-slip, one table of parameters per fit with
/// their uncertainty, both protocols side by side, errors against the floor, the comparison of the laws, one sentence
/// on how good it is, and the next useful command with the user's own options.
///
/// Units as people read them: mm/s, s/mm, ms, rpm, mm. Plain ASCII apart from what the file itself brings.
std::string render_terminal(const Identification& result, const TerminalOptions& options = {});

/// The catalogue of effects: key and statement, one a line.
std::string render_effects(std::span<const EffectInfo> effects, const TerminalOptions& options = {});

/// One effect in full: equation, source, parameters with units and bounds, channels, best experiment.
std::string render_effect(const EffectInfo& effect, const TerminalOptions& options = {});

/// `argument` as a POSIX shell needs it to read the same word back.
std::string shell_quoted(const std::string& argument);

}  // namespace tribofit
