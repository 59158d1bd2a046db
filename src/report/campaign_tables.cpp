#include "campaign_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numbers.hpp"
#include "tribofit/campaign/compare.hpp"

namespace tribofit {
namespace {

/// The protocol as people call it; JSON and CSV have its own name.
std::string protocol_cell(const std::string& protocol) {
  return protocol == to_string(Protocol::published) ? "extremes" : protocol;
}

std::string preference_text(const LawPreference& p) {
  const std::string chance = std::isfinite(p.p_value) ? ", " + p_value_text(p.p_value) : "";
  return fmt::format("{} in {} of {} run{}; the held-out error of {} is {} times as large{}", p.better, p.better_in,
                     p.runs, p.runs == 1 ? "" : "s", p.other, significant(p.ratio, 4), chance);
}

ReportTable values_table(std::string caption, const char* file) {
  ReportTable table(std::move(caption), file);
  table.text({"conditions", "value"}).text({"law", "protocol"}, 1).numbers({"mean", "95 % interval"});
  table.numbers({"statistical"}, 2).numbers({"between runs"}).numbers({"systematic"}, 2).numbers({"runs"});
  table.text({"unit"});
  return table;
}

std::vector<std::string> value_row(const PooledValue& v, const std::string& name, const std::string& law,
                                   const std::string& protocol, const std::string& conditions) {
  const auto part = [&](double value) { return std::isfinite(value) && value != 0 ? significant(value, 2) : "-"; };
  const bool known = std::isfinite(v.std_error) && v.std_error > 0;
  const std::string interval = known ? interval_text(v.lower95, v.upper95, places_for(v.std_error)) : "-";
  std::vector<std::string> row = {conditions, name, law, protocol_cell(protocol), with_error(v.value, v.std_error)};
  row.insert(row.end(), {interval, part(v.statistical), part(v.between), part(v.systematic), std::to_string(v.runs),
                         v.unit == "1" ? "" : v.unit});
  return row;
}

constexpr const char* kOtherParameters = "other parameters of the law";

/// Three cells: mu_s and mu_k where the law has them, and what else it has, by name and with its unit.
void add_law_cells(const std::vector<ResultParameter>& parameters, std::vector<std::string>& row) {
  std::string mu_s, mu_k;
  std::vector<std::string> others;
  for (const ResultParameter& p : parameters) {
    if (!p.effect.empty()) continue;
    if (p.name == static_level_name) {
      mu_s = with_error(p.value, p.std_error);
    } else if (p.name == kinetic_level_name) {
      mu_k = with_error(p.value, p.std_error);
    } else {
      others.push_back(p.name + " " + with_error(p.value, p.std_error) + unit_behind(p.unit));
    }
  }
  row.insert(row.end(), {mu_s, mu_k, fmt::format("{}", fmt::join(others, ", "))});
}

/// Earlier values beside ours, a row a value with both protocols; conditions stand in the first row of each.
ReportTable comparison_table(const EarlierComparison& comparison, std::span<const PooledGroup> groups) {
  ReportTable table("", "comparison.csv");
  table.text({"conditions", "value", "law"}).numbers({"earlier", "joint fit", "difference", "std errors"});
  table.numbers({"extremes", "difference"});
  const ComparedValue* before = nullptr;
  for (const ComparedValue& v : comparison.values) {
    const bool extremes = v.protocol == to_string(Protocol::published);
    if (!extremes || before == nullptr || before->protocol == to_string(Protocol::published) ||
        !v.is_beside_same(*before)) {
      const std::string conditions = conditions_text(groups[v.group]);
      table.rows.push_back({before != nullptr && conditions_text(groups[before->group]) == conditions ? "" : conditions,
                            with_unit(v.earlier.name, v.ours.unit), v.law,
                            with_error(v.earlier.value, v.earlier.std_error), "", "", "", "", ""});
    }
    std::vector<std::string>& row = table.rows.back();
    if (extremes) {
      row[7] = significant(v.ours.value, 4);
      row[8] = with_sign(v.percent, 2, " %");
    } else {
      row[4] = with_error(v.ours.value, v.ours.std_error);
      row[5] = with_sign(v.percent, 2, " %");
      row[6] = with_sign(v.in_std_errors, std::abs(v.in_std_errors) < 100 ? 1 : 0);
    }
    before = &v;
  }
  return table;
}

/// Relative errors (Eq 5) by conditions, law and protocol.
ReportTable error_table(const Statements& statements, std::span<const PooledGroup> groups) {
  ReportTable table("Relative error |(measured - law)/measured|, slip samples and means in 40 bins of v_r",
                    "summary.json");
  const std::string limit = published_error_limit_text;
  table.text({"conditions", "law", "protocol"}).numbers({"samples below " + limit, "mean", "largest"});
  table.numbers({"bins below " + limit, "largest of bins"});
  std::string before;
  for (const ErrorStatement& e : statements.errors) {
    const std::string conditions = conditions_text(groups[e.group]);
    table.rows.push_back({conditions == before ? "" : conditions, e.law, protocol_cell(e.protocol),
                          share_text(e.below_limit), significant(e.mean_relative, 2), significant(e.max_relative, 2),
                          share_text(e.bins_below_limit), significant(e.largest_of_bins, 2)});
    before = conditions;
  }
  return table;
}

/// Every pooled value with the parts of its error.
ReportTable groups_table(std::span<const PooledGroup> groups) {
  ReportTable table =
      values_table("Repeats together (the mean with one standard error, from run to run)", "pooled.csv");
  for (const PooledGroup& group : groups) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      for (const PooledValue& v : fit.parameters) {
        table.rows.push_back(value_row(v, full_name(v.name, v.effect), fit.law, fit.protocol, conditions_text(group)));
      }
    }
    for (const PooledValue& v : group.measures)
      table.rows.push_back(value_row(v, full_name(v.name, v.effect), "", "", conditions_text(group)));
  }
  return table;
}

/// Parameters that runs share, the same way.
ReportTable shared_table(const SharedFit& fit) {
  ReportTable table = values_table("Parameters that runs have in common, " + fit.law + " law", "shared.csv");
  for (const SharedFit::Parameter& common : fit.common) {
    for (std::size_t l = 0; l < common.values.size(); ++l) {
      table.rows.push_back(value_row(common.values[l], common.name, fit.law, std::string(to_string(Protocol::joint)),
                                     common.condition.empty() ? "all runs" : common.levels[l]));
    }
  }
  return table;
}

ReportTable trends_table(const Trends& trends) {
  ReportTable table("Straight lines over the conditions", "trends.csv");
  table.folded = true;
  table.text({"parameter", "law", "over"}).numbers({"slope", "95 % interval"}).text({"unit"});
  table.numbers({"runs", "p", "p, corrected"});
  for (const Trend& t : trends.trends) {
    table.rows.push_back({t.parameter, t.law, t.condition, with_error(t.slope, t.std_error),
                          interval_text(t.lower95, t.upper95, places_for(t.std_error)), t.slope_unit(),
                          std::to_string(t.runs), significant(t.p_value, 2), significant(t.p_corrected, 2)});
  }
  return table;
}

/// What was fitted, whether sharing holds, and what it costs on held-out blocks.
std::string sharing_sentence(const SharedFit& fit) {
  const SharedFit::Test& test = fit.test;
  std::string out;
  if (fit.is_joint) out = fmt::format("{} runs fitted together, all samples", fit.runs.size());
  if (!std::isfinite(test.held_out_together)) return out;
  const std::string tested = fmt::format(" ({})", p_value_text(test.p_value));
  if (!fit.is_joint) out = "the single fits together, with what differs from run to run";
  if (test.is_refused) {
    out += fmt::format(
        "; the runs do not share this{}: they differ {} times as much as their own errors allow, most of "
        "all {}",
        tested, significant(std::sqrt(test.ratio), 2), test.most_different);
  } else if (std::isfinite(test.p_value)) {
    out += "; the runs allow it" + tested;
  }
  return out + fmt::format("; held-out error {} together, {} each by itself ({})",
                           significant(test.held_out_together, 4), significant(test.held_out_alone, 4),
                           p_value_text(test.held_out_p_value));
}

void add_shared(const Pooled& pooled, ReportSection& section) {
  for (const SharedFit& fit : pooled.shared) {
    section.add(shared_table(fit));
    section.soft(sharing_sentence(fit));
    for (const std::string& note : fit.notes) section.soft(note);
  }
}

}  // namespace

ReportTable repeats_table(std::span<const PooledGroup> groups) {
  ReportTable table("Repeats together (joint fit; intervals from run to run)", "pooled.csv");
  table.text({"conditions"}).text({"law", "parameter"}).numbers({"value", "95 % interval"}).text({"unit"});
  table.numbers({"runs", "degrees of freedom", "best in"});
  table.columns[7].brief = "dof";
  for (const PooledGroup& group : groups) {
    bool first_of_group = true;
    for (const PooledGroup::OfFit& fit : group.fits) {
      if (fit.protocol != to_string(Protocol::joint)) continue;
      bool first_of_law = true;
      for (const PooledValue& v : fit.parameters) {
        const bool known = v.runs > 0 && std::isfinite(v.std_error) && v.std_error > 0;
        const int places = known ? places_for(v.std_error) : 4;
        const std::string value = v.runs == 0 ? "-" : known ? fixed(v.value, places) : significant(v.value, 4);
        table.rows.push_back({first_of_group ? conditions_text(group) : "", first_of_law ? fit.law : "",
                              full_name(v.name, v.effect), value + (v.runs == 1 ? " *" : ""),
                              known ? interval_text(v.lower95, v.upper95, places) : "-", v.unit == "1" ? "" : v.unit,
                              std::to_string(v.runs), v.runs > 1 ? std::to_string(v.runs - 1) : "-",
                              first_of_law ? std::to_string(fit.best_in) : ""});
        first_of_group = first_of_law = false;
      }
    }
  }
  return table;
}

ReportTable runs_table(const std::string& friction_unit) {
  ReportTable table("", "summary.csv");
  table.text({"run", "conditions"}).numbers({"cycles", "frequency [Hz]"}, 3).text({"best law"});
  table.numbers({with_unit(static_level_name, friction_unit), with_unit(kinetic_level_name, friction_unit)})
      .text({kOtherParameters});
  table.numbers({with_unit("held-out error", friction_unit)});
  table.numbers({with_unit("noise floor", friction_unit)}).text({"warnings"}, 4);
  return table;
}

std::vector<std::string> run_row(const RunResult& r) {
  const bool fitted = r.run.status == RunStatus::ok && r.best < r.fits.size();
  const ResultFit best = fitted ? r.fits[r.best] : ResultFit{};
  std::vector<std::string> row = {r.run.name, conditions_text(r.known_conditions(), r.run.others),
                                  r.was_read() ? std::to_string(r.cycles) : "",
                                  r.was_read() ? with_error(r.frequency.value, r.frequency.std_error) : "",
                                  fitted ? best.law : std::string(to_string(r.run.status))};
  add_law_cells(best.parameters, row);
  row.push_back(fitted ? significant(best.held_out_rmse, 3) : "");
  row.push_back(fitted ? significant(best.floor_rmse, 3) : "");
  row.push_back(r.run.message.empty() ? std::to_string(r.warnings.size()) : r.run.message);
  return row;
}

std::vector<std::string> run_row(const PlannedRun& missing) {
  return {missing.name, "", "", "", "missing", "", "", "", "", "", ""};
}

std::vector<std::string> trend_sentences(const Trends& trends) {
  std::vector<std::string> out;
  for (const Trend& t : significant_trends(trends)) {
    out.push_back(fmt::format("{} ({} law) {} with {}: {}{} ({}, corrected for {} trends)", t.parameter, t.law,
                              t.rises() ? "rises" : "falls", t.condition, with_error(t.slope, t.std_error),
                              unit_behind(t.slope_unit()), p_value_text(t.p_corrected), trends.trends.size()));
  }
  if (out.empty() && !trends.trends.empty()) out.push_back("no significant trend");
  return out;
}

ReportSection comparison_section(const EarlierComparison& comparison, std::span<const PooledGroup> groups) {
  ReportSection section{"comparison", "Beside " + comparison.path, {}};
  section.add(comparison_table(comparison, groups));
  if (!section.items.empty()) {
    section.soft(
        "std errors: the difference over the error of ours (statistical, between runs and systematic) and that of the "
        "earlier value where it is stated; extremes: per-cycle extremes");
  }
  for (const std::string& unmatched : comparison.unmatched) section.item(unmatched);
  return section;
}

ReportSection statements_section(const Statements& s, std::span<const PooledGroup> groups) {
  ReportSection section{"statements", "Which law predicts better (joint fit, held-out cycles)", {}};
  if (s.overall.runs > 0) section.item("all: " + preference_text(s.overall));
  for (std::size_t g = 0; s.overall.runs > 0 && g < s.preference.size(); ++g) {
    if (s.preference[g].runs > 0) section.item(conditions_text(groups[g]) + ": " + preference_text(s.preference[g]));
  }
  section.add(error_table(s, groups));
  return section;
}

ReportSection pooled_section(const Pooled& pooled) {
  ReportSection section{"pooled", "All values", {}};
  section.add(repeats_table(pooled.groups), Medium::terminal);
  const bool single = std::any_of(pooled.groups.begin(), pooled.groups.end(),
                                  [](const PooledGroup& group) { return group.runs.size() == 1; });
  if (single) section.plain("* one run: what differs from run to run is not in its error", Medium::terminal);
  section.add(groups_table(pooled.groups), Medium::page);
  add_shared(pooled, section);
  return section;
}

ReportSection trends_section(const Trends& trends) {
  ReportSection section{"trends", "Trends", {}};
  for (const std::string& sentence : trend_sentences(trends)) section.item(sentence);
  section.add(trends_table(trends));
  for (const std::string& warning : trends.warnings) {
    section.text(ReportText::Kind::warning, warning, Medium::terminal);  // a page has them at its head
  }
  return section;
}

}  // namespace tribofit
