#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "numbers.hpp"
#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/report/terminal.hpp"
#include "tribofit/study/fingerprint.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kNames = 15;  // columns of names on a terminal

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

using Kind = ReportText::Kind;

/// Parameters with their bounds, then what each is.
ReportSection parameters_section(const EffectInfo& effect) {
  ReportSection section{"parameters", "Parameters", {}};
  ReportTable table;
  table.text({"parameter", "unit"}).numbers({"lower", "upper", "start"});
  Facts meanings;
  for (const Parameter& p : effect.parameters) {
    table.rows.push_back(
        {p.name, p.unit, fmt::format("{:g}", p.lower), fmt::format("{:g}", p.upper), fmt::format("{:g}", p.start)});
    const bool own = p.scope == ParameterScope::record;
    meanings.emplace_back(
        p.name, p.description + (own ? "; another value in each record" : "") + scaling_text(p.bound_scaling));
  }
  section.add(std::move(table));
  section.add(ReportFacts{std::move(meanings), kNames});
  return section;
}

}  // namespace

Report laws_report(std::span<const Law> laws) {
  ReportSection of_speed{"laws", "Laws (--law KEY); each model has one", {}},
      of_state{"evolution", "Rate and state of velocity steps and holds (--evolution; identify help kinds)", {}};
  for (const Law& law : laws) {
    const LawInfo info = describe(law);
    of_speed.text(Kind::name, std::string(to_string(law)));
    for (const std::string& text : {info.statement, info.equation, parameters_text(info.parameters)}) {
      of_speed.text(Kind::detail, text);
    }
  }
  for (const StateEvolution evolution : state_evolutions) {
    of_state.text(Kind::name, std::string(to_string(evolution)));
    of_state.text(Kind::detail, fmt::format("mu = mu_0 + a ln(v/v0) + b ln(v0 theta/D_c), {}", equation_of(evolution)));
  }
  Report report;
  report.add({std::move(of_speed), std::move(of_state)});
  return report;
}

Report effects_report(std::span<const EffectInfo> effects) {
  constexpr std::array<std::pair<EffectGroup, const char*>, 3> kGroups = {
      {{EffectGroup::friction, "Friction"}, {EffectGroup::rig, "Rig"}, {EffectGroup::measurement, "Measurement"}}};
  Report report;
  ReportSection begin{"effects", "", {}};
  begin.text(Kind::title, "Effects that can be added to a base law with --effect KEY (bounds: dry contacts)");
  report.add({std::move(begin)});
  for (const auto& [group, title] : kGroups) {
    ReportSection section{title, title, {}};
    for (const EffectInfo& effect : effects) {
      if (effect.group != group) continue;
      section.text(Kind::name, effect.key);
      section.text(Kind::detail, effect.statement);
      for (const EffectForm& form : effect.forms) {
        section.text(Kind::detail, effect.key + ":" + form.name + ": " + form.statement);
      }
      const std::string needs = channels_text(effect.needs, false);
      section.text(Kind::detail, parameters_text(effect.parameters) + (needs.empty() ? "" : "; needs " + needs));
    }
    report.add({std::move(section)});
  }
  if (!effects.empty()) report.next = {{"to read one in full", "identify effects " + effects.front().key}};
  return report;
}

Report effect_report(const EffectInfo& effect, const Fingerprint* print, const TerminalOptions& options) {
  ReportSection about{"effect", "", {}}, alike{"alike", "Looks like", {}}, shown{"fingerprint", "Where it shows", {}};
  about.text(Kind::title, fmt::format("{} ({})", effect.spelled(), to_string(effect.group)));
  about.plain(effect.statement);
  const std::string needs = channels_text(effect.needs, true);
  Facts facts = {{"equation", effect.equation},
                 {"source", effect.source},
                 {"needs", needs.empty() ? "friction and velocity" : "friction, velocity, " + needs}};
  if (!effect.experiment.empty()) facts.emplace_back("best shown by", effect.experiment);
  for (const EffectForm& form : effect.forms) {
    facts.emplace_back("other form", effect.key + ":" + form.name + ": " + form.statement);
  }
  about.add(ReportFacts{std::move(facts), kNames});
  for (const LookAlike& pair : effect.pairs) {
    alike.text(Kind::name, pair.key);
    alike.text(Kind::detail, pair.test);
  }
  if (print != nullptr) {
    shown.plain("simulated with " + print->conditions);
    shown.text(Kind::drawing, render_fingerprint(*print, options));
  }
  Report report;
  report.add({std::move(about), parameters_section(effect), std::move(alike), std::move(shown)});
  report.next = {effect.kinematic_effect
                     ? Suggestion{"to look for it", "identify diagnose --radius 15mm trace.csv"}
                     : Suggestion{"to fit it", "identify --radius 15mm --effect " + effect.spelled() + " trace.csv"}};
  return report;
}

}  // namespace tribofit
