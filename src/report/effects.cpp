#include <fmt/format.h>

#include <algorithm>

#include "numbers.hpp"
#include "style.hpp"
#include "tribofit/report/fingerprint.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {
namespace {

std::string channels_text(const Channels& needs) {
  std::string text;
  const auto add = [&](bool needed, std::string_view name) {
    if (needed) text += (text.empty() ? "" : ", ") + std::string(name);
  };
  add(needs.acceleration, "block acceleration (from v_b)");
  add(needs.angle, "disc angle (measured, or from the speed), two revolutions");
  add(needs.distance, "sliding distance (from v_r)");
  add(needs.load, "a load that varies");
  add(needs.force && !needs.load, "the normal force, or friction as a force");
  add(needs.temperature, "temperature");
  add(needs.stick_time, "stick times that vary (from the cycles)");
  add(needs.lead, "v_r in stick");
  add(needs.plateau, "v_b in stick, with radius and speed stated");
  return text.empty() ? "friction and velocity" : "friction, velocity, " + text;
}

/// "sigma [s/mm] -0.0005..0.002", one after the other.
std::string parameters_text(const EffectInfo& effect) {
  std::string text;
  for (const Parameter& p : effect.parameters) {
    text += (text.empty() ? "" : ", ") + p.name + (p.unit == "1" ? "" : " [" + p.unit + "]") +
            fmt::format(" {:g}..{:g}", p.lower, p.upper);
  }
  return text;
}

/// Where one looks for it, in short, beyond friction and velocity.
std::string short_channels(const Channels& needs) {
  std::string text;
  const auto add = [&](bool needed, std::string_view name) {
    if (needed) text += (text.empty() ? "" : ", ") + std::string(name);
  };
  add(needs.acceleration, "acceleration");
  add(needs.angle, "disc angle");
  add(needs.distance, "distance");
  add(needs.load || needs.force, "load");
  add(needs.temperature, "temperature");
  add(needs.stick_time, "stick time");
  add(needs.lead || needs.plateau, "stick");
  return text;
}

std::string line(const Style& style, std::string_view name, std::string_view text) {
  constexpr std::size_t kIndent = 17;
  return fmt::format("  {:<{}}", name, kIndent - 2) + wrapped(text, style.width, kIndent) + "\n";
}

std::string bound(double value) {
  return fmt::format("{:g}", value);
}

std::string what_it_is(const EffectInfo& effect, const Style& style) {
  std::string text = fmt::format("{}{}{} ({})\n", style.bold, effect.spelled(), style.off, to_string(effect.group));
  text += "  " + wrapped(effect.statement, style.width, 2) + "\n\n";
  text += line(style, "equation", effect.equation);
  text += line(style, "source", effect.source);
  text += line(style, "needs", channels_text(effect.needs));
  if (!effect.experiment.empty()) text += line(style, "best shown by", effect.experiment);
  for (const EffectForm& form : effect.forms) {
    text += line(style, "other form", effect.key + ":" + form.name + ": " + form.statement);
  }
  text += "\n";
  Table table({"parameter", "unit", "lower", "upper", "start"}, {true, true, false, false, false});
  for (const Parameter& p : effect.parameters) {
    table.add({p.name, p.unit, bound(p.lower), bound(p.upper), bound(p.start)});
  }
  text += table.text(2, style.dim, style.off) + "\n";
  for (const Parameter& p : effect.parameters) {
    const bool own = p.scope == ParameterScope::record;
    text += line(style, p.name, p.description + (own ? "; another value in each record" : ""));
  }
  if (!effect.pairs.empty()) text += "\n  looks like\n";
  for (const LookAlike& pair : effect.pairs) {
    text +=
        fmt::format("    {}{}{}\n      ", style.bold, pair.key, style.off) + wrapped(pair.test, style.width, 6) + "\n";
  }
  return text;
}

std::string what_next(const EffectInfo& effect) {
  return effect.kinematic_effect
             ? "\nNext, to look for it:\n  identify diagnose --radius 15mm trace.csv\n"
             : "\nNext, to fit it:\n  identify --radius 15mm --effect " + effect.spelled() + " trace.csv\n";
}

}  // namespace

std::string render_effects(std::span<const EffectInfo> effects, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  std::string text = "Effects that can be added to a base law with --effect KEY (bounds: dry contacts)\n";
  for (const EffectGroup group : {EffectGroup::friction, EffectGroup::rig, EffectGroup::measurement}) {
    text += style.heading(group == EffectGroup::friction ? "Friction"
                          : group == EffectGroup::rig    ? "Rig"
                                                         : "Measurement");
    for (const EffectInfo& effect : effects) {
      if (effect.group != group) continue;
      text += fmt::format("  {}{}{}\n", style.bold, effect.key, style.off);
      text += "    " + wrapped(effect.statement, style.width, 4) + "\n";
      for (const EffectForm& form : effect.forms) {
        text += "    " + wrapped(effect.key + ":" + form.name + ": " + form.statement, style.width, 4) + "\n";
      }
      const std::string needs = short_channels(effect.needs);
      text += "    " + std::string(style.dim) +
              wrapped(parameters_text(effect) + (needs.empty() ? "" : "; needs " + needs), style.width, 4) +
              std::string(style.off) + "\n";
    }
  }
  if (!effects.empty()) {
    text += "\nNext, to read one in full:\n  identify effects " + effects.front().key + "\n";
  }
  return text;
}

std::string render_effect(const EffectInfo& effect, const TerminalOptions& options) {
  return what_it_is(effect, Style(options.colour, options.width)) + what_next(effect);
}

std::string render_effect(const EffectInfo& effect, const Fingerprint& print, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  return what_it_is(effect, style) + "\n  " +
         wrapped("where it shows, simulated with " + print.conditions, style.width, 2) + "\n\n" +
         render_fingerprint(print, options) + what_next(effect);
}

}  // namespace tribofit
