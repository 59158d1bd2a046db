#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/friction/effect.hpp"
#include "tribofit/friction/laws/all.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

struct Fingerprint;  // oscillator/fingerprint.hpp
struct RigIdentification;

struct TerminalOptions : ReportOptions {
  bool colour = false;
  bool unicode = false;     ///< bars and plus-minus signs beyond ASCII can be shown
  std::size_t width = 100;  ///< columns; sentences are broken there
};

/// What a person reads after a run: trace and conditions, health, stick-slip, one table of parameters per fit with
/// their uncertainty, both protocols side by side, errors against the noise floor, the comparison of the laws, one
/// sentence on how good it is, and the next useful command with the user's own options.
///
/// Units as people read them: mm/s, s/mm, ms, rpm, mm. Plain ASCII apart from what the file itself brings.
std::string render_terminal(const Identification& result, const TerminalOptions& options = {});

/// After a diagnosis, in this order: what was diagnosed; the ladder of held-out errors as it falls, with bars against
/// the noise floor; where the base law fails; the verdict in one sentence; what is not distinguishable with these
/// data and the discriminating experiment; what they cannot show at all; how the finding did on runs that were not used
/// in the fit; a closed form of what no effect explains; the whole law with its parameters; the next command, and the
/// page and the workbench for the same trace.
///
/// No line but a word longer than the width is wider than options.width (at least 40 columns).
std::string render_diagnosis(const DiagnosedTraces& result, const TerminalOptions& options = {});

/// After `identify rig`: trace, conditions, health, the rig with its uncertainties and the check by the slope of stick,
/// what limits it, and the next command.
std::string render_rig(const RigIdentification& result, const TerminalOptions& options = {});

/// After `identify twin`: the laws and the rig in a line each, measured and simulated motion side by side with their
/// difference in standard errors, where the twin fails, and the next command.
std::string render_twin(const TwinIdentification& result, const TerminalOptions& options = {});

/// The list of laws: key, statement, equation and parameters.
std::string render_laws(std::span<const Law> laws, const TerminalOptions& options = {});

/// The catalogue of effects: key and statement, one a line.
std::string render_effects(std::span<const EffectInfo> effects, const TerminalOptions& options = {});

/// One effect in full: equation, source, parameters with units and bounds, channels, best experiment, and its picture
/// where there is a fingerprint.
std::string render_effect(const EffectInfo& effect, const TerminalOptions& options = {},
                          const Fingerprint* fingerprint = nullptr);

/// A fingerprint as a picture of characters, at most 80 columns and 20 lines, with its axes in the units people read.
std::string render_fingerprint(const Fingerprint& fingerprint, const TerminalOptions& options = {});

/// `argument` as a POSIX shell needs it to read the same word back.
std::string shell_quoted(const std::string& argument);

/// `identify diagnose` of a trace or a folder with those options of `identify` that it has, too.
std::string diagnose_command(const std::vector<std::string>& arguments, const std::string& path);

}  // namespace tribofit
