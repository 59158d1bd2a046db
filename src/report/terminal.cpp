#include "tribofit/report/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "condition_texts.hpp"
#include "measures.hpp"
#include "numbers.hpp"
#include "style.hpp"
#include "terminal_fits.hpp"
#include "terminal_parts.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/version.hpp"
#include "verdict.hpp"

namespace tribofit {

std::string item(const Style& style, std::string_view name, std::string_view text) {
  constexpr std::size_t kNameWidth = 18;
  const std::string head = fmt::format("  {:<{}}", name, kNameWidth);
  return head + wrapped(text, style.width, kNameWidth + 2) + "\n";
}

std::string trace_lines(const Identification& r, const Style& style) {
  std::string text = fmt::format("{}tribofit {}{}  {}\n", style.bold, version, style.off, r.path);
  std::string line =
      fmt::format("{} samples, {} s at {}", grouped(r.samples), significant(r.duration, 4), rate_text(r.rate));
  if (r.motion.trimmed > 0) {
    line += fmt::format("; the first {} s (run-up) left out",
                        significant(static_cast<double>(r.motion.trimmed) * r.motion.step, 3));
  }
  text += "  " + line + "\n";
  const std::vector<std::string>& elsewhere = r.segmentation.notes;  // they stand with the stick-slip
  for (const std::string& note : r.notes) {
    if (std::find(elsewhere.begin(), elsewhere.end(), note) != elsewhere.end()) continue;
    text += "  " + wrapped(note, style.width, 2) + "\n";
  }
  return text;
}

std::string condition_lines(const Identification& r, const Style& style) {
  const Motion& m = r.motion;
  std::string text = style.heading("Conditions");
  for (const auto& [name, value] : condition_texts(m)) text += item(style, name, value);
  if (m.friction_kind == FrictionKind::force) {
    text += item(style, "friction", "is a force in newtons: no normal force is known");
  }
  return text;
}

std::string health_lines(const Identification& r, const Style& style) {
  std::string text = style.heading("Health");
  std::size_t found = 0;
  for (const HealthItem& check : r.motion.health) {
    if (check.status == HealthItem::Status::ok) continue;
    ++found;
    const bool problem = check.status == HealthItem::Status::problem;
    const std::string_view colour = problem ? style.red : style.yellow;
    const std::string head =
        fmt::format("  {}{:<8}{} {:<16} ", colour, problem ? "problem" : "warning", style.off, check.check);
    text += head + wrapped(check.message, style.width, 28) + "\n";
  }
  if (found == 0) text += fmt::format("  no problems found ({} checks)\n", r.motion.health.size());
  return text;
}

namespace {

std::string motion_sentence(const Segmentation& s) {
  switch (s.kind) {
    case MotionKind::always_slipping:
      return "the block never sticks: no cycles, friction is fitted over the whole slip";
    case MotionKind::always_sticking:
      return "the block never slips: there is no sliding friction to fit";
    case MotionKind::stick_slip:
      break;
  }
  const std::size_t both = count_of_cycles(s);
  if (both == s.cycles.size()) return fmt::format("{} with a stick and a slip", both);
  return fmt::format("{} with a stick and a slip ({} slips in all)", both, s.cycles.size());
}

std::string stick_slip_lines(const Identification& r, const Style& style) {
  const Segmentation& s = r.segmentation;
  std::string text = style.heading("Stick-slip");
  text += item(style, "cycles", motion_sentence(s));
  const auto measure = [&](std::string_view name, const Estimate& m, double unit, std::string_view unit_name,
                           std::string_view more = "") {
    if (!std::isfinite(m.value)) return;
    text += item(style, name, fmt::format("{} {}{}", with_error(m.value / unit, m.std_error / unit), unit_name, more));
  };
  if (s.kind == MotionKind::stick_slip) {
    measure("frequency", s.frequency, 1, "Hz", " (+/- is one standard error, here and below)");
    const SpectralPeak& peak = r.spectral_peak;
    if (peak.frequency > 0) {
      text += item(
          style, "spectrum of v_r",
          fmt::format("peak at {} Hz; a plain FFT would say {} Hz, in bins of {} Hz", significant(peak.frequency, 4),
                      significant(peak.bin_frequency, 4), significant(peak.bin_width, 3)));
    }
    measure("amplitude of v_r", s.amplitude, kMillimetre, "mm/s");
    const LongSticks sticks = long_sticks(s);
    const bool uneven = sticks.longest > 3 * s.stick_time.value;
    measure("stick time", s.stick_time, kMillisecond, "ms",
            uneven ? fmt::format("; the longest {} s, {} over 1 s", significant(sticks.longest, 3), sticks.count) : "");
    measure("slip time", s.slip_time, kMillisecond, "ms");
  }
  const Estimate& branches = s.branch_difference;
  const Interval interval = interval_of(branches);
  if (std::isfinite(branches.std_error) && (interval.lower > 0 || interval.upper < 0)) {
    text += item(
        style, "branches",
        fmt::format("at the same speed friction is {} by {}{} while speeding up than while slowing down",
                    branches.value > 0 ? "higher" : "lower", with_error(std::abs(branches.value), branches.std_error),
                    r.motion.friction_kind == FrictionKind::force ? " N" : ""));
  }
  if (s.rms_velocity > 0) text += item(style, "RMS of v_b", significant(s.rms_velocity / kMillimetre, 4) + " mm/s");
  for (const std::string& note : s.notes) text += item(style, "note", note);
  return text;
}

std::string ending(const Identification& r, const TerminalOptions& options, const Style& style) {
  std::string text = style.heading("Result");
  for (const std::string& warning : r.warnings) {
    text += fmt::format("  {}warning{} ", style.yellow, style.off) + wrapped(warning, style.width, 10) + "\n";
  }
  text += "  " + wrapped(verdict(r), style.width, 2) + "\n";
  const Suggestion next = next_command(r, options);
  text += "\n" + wrapped("Next, " + next.reason + ":", style.width, 0) + "\n  " + next.command + "\n";
  return text;
}

}  // namespace

std::string render_terminal(const Identification& result, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  std::string text = trace_lines(result, style);
  text += condition_lines(result, style);
  text += health_lines(result, style);
  text += stick_slip_lines(result, style);
  text += fit_lines(result, options, style);
  text += ending(result, options, style);
  return text;
}

}  // namespace tribofit
