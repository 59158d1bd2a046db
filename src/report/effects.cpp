#include <algorithm>
#include <cmath>

#include "report/pictures/picture.hpp"
#include "report_parts.hpp"
#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/report/terminal.hpp"
#include "tribofit/study/fingerprint.hpp"

namespace tribofit {
namespace {

/// What an effect needs beyond friction and velocity, in short or in full.
std::string channels_text(const Channels& needs, bool in_full) {
  const struct {
    bool is_needed;
    std::string brief, full;
  } all[] = {{needs.acceleration, "acceleration", "block acceleration (from v_b)"},
             {needs.angle, "disc angle", "disc angle (measured, or from the speed), two revolutions"},
             {needs.distance, "distance", "sliding distance (from v_r)"},
             {needs.reversal_distance, "reversals", "distance since a reversal (from v_r), four reversals"},
             {needs.load, "load", "a load that varies"},
             {needs.force && !needs.load, "load", "the normal force, or friction as a force"},
             {needs.temperature, "temperature", "temperature"},
             {needs.stick_time, "stick time", "stick times that vary (from the cycles)"},
             {needs.lead, "stick", "v_r in stick"},
             {needs.plateau, needs.lead ? "" : "stick", "v_b in stick, with radius and speed stated"}};
  std::string text;
  for (const auto& [is_needed, brief, full] : all) {
    const std::string& name = in_full ? full : brief;
    if (is_needed && !name.empty()) text += (text.empty() ? "" : ", ") + name;
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

/// What the bounds are proportional to; empty where they are the same on every rig.
std::string scaling_text(BoundScaling scaling) {
  using enum BoundScaling;
  constexpr std::pair<BoundScaling, const char*> kTexts[] = {
      {with_slip_time, "in proportion to the slip time"},
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
      {against_speed, "from the speeds of the record"}};
  for (const auto& [one, text] : kTexts) {
    if (one == scaling) return std::string("; bounds ") + text;
  }
  return "";
}

using Kind = ReportText::Kind;

/// A name, and what is said of it, a line each; empty lines are left out.
void add_entry(const std::string& name, std::initializer_list<std::string> details, ReportSection& section) {
  section.text(Kind::name, name);
  for (const std::string& detail : details) section.text(Kind::detail, detail);
}

std::string form_text(const EffectInfo& effect, const EffectForm& form) {
  return effect.key + ":" + form.name + ": " + form.statement;
}

/// Parameters with their bounds, then what each is.
ReportSection parameters_section(const EffectInfo& effect) {
  ReportSection section{"parameters", "Parameters", {}};
  ReportTable table;
  table.text({"parameter", "unit"}).numbers({"lower", "upper", "start"});
  Facts meanings;
  for (const Parameter& p : effect.parameters) {
    table.rows.push_back({p.name, p.unit, general(p.lower), general(p.upper), general(p.start)});
    const bool own = p.scope == ParameterScope::record;
    meanings.emplace_back(
        p.name, p.description + (own ? "; another value in each record" : "") + scaling_text(p.bound_scaling));
  }
  section.add(std::move(table));
  section.add(ReportFacts{std::move(meanings)});
  return section;
}

// Fingerprints.

constexpr std::size_t kRows = 13, kMargin = 11;

/// An axis of the picture.
Scale scale_over(const Fingerprint& print, std::vector<double> FingerprintCloud::*values, double si) {
  Extent extent(false);
  for (const FingerprintCloud& cloud : print.clouds) extent.add(in_unit(cloud.*values, si));
  return scale_of({}, extent, 0, 1);
}

/// Ends to three digits, of one that hardly moves to as many as distinguish them.
std::string end_text(const Scale& axis, double value) {
  const double size = std::max(std::abs(axis.low), std::abs(axis.high)), width = axis.high - axis.low;
  if (std::abs(value) < 1e-3 * width) return "0";
  return general(value, std::min(6, 3 + static_cast<int>(std::max(0.0, std::floor(std::log10(size / width))))));
}

}  // namespace

std::string render_fingerprint(const Fingerprint& print, const TerminalOptions& options) {
  const std::size_t columns = std::clamp<std::size_t>(options.width, 40, 80) - kMargin - 1;
  const Scale x = scale_over(print, &FingerprintCloud::x, print.x.si);
  const Scale y = scale_over(print, &FingerprintCloud::y, print.y.si);
  const auto cell = [](const Scale& axis, double value, std::size_t count) {
    return static_cast<std::size_t>(std::lround(axis.part(value) * static_cast<double>(count - 1)));
  };
  const auto sign = [&](const char* full, const char* plain) { return options.unicode ? full : plain; };
  const auto mark_of = [&](std::size_t cloud) { return cloud == 0 ? sign("\u2022", "*") : sign("\u25e6", "o"); };
  const auto row_of = [&](double value) { return kRows - 1 - cell(y, value, kRows); };
  std::vector<std::vector<std::string>> cells(kRows, std::vector<std::string>(columns, " "));
  if (y.low < 0 && y.high > 0) cells[row_of(0)].assign(columns, sign("\u2508", "."));
  for (std::size_t k = print.clouds.size(); k-- > 0;) {  // the first lies on top
    const FingerprintCloud& cloud = print.clouds[k];
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      cells[row_of(cloud.y[i] / print.y.si)][cell(x, cloud.x[i] / print.x.si, columns)] = mark_of(k);
    }
  }
  std::string text = "  " + with_unit(print.y.label, print.y.unit);
  for (std::size_t k = 0; k < print.clouds.size(); ++k) {
    if (!print.clouds[k].name.empty()) text += fmt::format("   {} {}", mark_of(k), print.clouds[k].name);
  }
  for (std::size_t row = 0; row < kRows; ++row) {
    const std::string end = row == 0 ? end_text(y, y.high) : row + 1 == kRows ? end_text(y, y.low) : "";
    while (!cells[row].empty() && cells[row].back() == " ") cells[row].pop_back();
    text += fmt::format("\n{:>{}} {}{}", end, kMargin - 2, sign("\u2502", "|"), fmt::join(cells[row], ""));
  }
  text += fmt::format("\n{:{}}{}", "", kMargin - 1, sign("\u2514", "+"));
  for (std::size_t i = 0; i < columns; ++i) text += sign("\u2500", "-");
  const std::string left = end_text(x, x.low), right = end_text(x, x.high);
  const std::string label = with_unit(print.x.label, print.x.unit);
  const std::size_t used = left.size() + label.size() + right.size(), gap = columns > used ? columns - used : 2;
  return text +
         fmt::format("\n{:{}}{}{:{}}{}{:{}}{}\n", "", kMargin, left, "", gap / 2, label, "", gap - gap / 2, right);
}

Report laws_report(std::span<const Law> laws) {
  ReportSection of_speed{"laws", "Laws (--law KEY); each model has one", {}},
      of_state{"evolution", "Rate and state of velocity steps and holds (--evolution; identify help kinds)", {}};
  for (const Law& law : laws) {
    const LawInfo info = describe(law);
    add_entry(std::string(to_string(law)), {info.statement, info.equation, parameters_text(info.parameters)}, of_speed);
  }
  for (const StateEvolution evolution : state_evolutions) {
    add_entry(std::string(to_string(evolution)),
              {fmt::format("mu = mu_0 + a ln(v/v0) + b ln(v0 theta/D_c), {}", equation_of(evolution))}, of_state);
  }
  Report report;
  report.add({std::move(of_speed), std::move(of_state)});
  return report;
}

Report effects_report(std::span<const EffectInfo> effects) {
  constexpr std::pair<EffectGroup, const char*> kGroups[] = {
      {EffectGroup::friction, "Friction"}, {EffectGroup::rig, "Rig"}, {EffectGroup::measurement, "Measurement"}};
  Report report;
  ReportSection begin{"effects", "", {}};
  begin.text(Kind::title, "Effects that can be added to a base law with --effect KEY (bounds: dry contacts)");
  report.add({std::move(begin)});
  for (const auto& [group, title] : kGroups) {
    ReportSection section{title, title, {}};
    for (const EffectInfo& effect : effects) {
      if (effect.group != group) continue;
      add_entry(effect.key, {effect.statement}, section);
      for (const EffectForm& form : effect.forms) section.text(Kind::detail, form_text(effect, form));
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
  for (const EffectForm& form : effect.forms) facts.emplace_back("other form", form_text(effect, form));
  about.add(ReportFacts{std::move(facts)});
  for (const LookAlike& pair : effect.pairs) add_entry(pair.key, {pair.test}, alike);
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
