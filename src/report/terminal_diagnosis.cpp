#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "bars.hpp"
#include "diagnosis_sentences.hpp"
#include "measures.hpp"
#include "numbers.hpp"
#include "style.hpp"
#include "tribofit/report/diagnosis.hpp"

namespace tribofit {
namespace {

/// The page, line by line; every part adds what it has to say.
class Page {
 public:
  Page(const DiagnosedTraces& result, const TerminalOptions& options)
      : result_(result), d_(result.diagnosis), options_(options), style_(options.colour, options.width) {}

  std::string text() {
    header();
    ladder();
    shares("Where the " + law_text(d_) + " fails", d_.where, !at_floor(0));
    if (d_.ladder.size() > 1) shares("What remains", d_.remaining, d_.verdict == Verdict::unexplained);
    verdict();
    effects();
    not_told_apart();
    untestable();
    confirmations();
    formula();
    next();
    return std::move(text_);
  }

 private:
  void line(std::string_view sentence, std::size_t indent = 2) {
    text_ += std::string(indent, ' ') + wrapped(with_signs(sentence), style_.width, indent) + "\n";
  }
  void heading(std::string_view title) { text_ += style_.heading(title); }

  /// "+/-" as the sign where it can be shown.
  std::string with_signs(std::string_view text) const {
    std::string out(text);
    if (!options_.unicode) return out;
    for (std::size_t at = out.find("+/-"); at != std::string::npos; at = out.find("+/-", at)) {
      out.replace(at, 3, "\u00b1");
    }
    return out;
  }

  const Motion& motion() const { return result_.traces.front().motion; }
  bool is_force() const { return !result_.traces.empty() && motion().friction_kind == FrictionKind::force; }
  double rmse(std::size_t rung) const { return d_.ladder[rung].held_out_rmse; }
  bool at_floor(std::size_t rung) const { return rung >= d_.ladder.size() || !(rmse(rung) > kNoise * d_.floor_rmse); }

  /// Cycles; samples where nothing sticks.
  std::string amount_of_data() const {
    std::size_t cycles = 0, samples = 0;
    bool sticks = false;
    for (const Identification& trace : result_.traces) {
      cycles += count_of_cycles(trace.segmentation);
      samples += trace.motion.size();
      sticks |= trace.segmentation.kind == MotionKind::stick_slip;
    }
    if (!sticks) return grouped(samples) + " samples, no stick";
    return grouped(cycles) + (cycles == 1 ? " cycle" : " cycles");
  }

  /// The distinct values of one condition over the traces, "1, 2, 4, 8 rpm"; empty where none is known.
  std::string condition(Condition Conditions::*which, double unit, std::string_view name) const {
    std::vector<std::string> values;
    for (const Identification& trace : result_.traces) {
      const Condition& c = trace.motion.conditions.*which;
      const std::string value = c.known() ? brief(c.value / unit) : "";
      if (!value.empty() && std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
    }
    if (values.empty()) return "";
    std::string text;
    for (const std::string& value : values) text += (text.empty() ? "" : ", ") + value;
    return text + " " + std::string(name);
  }

  void header() {
    std::string title = fmt::format("{} traces", result_.traces.size());
    if (result_.traces.size() == 1) title = result_.traces.front().path;
    std::string facts;
    for (const std::string& fact :
         {condition(&Conditions::radius, kMillimetre, "mm"), condition(&Conditions::speed, kRpm, "rpm"),
          condition(&Conditions::load, 1, "N"), amount_of_data()}) {
      if (!fact.empty()) facts += (facts.empty() ? "" : "; ") + fact;
    }
    text_ += fmt::format("{}{}{}", style_.bold, wrapped(shortened(title), style_.width, 2), style_.off);
    const std::string rest = wrapped(facts, style_.width, 2);
    const bool same_line = rest.find('\n') == std::string::npos && title.size() + facts.size() + 2 <= style_.width;
    text_ += (same_line ? ": " : "\n  ") + rest + "\n";
    std::vector<std::string> said;
    for (const Identification& trace : result_.traces) {
      for (const std::string& note : trace.notes) remark("", note, trace, said);
      for (const std::string& warning : trace.warnings) remark("warning: ", warning, trace, said);
      // What is wrong with the data comes before what is wrong with the law.
      for (const HealthItem& check : trace.motion.health) {
        if (check.status == HealthItem::Status::problem) remark("problem: ", check.message, trace, said);
      }
    }
  }

  /// A remark once, with the trace's name where there are several.
  void remark(std::string_view kind, const std::string& text, const Identification& trace,
              std::vector<std::string>& said) {
    if (std::find(said.begin(), said.end(), text) != said.end()) return;
    said.push_back(text);
    const bool name = result_.traces.size() > 1 && text.find(trace.path) == std::string::npos;
    line(std::string(kind) + (name ? trace.path + ": " : "") + text);
  }

  /// A path too long for the page loses its middle.
  std::string shortened(const std::string& path) const {
    if (path.size() <= style_.width) return path;
    const std::size_t half = (style_.width - 3) / 2;
    return path.substr(0, half) + "..." + path.substr(path.size() - half);
  }

  struct Row {
    std::string name;
    double value, std_error, removed;
  };

  /// Share of the squares of the base law above the floor that is gone at a rung.
  double removed(std::size_t rung) const {
    const double floor = d_.floor_rmse * d_.floor_rmse;
    const double whole = rmse(0) * rmse(0) - floor;
    return whole > 0 ? std::clamp(1 - (rmse(rung) * rmse(rung) - floor) / whole, -9.99, 1.0) : std::nan("");
  }

  /// As the command line takes it.
  std::string shown_key(const std::string& key) const {
    const EffectInfo info = info_of(result_, key);
    return info.key.empty() ? key : info.spelled();
  }

  void ladder() {
    if (d_.ladder.empty() || !std::isfinite(rmse(0))) return;
    const auto [pale, full] = bar_signs(options_.unicode);
    heading("Error on data not seen (RMSE)");
    std::vector<Row> rows;
    for (std::size_t k = 0; k < d_.ladder.size(); ++k) {
      const Rung& rung = d_.ladder[k];
      const std::string name = k == 0 ? law_text(d_) : "+ " + shown_key(rung.added);
      rows.push_back({fmt::format("{}  {}", k, name), rung.held_out_rmse, rung.held_out_std_error,
                      k == 0 ? std::nan("") : removed(k)});
    }
    rows.push_back({"   floor", d_.floor_rmse, 0, std::nan("")});
    draw(rows);
    std::string legend =
        fmt::format("{} the floor: noise and scatter from cycle to cycle; {} error above it", pale, full);
    if (rows.size() > 2) legend += "; %: how much of that is gone (of its square)";
    line(legend);
  }

  void draw(const std::vector<Row>& rows) {
    std::size_t names = 0, figures = 0, plain = 0, shares = 0;
    double largest = 0;
    std::vector<std::string> figure, bare, share;
    for (const Row& row : rows) {
      const std::string unit = is_force() ? " N" : "";
      figure.push_back((row.std_error > 0 ? with_error(row.value, row.std_error) : significant(row.value, 3)) + unit);
      bare.push_back(significant(row.value, 3) + unit);
      share.push_back(std::isfinite(row.removed) ? fmt::format("{:.0f} %", std::floor(100 * row.removed)) : "");
      names = std::max(names, row.name.size());
      plain = std::max(plain, bare.back().size());
      figures = std::max(figures, with_signs(figure.back()).size() - (options_.unicode && row.std_error > 0 ? 1 : 0));
      shares = std::max(shares, share.back().size());
      if (std::isfinite(row.value)) largest = std::max(largest, row.value);
    }
    const std::size_t around = 2 + names + 2 + 2 + (shares > 0 ? shares + 2 : 0);
    constexpr std::size_t kShortest = 10, kLongest = 40;
    const bool with_errors = around + figures + kShortest <= style_.width;
    const std::size_t used = around + (with_errors ? figures : plain);
    const std::size_t columns = used < style_.width ? std::min(style_.width - used, kLongest) : 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const std::string drawn = bar(rows[k].value, largest, columns, options_.unicode, d_.floor_rmse);
      std::string text =
          fmt::format("  {:<{}}  {}{:{}}  {:<{}}", rows[k].name, names, drawn, "", columns - displayed(drawn),
                      with_signs(with_errors ? figure[k] : bare[k]), with_errors ? figures : plain);
      if (shares > 0) text += fmt::format("  {:>{}}", share[k], shares);
      text.erase(text.find_last_not_of(' ') + 1);
      text_ += text + "\n";
    }
  }
  void shares(const std::string& title, const std::vector<Share>& all, bool wanted) {
    if (!wanted || d_.verdict == Verdict::not_enough_data) return;
    heading(title);
    line(where_sentence(all));
    constexpr std::size_t kColumns = 18;
    for (const Share& s : worth_naming(all)) {
      const std::string drawn = bar(s.share, 1, kColumns, options_.unicode);
      text_ += fmt::format("  {:<10}  {}{:{}}  {:>3.0f} %\n", s.variable, drawn, "", kColumns - displayed(drawn),
                           100 * std::min(s.share, 1.0));
    }
  }

  void verdict() {
    heading("Verdict: " + std::string(to_string(d_.verdict)));
    line(diagnosis_verdict(result_));
    const bool said = d_.verdict == Verdict::not_enough_data;  // its first message is the verdict
    for (std::size_t k = said ? 1 : 0; k < d_.messages.size(); ++k) line("note: " + d_.messages[k]);
  }

  void effects() {
    std::vector<const EffectFinding*> added;
    for (const Rung& rung : missing_effects(d_)) {
      const EffectFinding* finding = finding_of(d_, rung.added);
      if (finding != nullptr && !finding->parameters.empty()) added.push_back(finding);
    }
    if (added.empty()) return;
    heading(added.size() == 1 ? "The added effect" : "The added effects");
    Table table({"parameter", "value", "95 % interval", "unit"}, {true, false, false, true});
    std::string lines;
    for (const EffectFinding* e : added) {
      for (const FitParameter& p : e->parameters) add_parameter(e->key, p, table, lines);
    }
    text_ += 2 + table.width() <= style_.width ? table.text(2, style_.dim, style_.off) : lines;
    for (const EffectFinding* e : added) {
      const std::string equation = info_of(result_, e->key).equation;
      if (!equation.empty()) line(shown_key(e->key) + ": " + equation);
    }
  }

  void add_parameter(const std::string& key, const FitParameter& p, Table& table, std::string& lines) const {
    const double error = shown(p, p.std_error);
    const int places = std::isfinite(error) && error > 0 ? places_for(error) : 6;
    const std::string name = key + "." + p.parameter.name;
    const std::string value = fixed(shown(p, p.value), places);
    const std::string interval =
        std::isfinite(p.lower95) && std::isfinite(p.upper95)
            ? fmt::format("[{}, {}]", fixed(shown(p, p.lower95), places), fixed(shown(p, p.upper95), places))
            : "-";
    const std::string unit = shown_unit(p, motion()) + (p.at_bound ? " (at bound)" : "");
    table.add({name, value, interval, unit});
    lines += "  " + name + "\n    " + wrapped(value + " " + interval + " " + unit, style_.width, 4) + "\n";
  }

  void not_told_apart() {
    std::string text;
    for (const Rung& rung : missing_effects(d_)) {
      if (rung.equivalent.empty()) continue;
      std::vector<std::string> group = {rung.added};
      group.insert(group.end(), rung.equivalent.begin(), rung.equivalent.end());
      text += (text.empty() ? "" : " ") + enumerated(group) + " fit these data equally well.";
    }
    if (text.empty() && d_.next_experiment.empty()) return;
    heading(text.empty() ? "Next experiment" : "Not told apart");
    if (!text.empty()) line(text);
    if (!d_.next_experiment.empty()) line((text.empty() ? "" : "The test that would: ") + d_.next_experiment);
  }

  void untestable() {
    std::vector<std::pair<std::string, std::string>> reasons;  // reason, keys
    for (const EffectFinding& e : d_.effects) {
      if (e.status != EffectStatus::untestable) continue;
      const auto at = std::find_if(reasons.begin(), reasons.end(), [&](const auto& r) { return r.first == e.reason; });
      if (at == reasons.end()) {
        reasons.emplace_back(e.reason, e.key);
      } else {
        at->second += ", " + e.key;
      }
    }
    if (reasons.empty()) return;
    heading("What these data cannot show");
    for (const auto& [reason, keys] : reasons) line(keys + (reason.empty() ? "" : ": " + reason), 2);
  }

  void confirmations() {
    if (d_.confirmations.empty()) return;
    heading("On runs that took no part");
    for (const Confirmation& c : d_.confirmations) {
      const std::string unit = is_force() ? " N" : "";
      if (!std::isfinite(c.final_rmse)) {
        line(c.path + ": could not be tried: this run cannot carry the analysis (identify says why)");
        continue;
      }
      if (d_.ladder.size() < 2) {
        line(fmt::format("{}: the law leaves {}{}", c.path, significant(c.final_rmse, 3), unit));
        continue;
      }
      const bool confirmed = c.p_value < kSignificant && c.final_rmse < c.base_rmse;
      line(fmt::format("{}: with every parameter frozen the error goes from {} to {}{} (p {}): {}", c.path,
                       significant(c.base_rmse, 3), significant(c.final_rmse, 3), unit,
                       c.p_value < 1e-4 ? "< 0.0001" : "= " + significant(c.p_value, 2),
                       confirmed ? "confirmed" : "not confirmed"));
    }
  }

  void formula() {
    if (d_.formula.empty()) return;
    heading("A closed form of what remains");
    line(d_.formula);
  }

  void next() {
    const Suggestion next = next_after_diagnosis(result_, options_);
    text_ += "\n" + wrapped("Next, " + next.reason + ":", style_.width, 0) + "\n" +
             folded_command(next.command, style_.width) + "\n";
  }

  const DiagnosedTraces& result_;
  const Diagnosis& d_;
  const TerminalOptions& options_;
  Style style_;
  std::string text_;
};

}  // namespace

std::string render_diagnosis(const DiagnosedTraces& result, const TerminalOptions& options) {
  return Page(result, options).text();
}

}  // namespace tribofit
