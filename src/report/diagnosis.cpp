#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/conclusions.hpp"
#include "diagnosis_sentences.hpp"
#include "numbers.hpp"
#include "report_parts.hpp"
#include "segmentation/counts.hpp"
#include "terminal_text.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/report/terminal.hpp"

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

/// The distinct values of one condition over the traces, "1, 2, 4, 8 rpm"; empty where none is known.
std::string condition(const DiagnosedTraces& result, const ConditionInfo& which) {
  const std::vector<std::string> values = distinct(result, [&](const Identification& trace) {
    const Condition& c = trace.motion.conditions.*which.member;
    return c.known() ? brief(c.value / which.si) : "";
  });
  return values.empty() ? "" : fmt::format("{} {}", fmt::join(values, ", "), which.unit);
}

/// A path too long for the terminal loses its middle.
std::string shortened(const std::string& path, std::size_t width) {
  if (path.size() <= width) return path;
  const std::size_t half = (width - 3) / 2;
  return path.substr(0, half) + "..." + path.substr(path.size() - half);
}

/// Notes, warnings and problems of the data, each once, with the trace's name where there are several.
void add_remarks(const DiagnosedTraces& result, TerminalText& text) {
  std::vector<std::string> said;
  for (const Identification& trace : result.traces) {
    const auto remark = [&](const std::string& kind, const std::string& message) {
      if (std::find(said.begin(), said.end(), message) != said.end()) return;
      said.push_back(message);
      const bool named = result.traces.size() > 1 && message.find(trace.path) == std::string::npos;
      text.line(kind + (named ? trace.path + ": " : "") + message);
    };
    for (const std::string& note : trace.notes) remark("", note);
    for (const std::string& warning : trace.warnings) remark("warning: ", warning);
    // What is wrong with the data comes before what is wrong with the law.
    for (const HealthItem& check : trace.motion.health) {
      if (check.status == HealthItem::Status::problem) remark("problem: ", check.message);
    }
  }
}

void add_header(const DiagnosedTraces& result, TerminalText& text) {
  const bool one = result.traces.size() == 1;
  const std::string title =
      one ? printable(result.traces.front().path) : fmt::format("{} traces", result.traces.size());
  std::vector<std::string> known = {enumerated(distinct(result, kind_text))};
  for (const ConditionInfo& which : condition_infos) known.push_back(condition(result, which));
  known.push_back(amount_of_data(result));
  std::erase(known, "");
  const std::string facts = fmt::format("{}", fmt::join(known, "; "));
  const std::string rest = wrapped(facts, text.width(), 2);
  const bool same_line = rest.find('\n') == std::string::npos && title.size() + facts.size() + 2 <= text.width();
  text.raw(text.bold(wrapped(shortened(title, text.width()), text.width(), 2)));
  text.raw((same_line ? ": " : "\n  ") + rest + "\n");
  add_remarks(result, text);
}

/// Rungs and noise floor: name, room for a bar, held-out error, and how much of what is above the noise floor is gone.
ReportTable ladder_table(const DiagnosedTraces& result, bool with_errors) {
  const Diagnosis& d = result.diagnosis;
  const std::string unit = level_unit(result);
  ReportTable table;
  table.text({"", "", ""}).numbers({""});
  for (std::size_t k = 0; k < d.ladder.size(); ++k) {
    const Rung& rung = d.ladder[k];
    const double removed = k == 0 ? std::nan("") : removed_at(d, k);
    const bool error = with_errors && rung.held_out_std_error > 0;
    table.rows.push_back(
        {fmt::format("{}  {}", k, k == 0 ? law_text(d) : "+ " + spelled(result, rung.added)), "",
         (error ? with_error(rung.held_out_rmse, rung.held_out_std_error) : significant(rung.held_out_rmse, 3)) + unit,
         std::isfinite(removed) ? fmt::format("{:.0f} %", std::floor(100 * removed)) : ""});
  }
  table.rows.push_back({"   noise floor", "", significant(d.floor_rmse, 3) + unit, ""});
  return table;
}

void add_ladder(const DiagnosedTraces& result, TerminalText& text) {
  constexpr std::size_t kShortest = 10, kLongest = 40;
  const Diagnosis& d = result.diagnosis;
  if (d.ladder.empty() || !std::isfinite(d.ladder.front().held_out_rmse)) return;
  text.heading("Held-out error (RMSE)");
  ReportTable table;
  std::size_t room = 0;
  for (const bool with_errors : {true, false}) {
    table = ladder_table(result, with_errors);
    for (std::vector<std::string>& row : table.rows) row[2] = text.with_signs(row[2]);
    const std::size_t used = widest(aligned(table, 2));
    room = used < text.width() ? std::min(text.width() - used, kLongest) : 0;
    if (room >= kShortest) break;
  }
  double largest = d.floor_rmse;
  for (const Rung& rung : d.ladder) largest = std::fmax(largest, rung.held_out_rmse);
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const double value = k < d.ladder.size() ? d.ladder[k].held_out_rmse : d.floor_rmse;
    table.rows[k][1] = bar(value, largest, room, text.unicode(), d.floor_rmse);
  }
  const std::vector<std::string> lines = aligned(table, 2);
  for (std::size_t k = 1; k < lines.size(); ++k) text.raw(lines[k] + "\n");
  const auto [pale, full] = bar_signs(text.unicode());
  std::string legend =
      fmt::format("{} noise floor: noise and scatter from cycle to cycle; {} error above it", pale, full);
  if (d.ladder.size() > 1) legend += "; %: share of its square that is removed";
  text.line(legend);
}

void add_shares(const std::string& title, const std::vector<Share>& all, TerminalText& text) {
  constexpr std::size_t kColumns = 18;
  text.heading(title);
  text.line(where_sentence(all));
  for (const Share& s : worth_naming(all)) {
    const std::string drawn = bar(s.share, 1, kColumns, text.unicode());
    text.raw(fmt::format("  {:<10}  {}{:{}}  {:>3.0f} %\n", to_string(s.variable), drawn, "",
                         kColumns - displayed(drawn), 100 * std::min(s.share, 1.0)));
  }
}

void add_where(const DiagnosedTraces& result, TerminalText& text) {
  const Diagnosis& d = result.diagnosis;
  if (d.ladder.empty() || d.verdict == Verdict::not_enough_data) return;
  if (against_floor(d.ladder.front().held_out_rmse, d.floor_rmse) == FloorComparison::above) {
    add_shares("Where the " + law_text(d) + " fails", d.where, text);
  }
  if (d.ladder.size() > 1 && d.verdict == Verdict::unexplained) add_shares("What remains", d.remaining, text);
}

void add_verdict(const DiagnosedTraces& result, TerminalText& text) {
  const Diagnosis& d = result.diagnosis;
  text.heading("Verdict: " + std::string(to_string(d.verdict)));
  text.line(diagnosis_verdict(result));
  const bool said = d.verdict == Verdict::not_enough_data || d.runs_differ;  // the first message is the verdict
  for (std::size_t k = said ? 1 : 0; k < d.messages.size(); ++k) text.line("note: " + d.messages[k]);
}

/// Parameters of what was found before any fit, which are no part of the law.
ReportTable found_table(const DiagnosedTraces& result) {
  ReportTable table;
  table.text({"parameter"}).numbers({"value", "95 % interval"}).text({"unit"});
  const std::vector<FitParameter> none;
  const std::vector<FitParameter>& of_law =
      result.best < result.fits.size() ? result.fits[result.best].parameters : none;
  for (const Rung& rung : found_effects(result.diagnosis)) {
    const EffectFinding* finding = finding_of(result.diagnosis, rung.added);
    if (finding == nullptr) continue;
    const bool stands_in_law = std::any_of(of_law.begin(), of_law.end(),
                                           [&](const FitParameter& p) { return p.effect.starts_with(finding->key); });
    if (stands_in_law) continue;
    for (const FitParameter& p : finding->parameters) {
      const int places = places_of(p);
      table.rows.push_back({finding->key + "." + p.parameter.name, fixed(shown(p, p.value), places),
                            interval_text(shown(p, p.lower95), shown(p, p.upper95), places),
                            shown_unit(p, result.traces.front().motion) + (p.at_bound ? " (at bound)" : "")});
    }
  }
  return table;
}

/// A table of four columns, or its rows on two lines each where it is too wide.
void add_parameters(const ReportTable& table, TerminalText& text) {
  if (widest(aligned(table, 2)) <= text.width()) {
    text.table(table);
    return;
  }
  for (const std::vector<std::string>& row : table.rows) {
    text.line(row[0]);
    text.line(row[1] + " " + row[2] + " " + row[3], 4);
  }
}

/// The final model whole: the law with its parameters, then what was found beside it, and the equations.
void add_law(const DiagnosedTraces& result, TerminalText& text) {
  const ReportTable table = found_table(result);
  if (result.best < result.fits.size() && !result.fits[result.best].parameters.empty()) {
    const Fit& fit = result.fits[result.best];
    text.heading("The whole law: " + curve_name(fit));
    add_parameters(law_table(fit, result.traces.front().motion), text);
    text.line(std::string(describe(fit.model.law()).equation));
  }
  if (!table.rows.empty()) {
    text.heading("Found beside it");
    add_parameters(table, text);
  }
  for (const Rung& rung : found_effects(result.diagnosis)) {
    const EffectFinding* finding = finding_of(result.diagnosis, rung.added);
    const std::string equation = info_of(result, rung.added).equation;
    if (finding == nullptr || finding->parameters.empty() || equation.empty()) continue;
    text.line(spelled(result, rung.added) + ": " + equation);
  }
}

void add_experiment(const Diagnosis& d, TerminalText& text) {
  const std::string same = equivalence_sentence(d);
  if (same.empty() && d.next_experiment.empty()) return;
  text.heading(same.empty() ? "Next experiment" : "Not distinguishable");
  if (!same.empty()) text.line(same);
  if (!d.next_experiment.empty()) text.line((same.empty() ? "" : "Discriminating experiment: ") + d.next_experiment);
}

/// Effects of a status by their reason.
void add_by_reason(const Diagnosis& d, EffectStatus status, const std::string& heading, TerminalText& text) {
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
  if (!reasons.empty()) text.heading(heading);
  for (const auto& [reason, keys] : reasons) text.line(keys + (reason.empty() ? "" : ": " + reason));
}

}  // namespace

std::string render_diagnosis(const DiagnosedTraces& result, const TerminalOptions& options) {
  const Diagnosis& d = result.diagnosis;
  TerminalText text(options);
  add_header(result, text);
  add_ladder(result, text);
  add_where(result, text);
  add_verdict(result, text);
  add_experiment(d, text);
  add_by_reason(d, EffectStatus::untried, "Not tried", text);
  add_by_reason(d, EffectStatus::untestable, "What these data cannot show", text);
  if (!d.confirmations.empty()) text.heading("On runs not used in the fit");
  for (const Confirmation& c : d.confirmations) text.line(confirmation_sentence(c, result));
  if (!d.formula.empty()) text.heading("A closed form of what remains");
  if (!d.formula.empty()) text.line(d.formula);
  add_law(result, text);
  text.next(next_after_diagnosis(result, options));
  if (result.traces.size() == 1 && d.verdict != Verdict::not_enough_data) {
    text.look(ways_to_look("diagnose", options.arguments, result.traces.front().path, options.report_written));
  }
  return text.take();
}

}  // namespace tribofit
