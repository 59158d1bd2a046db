#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "diagnosis/conclusions.hpp"
#include "diagnosis_parts.hpp"
#include "report/charts/styles.hpp"
#include "report_parts.hpp"
#include "segmentation/counts.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

/// Cycles; samples where nothing sticks.
std::string amount_of_data(const DiagnosedTraces& result) {
  std::size_t cycles = 0, samples = 0;
  bool sticks = false, points = true;
  for (const Identification& trace : result.traces) {
    cycles += count_of_cycles(trace.segmentation);
    samples += trace.motion.size();
    points &= trace.motion.is_points();
    sticks |= trace.segmentation.kind == MotionKind::stick_slip;
  }
  if (points) return grouped(samples) + " points";
  if (!sticks) return grouped(samples) + " samples, no stick";
  return grouped(cycles) + (cycles == 1 ? " cycle" : " cycles");
}

/// The distinct texts that the traces give, in their order; an empty one is none.
template <class Text>
std::vector<std::string> distinct(const DiagnosedTraces& result, Text text) {
  std::vector<std::string> out;
  for (const Identification& trace : result.traces) {
    std::string own = text(trace);
    if (!own.empty() && std::find(out.begin(), out.end(), own) == out.end()) out.push_back(std::move(own));
  }
  return out;
}

/// What was diagnosed; notes, warnings and problems of the data, each once, with its trace where there are several.
ReportSection traces_section(const DiagnosedTraces& result) {
  ReportSection section{"record", "", {}, Medium::terminal};
  const bool one = result.traces.size() == 1;
  std::vector<std::string> known = {enumerated(distinct(result, kind_text))};
  for (const ConditionInfo& which : condition_infos) {
    const std::vector<std::string> values = distinct(result, [&](const Identification& trace) {
      const Condition& c = trace.motion.conditions.*which.member;
      return c.known() ? brief(c.value / which.si) : "";
    });
    if (!values.empty()) known.push_back(fmt::format("{} {}", fmt::join(values, ", "), which.unit));
  }
  known.push_back(amount_of_data(result));
  std::erase(known, "");
  section.text(ReportText::Kind::title,
               fmt::format("{}: {}",
                           one ? printable(result.traces.front().path) : fmt::format("{} traces", result.traces.size()),
                           fmt::join(known, "; ")));
  std::set<std::string> said;
  for (const Identification& trace : result.traces) {
    const auto remark = [&](const std::string& kind, const std::string& message) {
      const bool named = !one && message.find(trace.path) == std::string::npos;
      if (said.insert(message).second) section.plain(kind + (named ? trace.path + ": " : "") + message);
    };
    for (const std::string& note : trace.notes) remark("", note);
    for (const std::string& warning : trace.warnings) remark("warning: ", warning);
    // What is wrong with the data comes before what is wrong with the law.
    for (const HealthItem& check : trace.motion.health) {
      if (check.status == HealthItem::Status::problem) remark("problem: ", check.message);
    }
  }
  return section;
}

/// A chart of held-out errors beside the noise floor.
Chart errors_chart(const DiagnosedTraces& result, const char* id, const char* title, const char* note) {
  const std::string unit = result.traces.empty() ? "1" : friction_unit(result.traces.front().motion);
  Chart chart = chart_of(id, title, {}, {.quantity = "held-out error", .unit = unit, .from_zero = true}, note);
  chart.marks = {{result.diagnosis.floor_rmse, false, Dash::dashed, "noise floor"}};
  return chart;
}

/// Of what was fitted, in the order of EffectStatus.
constexpr std::array<Stroke, 5> kStatusStrokes = {
    dots(Colour::red, Symbol::circle, 10), dots(Colour::purple, Symbol::diamond, 10),
    dots(Colour::blue, Symbol::triangle_up, 9), dots(Colour::green, Symbol::square, 9),
    dots(Colour::grey, Symbol::triangle_down, 9)};

Chart ladder_chart(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  Chart chart = errors_chart(
      result, "ladder", "The ladder: held-out error, as effects are added",
      "Bars are one standard error. At the noise floor only noise and scatter from cycle to cycle are left.");
  ChartLine& line = chart.line("held-out error", {Colour::blue, Dash::solid, Symbol::circle, 2, 10});
  for (std::size_t k = 0; k < d.ladder.size(); ++k) {
    const Rung& rung = d.ladder[k];
    const auto x = static_cast<double>(k);
    chart.x.names.push_back(rung.added.empty() ? law_text(d) : "+ " + rung.added);
    line.add(x, rung.held_out_rmse, rung.held_out_std_error);
    const double removed = k == 0 ? std::nan("") : removed_at(d, k);
    if (std::isfinite(removed)) chart.marks.push_back({x, true, Dash::dotted, share_text(removed) + " gone"});
  }
  chart.marks[0].text += " " + significant(d.floor_rmse, 3);
  chart.half = true;
  return chart;
}

/// Error of the law and of the final model that goes with each variable, and the whole of it, on one scale.
Chart where_chart(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  const std::string unit = level_unit(result).empty() ? "1" : "N";
  Chart chart = half_chart("where", "Where the error goes: what it varies with",
                           {.quantity = "error", .unit = unit, .from_zero = true}, {},
                           where_sentence(d.where) +
                               " Each point is the error that a free function of the variable would take away; on top "
                               "the whole held-out error. These errors overlap where variables go together.");
  chart.marks = {{d.floor_rmse, true, Dash::dashed, "noise floor"}};
  if (d.ladder.empty()) return chart;
  std::vector<std::string>& names = chart.panels[0].names;
  const auto add = [&](const std::string& model, const Rung& rung, const std::vector<Share>& shares, Stroke stroke) {
    ChartLine& line = chart.line(model, stroke);
    names.clear();
    for (auto variable = d.where.rbegin(); variable != d.where.rend(); ++variable) {  // the largest on top
      const auto share = std::ranges::find(shares, variable->variable, &Share::variable);
      line.add(share == shares.end() ? 0 : error_of_share(share->share, rung.held_out_rmse, d.floor_rmse),
               static_cast<double>(names.size()));
      names.emplace_back(to_string(variable->variable));
    }
    line.add(rung.held_out_rmse, static_cast<double>(names.size()));
    names.emplace_back("whole error");
  };
  add(law_text(d), d.ladder.front(), d.where, dots(Colour::blue, Symbol::circle, 9));
  if (d.ladder.size() > 1) add("final model", d.ladder.back(), d.remaining, dots(Colour::red, Symbol::square, 8));
  return chart;
}

/// By their held-out error.
std::vector<const EffectFinding*> sorted_findings(const Diagnosis& d) {
  std::vector<const EffectFinding*> order;
  for (const EffectFinding& finding : d.effects) order.push_back(&finding);
  std::ranges::stable_sort(order, {}, [](const EffectFinding* finding) {
    return std::isfinite(finding->held_out_rmse) ? finding->held_out_rmse : 1e300;
  });
  return order;
}

Chart candidates_chart(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  Chart chart = errors_chart(result, "candidates", "Each candidate: held-out error with it",
                             "Sorted by the error. Each was judged last at a rung of its own, so errors of different "
                             "statuses need not compare: what is superseded helps alone but not beside what was added, "
                             "even where its error here is lower. Bars are one standard error, from cycle to cycle.");
  for (std::size_t k = 0; k < kStatusStrokes.size(); ++k) {
    chart.line(std::string(status_text(static_cast<EffectStatus>(k))), kStatusStrokes[k]);
  }
  for (const EffectFinding* finding : sorted_findings(d)) {
    const auto status = static_cast<std::size_t>(finding->status);
    if (status >= kStatusStrokes.size() || !std::isfinite(finding->held_out_rmse)) continue;
    ChartLine& line = chart.lines[status];
    line.add(static_cast<double>(chart.x.names.size()), finding->held_out_rmse, finding->held_out_std_error);
    chart.x.names.push_back(finding->key);
  }
  if (!d.ladder.empty()) chart.marks.push_back({d.ladder.front().held_out_rmse, false, Dash::dotted, law_text(d)});
  return chart;
}

/// Rungs and noise floor: name, room for a bar, held-out error, and the share of it that is gone.
ReportTable ladder_table(const DiagnosedTraces& result) {
  const Diagnosis& d = result.diagnosis;
  const std::string unit = level_unit(result);
  ReportTable table("Held-out error (RMSE)");
  table.text({"", "", ""}).text({""}, 1).numbers({""});
  const auto add = [&](std::string name, double value, const std::string& shown, std::string error, double removed) {
    table.rows.push_back({std::move(name), "", shown + unit, std::move(error),
                          std::isfinite(removed) ? fmt::format("{:.0f} %", std::floor(100 * removed)) : ""});
    table.bars.values.push_back(value);
    table.bars.full = std::fmax(table.bars.full, value);
  };
  for (std::size_t k = 0; k < d.ladder.size(); ++k) {
    const double value = d.ladder[k].held_out_rmse, error = d.ladder[k].held_out_std_error;
    const int places = places_for(error);
    add(fmt::format("{}  {}", k, k == 0 ? law_text(d) : "+ " + spelled(result, d.ladder[k].added)), value,
        error > 0 ? fixed(value, places) : significant(value, 3), error > 0 ? "+/- " + fixed(error, places) + unit : "",
        k == 0 ? std::nan("") : removed_at(d, k));
  }
  add("   noise floor", d.floor_rmse, significant(d.floor_rmse, 3), "", std::nan(""));
  table.bars.column = 1, table.bars.pale = d.floor_rmse;
  table.bars.pale_name = "noise floor: noise and scatter from cycle to cycle";
  table.bars.full_name = "error above it";
  if (d.ladder.size() > 1) table.bars.full_name += "; %: share of its square that is removed";
  return table;
}

void add_shares(const std::string& title, const std::vector<Share>& all, ReportSection& section) {
  section.heading(title, Medium::terminal);
  section.plain(where_sentence(all), Medium::terminal);
  ReportTable table;
  table.text({"", ""}).numbers({""});
  table.bars.column = 1, table.bars.full = 1, table.bars.longest = 18;
  for (const Share& s : worth_naming(all)) {
    table.rows.push_back(
        {fmt::format("{:<10}", to_string(s.variable)), "", fmt::format("{:.0f} %", 100 * std::min(s.share, 1.0))});
    table.bars.values.push_back(s.share);
  }
  section.add(std::move(table), Medium::terminal);
}

/// The ladder, and where the first law and the last model fail.
void add_errors(const DiagnosedTraces& result, ReportSection& section) {
  const Diagnosis& d = result.diagnosis;
  section.add(ladder_chart(result));
  section.add(where_chart(result));
  if (d.ladder.empty() || !std::isfinite(d.ladder.front().held_out_rmse)) return;
  section.add(ladder_table(result), Medium::terminal);
  if (d.verdict == Verdict::not_enough_data) return;
  if (against_floor(d.ladder.front().held_out_rmse, d.floor_rmse) == FloorComparison::above) {
    add_shares("Where the " + law_text(d) + " fails", d.where, section);
  }
  if (d.ladder.size() > 1 && d.verdict == Verdict::unexplained) add_shares("What remains", d.remaining, section);
}

/// The final model, then what was found beside it, and the equations.
ReportSection law_section(const DiagnosedTraces& result, const Motion& motion) {
  ReportSection section{"whole-law", "", {}, Medium::terminal};
  static const std::vector<FitParameter> none;
  const Fit* fit = result.best < result.fits.size() ? &result.fits[result.best] : nullptr;
  const std::vector<FitParameter>& fitted = fit != nullptr ? fit->parameters : none;
  if (!fitted.empty()) {
    section.heading("The whole law: " + curve_name(*fit));
    section.add(parameter_table(*fit, motion, false));
    section.plain(std::string(describe(fit->model.law()).equation));
  }
  std::vector<FitParameter> beside;  // of what was found before any fit, which is no part of the law
  std::vector<std::string> equations;
  for (const Rung& rung : found_effects(result.diagnosis)) {
    const EffectFinding* finding = finding_of(result.diagnosis, rung.added);
    if (finding == nullptr || finding->parameters.empty()) continue;
    const std::string equation = info_of(result, rung.added).equation;
    if (!equation.empty()) equations.push_back(spelled(result, rung.added) + ": " + equation);
    const auto is_own = [&](const std::string& effect) { return effect.starts_with(finding->key); };
    const bool in_fit = std::ranges::any_of(fitted, is_own, &FitParameter::effect);
    for (FitParameter p : in_fit ? none : finding->parameters) {
      p.effect = finding->key;
      beside.push_back(std::move(p));
    }
  }
  if (!beside.empty()) section.heading("Found beside it");
  section.add(value_table("parameter", results_of(beside, motion)));
  for (const std::string& equation : equations) section.plain(equation);
  return section;
}

void add_experiment(const Diagnosis& d, ReportSection& section) {
  const std::string same = equivalence_sentence(d);
  const bool none = same.empty() && d.next_experiment.empty();
  section.heading(same.empty() ? "Next experiment" : "Not distinguishable", none ? Medium::page : Medium::any);
  section.plain(same);
  if (none) section.plain("None is needed.", Medium::page);
  if (!d.next_experiment.empty())
    section.plain((same.empty() ? "" : "Discriminating experiment: ") + d.next_experiment);
}

/// Effects of a status by their reason; a page has a table of all of them.
void add_by_reason(const Diagnosis& d, EffectStatus status, const std::string& heading, ReportSection& section) {
  std::vector<std::pair<std::string, std::string>> reasons;  // reason, keys
  for (const EffectFinding& e : d.effects) {
    if (e.status != status) continue;
    const auto at = std::find_if(reasons.begin(), reasons.end(), [&](const auto& r) { return r.first == e.reason; });
    if (at == reasons.end()) {
      reasons.emplace_back(e.reason, e.key);
    } else {
      at->second += ", " + e.key;
    }
  }
  if (!reasons.empty()) section.heading(heading, Medium::terminal);
  for (const auto& [reason, keys] : reasons) {
    section.plain(keys + (reason.empty() ? "" : ": " + reason), Medium::terminal);
  }
}

ReportTable effects_table(const Diagnosis& d, const Motion& motion) {
  ReportTable table("What became of each effect");
  table.text({"effect", "status"}).numbers({"held-out error", "error taken away", "p"}).text({"parameters", "why"});
  table.folded = true;
  std::vector<const EffectFinding*> findings = sorted_findings(d);
  std::ranges::stable_sort(findings, {}, &EffectFinding::status);
  for (const EffectFinding* f : findings) {
    std::string parameters;
    if (f->status == EffectStatus::found || f->status == EffectStatus::equivalent) {
      for (const FitParameter& p : f->parameters) {
        parameters += (parameters.empty() ? "" : "; ") + p.parameter.name + " = " + value_text(p, motion);
      }
    }
    table.rows.push_back({f->key, std::string(status_text(f->status)), significant(f->held_out_rmse, 3),
                          percent(f->error_reduction), f->p_value < 1e-4 ? "< 0.0001" : significant(f->p_value, 2),
                          parameters, f->reason});
  }
  return table;
}

ReportSection diagnosis_section(const DiagnosedTraces& result, const Motion& motion) {
  const Diagnosis& d = result.diagnosis;
  ReportSection section{"diagnosis", "Effects found", {}};
  add_errors(result, section);
  section.heading("Verdict: " + std::string(to_string(d.verdict)), Medium::terminal);
  section.plain(diagnosis_verdict(result), Medium::terminal);
  const bool said = d.verdict == Verdict::not_enough_data || d.runs_differ;  // the first message is the verdict
  for (std::size_t k = said ? 1 : 0; k < d.messages.size(); ++k) section.plain("note: " + d.messages[k]);
  add_experiment(d, section);
  add_by_reason(d, EffectStatus::untried, "Not tried", section);
  add_by_reason(d, EffectStatus::untestable, "What these data cannot show", section);
  if (!d.confirmations.empty()) section.heading("On runs not used in the fit");
  for (const Confirmation& c : d.confirmations) section.item(confirmation_sentence(c, result));
  if (!d.formula.empty()) section.heading("A closed form of what remains");
  section.plain(d.formula, Medium::terminal);
  section.command(d.formula, Medium::page);
  section.add(candidates_chart(result));
  section.add(effects_table(d, motion));
  return section;
}

/// The charts of the first traces in their sections.
void draw(const DiagnosedTraces& result, TraceSections& sections) {
  constexpr std::size_t kDrawnTraces = 8;
  const std::size_t count = result.traces.size(), drawn = std::min(count, kDrawnTraces);
  const auto bare = [&](const Fit& fit) { return fit.model.law() == result.diagnosis.law; };
  const DrawnLaws laws = drawn_laws(result.fits, result.best, 2, bare, result.rungs);
  for (std::size_t k = 0; k < drawn; ++k) {
    const Identification& trace = result.traces[k];
    for (ReportSection* s : sections.all()) {
      if (drawn > 1) s->heading(trace.path);
    }
    sections.add_trace(DrawnTrace(trace, laws, fmt::format("t{}", k + 1), 1 / static_cast<double>(drawn), k));
  }
  if (count > drawn) sections.trace.plain(fmt::format("The first {} of {} traces are drawn.", drawn, count));
}

}  // namespace

Report report_of(const DiagnosedTraces& result, const ReportOptions& options) {
  static const Motion none;
  const Motion& motion = result.traces.empty() ? none : result.traces.front().motion;
  const Identification* one = result.traces.size() == 1 ? &result.traces.front() : nullptr;
  const std::string several = fmt::format("{} traces together", result.traces.size());
  Report report =
      titled_report("diagnosis", one != nullptr ? file_name(one->path) : several, diagnosis_verdict(result));
  for (const Identification& trace : result.traces) {
    report.warnings.insert(report.warnings.end(), trace.warnings.begin(), trace.warnings.end());
  }
  report.facts = model_facts("final model", result.fits, result.best, motion);
  report.next = {next_after_diagnosis(result, options)};
  if (one != nullptr) add_facts(*one, report);
  if (one != nullptr && result.diagnosis.verdict != Verdict::not_enough_data) {
    add_ways_to_look("diagnose", one->path, options, report);
  }
  TraceSections sections;
  if (options.charts) draw(result, sections);
  if (!result.traces.empty()) sections.trace.add(health_table(result.traces));
  add_fits(result.fits, result.best, motion, options.instruments_declared, sections.law);
  if (!result.fits.empty()) sections.law.add(profile_charts(result.fits[result.best], motion, "best"));
  for (ReportSection* s : sections.all()) s->medium = Medium::page;
  report.add({traces_section(result), diagnosis_section(result, motion), law_section(result, motion), sections.trace,
              sections.law, sections.errors, sections.cycles,
              run_section(report, diagnose_command(result, options), result.traces)});
  return report;
}

}  // namespace tribofit
