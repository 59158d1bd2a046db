#include <fmt/format.h>

#include <algorithm>

#include "numbers.hpp"
#include "style.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {
namespace {

std::string channels_text(const Channels& needs) {
  std::string text;
  const auto add = [&](bool needed, std::string_view name) {
    if (needed) text += (text.empty() ? "" : ", ") + std::string(name);
  };
  add(needs.acceleration, "block acceleration (from v_b)");
  add(needs.angle, "disc angle (measured, or from the speed)");
  add(needs.distance, "sliding distance (from v_r)");
  add(needs.load, "load");
  add(needs.temperature, "temperature");
  add(needs.stick_time, "stick time (from the cycles)");
  return text.empty() ? "friction and velocity" : "friction, velocity, " + text;
}

std::string line(const Style& style, std::string_view name, std::string_view text) {
  constexpr std::size_t kIndent = 17;
  return fmt::format("  {:<{}}", name, kIndent - 2) + wrapped(text, style.width, kIndent) + "\n";
}

std::string bound(double value) {
  return fmt::format("{:g}", value);
}

}  // namespace

std::string render_effects(std::span<const EffectInfo> effects, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  std::size_t longest = 0;
  for (const EffectInfo& effect : effects) longest = std::max(longest, effect.key.size());
  std::string text = "Effects that can be added to a base law with --effect KEY\n\n";
  for (const EffectInfo& effect : effects) {
    text += fmt::format("  {}{:<{}}{}  ", style.bold, effect.key, longest, style.off);
    text += wrapped(effect.statement, style.width, longest + 4) + "\n";
  }
  if (!effects.empty()) {
    text += "\nNext, to read one in full:\n  identify effects " + effects.front().key + "\n";
  }
  return text;
}

std::string render_effect(const EffectInfo& effect, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  std::string text = fmt::format("{}{}{}\n", style.bold, effect.key, style.off);
  text += "  " + wrapped(effect.statement, style.width, 2) + "\n\n";
  text += line(style, "equation", effect.equation);
  text += line(style, "source", effect.source);
  text += line(style, "needs", channels_text(effect.needs));
  if (!effect.experiment.empty()) text += line(style, "best shown by", effect.experiment);
  text += "\n";
  Table table({"parameter", "unit", "lower", "upper", "start"}, {true, true, false, false, false});
  for (const Parameter& p : effect.parameters) {
    table.add({p.name, p.unit, bound(p.lower), bound(p.upper), bound(p.start)});
  }
  text += table.text(2, style.dim, style.off);
  text += "\nNext, to fit it:\n  identify --radius 15mm --effect " + effect.key + " trace.csv\n";
  return text;
}

}  // namespace tribofit
