#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/friction/effect.hpp"
#include "tribofit/friction/laws/all.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

struct Fingerprint;  // study/fingerprint.hpp

struct TerminalOptions : ReportOptions {
  bool colour = false;
  bool unicode = false;     ///< bars and plus-minus signs beyond ASCII can be shown
  std::size_t width = 100;  ///< columns; sentences are broken there
};

/// A report for people at a terminal: the texts, facts and tables of its sections, then what to do next. Sentences are
/// broken at options.width (at least 40 columns), columns of most detail go where there is little room; no line but a
/// word longer than the width is wider. Plain ASCII apart from what the file itself brings, unless options.unicode.
std::string render_terminal(const Report& report, const TerminalOptions& options = {});

/// The list of laws: key, statement, equation and parameters.
Report laws_report(std::span<const Law> laws);

/// The catalogue of effects by their groups.
Report effects_report(std::span<const EffectInfo> effects);

/// One effect in full: equation, source, parameters with units and bounds, channels, best experiment, what looks like
/// it, and its picture where there is a fingerprint.
Report effect_report(const EffectInfo& effect, const Fingerprint* fingerprint = nullptr,
                     const TerminalOptions& options = {});

/// A fingerprint as a picture of characters, at most 80 columns and 20 lines, with its axes in the units people read.
std::string render_fingerprint(const Fingerprint& fingerprint, const TerminalOptions& options = {});

/// `argument` as a POSIX shell needs it to read the same word back.
std::string shell_quoted(const std::string& argument);

/// `identify diagnose` of a trace or a folder with those options of `identify` that it has, too.
std::string diagnose_command(const std::vector<std::string>& arguments, const std::string& path);

}  // namespace tribofit
