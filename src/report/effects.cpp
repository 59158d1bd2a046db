#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "numbers.hpp"
#include "terminal_text.hpp"
#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/oscillator/fingerprint.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {
namespace {

/// What an effect needs beyond friction and velocity: in short, and in full. An empty name is left out.
std::string channels_text(const Channels& needs, bool in_full) {
  const std::array<std::tuple<bool, const char*, const char*>, 10> all = {
      {{needs.acceleration, "acceleration", "block acceleration (from v_b)"},
       {needs.angle, "disc angle", "disc angle (measured, or from the speed), two revolutions"},
       {needs.distance, "distance", "sliding distance (from v_r)"},
       {needs.reversal_distance, "reversals", "distance since a reversal (from v_r), four reversals"},
       {needs.load, "load", "a load that varies"},
       {needs.force && !needs.load, "load", "the normal force, or friction as a force"},
       {needs.temperature, "temperature", "temperature"},
       {needs.stick_time, "stick time", "stick times that vary (from the cycles)"},
       {needs.lead, "stick", "v_r in stick"},
       {needs.plateau, needs.lead ? "" : "stick", "v_b in stick, with radius and speed stated"}}};
  std::string text;
  for (const auto& [needed, brief, full] : all) {
    const std::string name = in_full ? full : brief;
    if (needed && !name.empty()) text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

/// "sigma [s/mm] -0.0005..0.002", one after the other.
std::string parameters_text(std::span<const Parameter> parameters) {
  std::vector<std::string> texts;
  for (const Parameter& p : parameters) {
    texts.push_back(fmt::format("{} {:g}..{:g}", with_unit(p.name, p.unit), p.lower, p.upper));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// What the bounds are proportional to, as the end of a description; empty where they are the same on every rig.
std::string scaling_text(BoundScaling scaling) {
  using enum BoundScaling;
  constexpr std::array<std::pair<BoundScaling, const char*>, 13> kTexts = {
      {{with_slip_time, "in proportion to the slip time"},
       {against_slip_time, "in inverse proportion to the slip time"},
       {with_stick_time, "in proportion to the stick time"},
       {with_slip_length, "in proportion to the slip length"},
       {against_slip_length, "in inverse proportion to the slip length"},
       {against_top_speed, "in inverse proportion to the top speed"},
       {with_duration, "in proportion to the duration of the record"},
       {against_duration, "in inverse proportion to the duration of the record"},
       {with_distance, "in proportion to the distance slid"},
       {with_stroke, "in proportion to the strokes"},
       {with_mass, "in proportion to friction force over acceleration"},
       {with_speed, "from the speeds of the record"},
       {against_speed, "from the speeds of the record"}}};
  const auto at = std::find_if(kTexts.begin(), kTexts.end(), [&](const auto& text) { return text.first == scaling; });
  return at == kTexts.end() ? "" : std::string("; bounds ") + at->second;
}

void add_effect(const EffectInfo& effect, TerminalText& text) {
  constexpr std::size_t kNames = 15;
  text.raw(fmt::format("{} ({})\n", text.bold(effect.spelled()), to_string(effect.group)));
  text.line(effect.statement);
  text.raw("\n");
  text.item("equation", effect.equation, kNames);
  text.item("source", effect.source, kNames);
  const std::string needs = channels_text(effect.needs, true);
  text.item("needs", needs.empty() ? "friction and velocity" : "friction, velocity, " + needs, kNames);
  if (!effect.experiment.empty()) text.item("best shown by", effect.experiment, kNames);
  for (const EffectForm& form : effect.forms) {
    text.item("other form", effect.key + ":" + form.name + ": " + form.statement, kNames);
  }
  text.raw("\n");
  ReportTable table;
  table.text({"parameter", "unit"}).numbers({"lower", "upper", "start"});
  for (const Parameter& p : effect.parameters) {
    table.rows.push_back(
        {p.name, p.unit, fmt::format("{:g}", p.lower), fmt::format("{:g}", p.upper), fmt::format("{:g}", p.start)});
  }
  text.table(table);
  text.raw("\n");
  for (const Parameter& p : effect.parameters) {
    const bool own = p.scope == ParameterScope::record;
    text.item(p.name, p.description + (own ? "; another value in each record" : "") + scaling_text(p.bound_scaling),
              kNames);
  }
  if (!effect.pairs.empty()) text.raw("\n  looks like\n");
  for (const LookAlike& pair : effect.pairs) {
    text.raw("    " + text.bold(pair.key) + "\n");
    text.line(pair.test, 6);
  }
}

}  // namespace

std::string render_laws(std::span<const Law> laws, const TerminalOptions& options) {
  TerminalText text(options);
  text.heading("Laws (--law KEY); each model has one");
  for (const Law& law : laws) {
    const LawInfo info = describe(law);
    text.raw("  " + text.bold(std::string(to_string(law))) + "\n");
    text.line(info.statement, 4);
    text.line(info.equation, 4);
    text.raw("    " + text.dim(wrapped(parameters_text(info.parameters), text.width(), 4)) + "\n");
  }
  text.heading("Rate and state of velocity steps and holds (--evolution; identify help kinds)");
  for (const StateEvolution evolution : state_evolutions) {
    text.raw("  " + text.bold(std::string(to_string(evolution))) + "\n");
    text.line(fmt::format("mu = mu_0 + a ln(v/v0) + b ln(v0 theta/D_c), {}", equation_of(evolution)), 4);
  }
  text.raw("\n");
  return text.take();
}

std::string render_effects(std::span<const EffectInfo> effects, const TerminalOptions& options) {
  TerminalText text(options);
  text.raw("Effects that can be added to a base law with --effect KEY (bounds: dry contacts)\n");
  constexpr std::array<std::pair<EffectGroup, const char*>, 3> kGroups = {
      {{EffectGroup::friction, "Friction"}, {EffectGroup::rig, "Rig"}, {EffectGroup::measurement, "Measurement"}}};
  for (const auto& [group, title] : kGroups) {
    text.heading(title);
    for (const EffectInfo& effect : effects) {
      if (effect.group != group) continue;
      text.raw("  " + text.bold(effect.key) + "\n");
      text.line(effect.statement, 4);
      for (const EffectForm& form : effect.forms) {
        text.line(effect.key + ":" + form.name + ": " + form.statement, 4);
      }
      const std::string needs = channels_text(effect.needs, false);
      const std::string all = parameters_text(effect.parameters) + (needs.empty() ? "" : "; needs " + needs);
      text.raw("    " + text.dim(wrapped(all, text.width(), 4)) + "\n");
    }
  }
  if (!effects.empty()) text.next({"to read one in full", "identify effects " + effects.front().key});
  return text.take();
}

std::string render_effect(const EffectInfo& effect, const TerminalOptions& options, const Fingerprint* print) {
  TerminalText text(options);
  add_effect(effect, text);
  if (print != nullptr) {
    text.raw("\n");
    text.line("where it shows, simulated with " + print->conditions);
    text.raw("\n" + render_fingerprint(*print, options));
  }
  text.next(effect.kinematic_effect
                ? Suggestion{"to look for it", "identify diagnose --radius 15mm trace.csv"}
                : Suggestion{"to fit it", "identify --radius 15mm --effect " + effect.spelled() + " trace.csv"});
  return text.take();
}

}  // namespace tribofit
