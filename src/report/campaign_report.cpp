#include "campaign_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "report_parts.hpp"
#include "tribofit/campaign/compare.hpp"

namespace tribofit {
namespace {

const std::string kExtremes(to_string(Protocol::published));

/// The protocol as people call it; JSON and CSV have its own name.
std::string protocol_cell(const std::string& protocol) {
  return protocol == kExtremes ? "extremes" : protocol;
}

/// What the first columns of a row have in common with the row above is said once.
ReportTable said_once(ReportTable table, std::size_t columns) {
  for (std::size_t i = table.rows.size(); i-- > 1;) {
    const auto &above = table.rows[i - 1], &row = table.rows[i];
    for (std::size_t k = 0; k < columns && row[k] == above[k]; ++k) table.rows[i][k].clear();
  }
  return table;
}

ReportTable values_table(std::string caption, const char* file) {
  ReportTable table(std::move(caption), file);
  table.text({"conditions", "law"}).text({"protocol"}, 1).text({"value"}).numbers({"mean", "95 % interval"});
  table.text({"unit"}).numbers({"runs"}).numbers({"statistical"}, 2).numbers({"between runs"}, 1);
  return table.numbers({"systematic"}, 2);
}

std::vector<std::string> value_row(const PooledValue& v, const std::string& name, const std::string& law,
                                   const std::string& protocol, const std::string& conditions) {
  const auto part = [](double value) { return std::isfinite(value) && value != 0 ? significant(value, 2) : "-"; };
  const bool known = v.runs > 0 && std::isfinite(v.std_error) && v.std_error > 0;
  return {conditions,
          law,
          protocol_cell(protocol),
          name,
          v.runs > 0 ? with_error(v.value, v.std_error) : "-",
          known ? interval_text(v.lower95, v.upper95, places_for(v.std_error)) : "-",
          v.unit == "1" ? "" : v.unit,
          std::to_string(v.runs),
          part(v.statistical),
          part(v.between),
          part(v.systematic)};
}

/// Earlier values beside ours, and what has no partner.
ReportSection comparison_section(const EarlierComparison& comparison, std::span<const PooledGroup> groups) {
  ReportSection section{"comparison", "Beside " + comparison.path, {}};
  ReportTable table("", "comparison.csv");  // a row a value, with both protocols
  table.text({"conditions", "value", "law"}).numbers({"earlier", "joint fit", "difference", "std errors"});
  table.numbers({"extremes", "difference"});
  const ComparedValue* before = nullptr;
  for (const ComparedValue& v : comparison.values) {
    const bool extremes = v.protocol == kExtremes;
    if (!extremes || before == nullptr || before->protocol == kExtremes || !v.is_beside_same(*before)) {
      table.rows.push_back({conditions_text(groups[v.group]), with_unit(v.earlier.name, v.ours.unit), v.law,
                            with_error(v.earlier.value, v.earlier.std_error), "", "", "", "", ""});
    }
    std::vector<std::string>& row = table.rows.back();
    if (!extremes) row[4] = with_error(v.ours.value, v.ours.std_error);
    if (!extremes) row[6] = with_sign(v.in_std_errors, std::abs(v.in_std_errors) < 100 ? 1 : 0);
    if (extremes) row[7] = significant(v.ours.value, 4);
    row[extremes ? 8 : 5] = with_sign(v.percent, 2, " %");
    before = &v;
  }
  section.add(said_once(std::move(table), 1));
  if (!section.items.empty()) {
    section.soft(
        "std errors: the difference over the error of ours (statistical, between runs and systematic) and that of the "
        "earlier value where it is stated; extremes: per-cycle extremes");
  }
  for (const std::string& unmatched : comparison.unmatched) section.item(unmatched);
  return section;
}

/// Which law predicts better, over all runs and by conditions; relative errors (Eq 5).
ReportSection statements_section(const Statements& s, std::span<const PooledGroup> groups) {
  ReportSection section{"statements", "Which law predicts better (joint fit, held-out cycles)", {}};
  const auto add = [&](const std::string& where, const LawPreference& p) {
    if (p.runs == 0 || s.overall.runs == 0) return;
    const std::string chance = std::isfinite(p.p_value) ? ", " + p_value_text(p.p_value) : "";
    section.item(fmt::format("{}: {} in {} of {} run{}; the held-out error of {} is {} times as large{}", where,
                             p.better, p.better_in, p.runs, p.runs == 1 ? "" : "s", p.other, significant(p.ratio, 4),
                             chance));
  };
  add("all", s.overall);
  for (std::size_t g = 0; g < s.preference.size(); ++g) add(conditions_text(groups[g]), s.preference[g]);
  ReportTable table("Relative error |(measured - law)/measured|, slip samples and means in 40 bins of v_r",
                    "summary.json");
  const std::string limit = published_error_limit_text;
  table.text({"conditions", "law", "protocol"}).numbers({"samples below " + limit, "mean", "largest"});
  table.numbers({"bins below " + limit, "largest of bins"});
  for (const ErrorStatement& e : s.errors) {
    table.rows.push_back({conditions_text(groups[e.group]), e.law, protocol_cell(e.protocol), share_text(e.below_limit),
                          significant(e.mean_relative, 2), significant(e.max_relative, 2),
                          share_text(e.bins_below_limit), significant(e.largest_of_bins, 2)});
  }
  section.add(said_once(std::move(table), 1));
  return section;
}

/// What was fitted, whether sharing holds, and what it costs.
std::string sharing_sentence(const SharedFit& fit) {
  const SharedFit::Test& test = fit.test;
  std::string out;
  if (fit.is_joint) out = fmt::format("{} runs fitted together, all samples", fit.runs.size());
  if (!std::isfinite(test.held_out_together)) return out;
  const std::string tested = fmt::format(" ({})", p_value_text(test.p_value));
  if (!fit.is_joint) out = "the single fits together, with what differs from run to run";
  if (test.is_refused) {
    out += fmt::format(
        "; the runs do not share this{}: they differ {} times as much as their own errors allow, most of all {}",
        tested, significant(std::sqrt(test.ratio), 2), test.most_different);
  } else if (std::isfinite(test.p_value)) {
    out += "; the runs allow it" + tested;
  }
  return out + fmt::format("; held-out error {} together, {} each by itself ({})",
                           significant(test.held_out_together, 4), significant(test.held_out_alone, 4),
                           p_value_text(test.held_out_p_value));
}

/// Every pooled value with the parts of its error, and the parameters that runs share.
ReportSection pooled_section(const Pooled& pooled) {
  ReportSection section{"pooled", "All values", {}};
  for (const bool joint_alone : {true, false}) {
    section.add(repeats_table(pooled.groups, joint_alone), joint_alone ? Medium::terminal : Medium::page);
  }
  const auto is_single = [](const PooledGroup& group) { return group.runs.size() == 1; };
  if (std::ranges::any_of(pooled.groups, is_single))
    section.plain("of one run what differs from run to run is not in its error", Medium::terminal);
  for (const SharedFit& fit : pooled.shared) {
    ReportTable table = values_table("Parameters that runs have in common, " + fit.law + " law", "shared.csv");
    for (const SharedFit::Parameter& common : fit.common) {
      for (std::size_t l = 0; l < common.values.size(); ++l) {
        table.rows.push_back(value_row(common.values[l], common.name, fit.law, std::string(to_string(Protocol::joint)),
                                       common.condition.empty() ? "all runs" : common.levels[l]));
      }
    }
    section.add(std::move(table));
    section.soft(sharing_sentence(fit));
    for (const std::string& note : fit.notes) section.soft(note);
  }
  return section;
}

/// Significant trends, and what is not said in the warnings.
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

/// Significant trends, and all that were looked at.
ReportSection trends_section(const Trends& trends) {
  ReportSection section{"trends", "Trends", {}};
  for (const std::string& sentence : trend_sentences(trends)) section.item(sentence);
  ReportTable table("Straight lines over the conditions", "trends.csv");
  table.folded = true;
  table.text({"parameter", "law", "over"}).numbers({"slope", "95 % interval"}).text({"unit"});
  table.numbers({"runs", "p", "p, corrected"});
  for (const Trend& t : trends.trends) {
    table.rows.push_back({t.parameter, t.law, t.condition, with_error(t.slope, t.std_error),
                          interval_text(t.lower95, t.upper95, places_for(t.std_error)), t.slope_unit(),
                          std::to_string(t.runs), significant(t.p_value, 2), significant(t.p_corrected, 2)});
  }
  section.add(std::move(table));
  for (const std::string& warning : trends.warnings) {
    section.text(ReportText::Kind::warning, warning, Medium::terminal);  // a page has them at its head
  }
  return section;
}

/// A page shows the first rows of long tables, and folds many rows away.
void limit_tables(Report& report) {
  constexpr std::size_t kMostRows = 1000, kMostOpen = 60;
  for (ReportSection& section : report.sections) {
    for (ReportItem& item : section.items) {
      auto* table = std::get_if<ReportTable>(&item);
      if (table == nullptr || item.medium == Medium::terminal || section.medium == Medium::terminal) continue;
      table->folded |= table->rows.size() > kMostOpen;
      if (table->rows.size() <= kMostRows) continue;
      table->caption +=
          fmt::format("; the first {} of {} rows, {} has all", kMostRows, table->rows.size(), table->file);
      table->rows.resize(kMostRows);
    }
  }
}

/// All runs of the campaign, those without a result too.
ReportTable listed_runs(const DrawnCampaign& campaign) {
  ReportTable table = runs_table(campaign.friction_unit());
  auto next = campaign.runs.begin();
  for (std::size_t k = 0; k < campaign.results.size(); ++k) {
    if (next != campaign.runs.end() && next->position == k) {
      table.rows.push_back(run_row(*next++));
      continue;
    }
    std::vector<std::string> row(table.columns.size());
    row[0] = campaign.results.plan().runs[k].name, row[4] = "missing";
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportSection runs_section(const DrawnCampaign& campaign, ReportTable runs) {
  ReportSection section{"runs", "The runs", {}, Medium::page};
  for (const ResultFit* fit : joint_fits(campaign.runs)) section.add(scatter_chart(campaign, fit->law));
  runs.caption = fmt::format("{} runs", campaign.results.size());
  section.add(std::move(runs));
  ReportTable warnings("Warnings of the runs", "summary.json");
  warnings.text({"run", "warning"});
  for (const RunResult& r : campaign.runs) {
    for (const std::string& warning : r.warnings) warnings.rows.push_back({r.run.name, warning});
  }
  section.add(std::move(warnings));
  return section;
}

std::string lead_of(const DrawnCampaign& campaign, std::size_t fitted, const Trends& trends) {
  constexpr std::size_t kLong = 300;
  std::string text = fmt::format("{} of {} runs fitted, under {} condition{}.", fitted, campaign.results.size(),
                                 campaign.groups.size(), campaign.groups.size() == 1 ? "" : "s");
  const EarlierComparison::Agreement agreement =
      campaign.earlier == nullptr ? EarlierComparison::Agreement{} : campaign.earlier->agreement();
  if (agreement.values > 0) {
    text += fmt::format(" {} of {} values of {} lie in our 95 % intervals.", agreement.inside, agreement.values,
                        campaign.earlier_name());
  }
  if (significant_trends(trends).empty()) return text;
  for (const std::string& trend : trend_sentences(trends)) {
    if (text.size() <= kLong) text += " Trend: " + trend + ".";
  }
  return text;
}

}  // namespace

ReportTable repeats_table(std::span<const PooledGroup> groups, bool joint_alone) {
  ReportTable table = values_table(joint_alone ? "Repeats together (joint fit; intervals from run to run)"
                                               : "Repeats together (the mean with one standard error, from run to run)",
                                   "pooled.csv");
  for (const PooledGroup& group : groups) {
    const auto add = [&](const std::vector<PooledValue>& values, const std::string& law, const std::string& protocol) {
      for (const PooledValue& v : values) {
        table.rows.push_back(value_row(v, full_name(v.name, v.effect), law, protocol, conditions_text(group)));
      }
    };
    for (const PooledGroup::OfFit& fit : group.fits) {
      if (!joint_alone || fit.protocol != kExtremes) add(fit.parameters, fit.law, fit.protocol);
    }
    if (!joint_alone) add(group.measures, "", "");
  }
  return joint_alone ? said_once(std::move(table), 3) : table;
}

ReportTable runs_table(const std::string& friction_unit) {
  ReportTable table("", "summary.csv");
  table.text({"run", "conditions"}).numbers({"cycles", "frequency [Hz]"}, 3).text({"best law"});
  table.numbers({with_unit(static_level_name, friction_unit), with_unit(kinetic_level_name, friction_unit)});
  table.text({"other parameters of the law"});
  table.numbers({with_unit("held-out error", friction_unit), with_unit("noise floor", friction_unit)});
  return table.text({"warnings"}, 4);
}

std::vector<std::string> run_row(const RunResult& r) {
  const bool fitted = r.run.status == RunStatus::ok && r.best < r.fits.size();
  const ResultFit best = fitted ? r.fits[r.best] : ResultFit{};
  std::string mu_s, mu_k, others;
  for (const ResultParameter& p : best.parameters) {
    const std::string text = with_error(p.value, p.std_error);
    if (!p.effect.empty()) continue;
    if (p.name == static_level_name) {
      mu_s = text;
    } else if (p.name == kinetic_level_name) {
      mu_k = text;
    } else {
      others += (others.empty() ? "" : ", ") + p.name + " " + text + unit_behind(p.unit);
    }
  }
  return {r.run.name,
          conditions_text(r.known_conditions(), r.run.others),
          r.was_read() ? std::to_string(r.cycles) : "",
          r.was_read() ? with_error(r.frequency.value, r.frequency.std_error) : "",
          fitted ? best.law : std::string(to_string(r.run.status)),
          mu_s,
          mu_k,
          others,
          fitted ? significant(best.error.held_out_rmse, 3) : "",
          fitted ? significant(best.floor.rmse, 3) : "",
          r.run.message.empty() ? std::to_string(r.warnings.size()) : r.run.message};
}

Report report_of(const ResultReader& results, std::span<const RunResult> runs, const Pooled& pooled,
                 const std::optional<ComparisonReport>& comparison, const ReportOptions& options) {
  const DrawnCampaign campaign(results, runs, pooled, comparison);
  const std::string folder = results.plan().folder.empty() ? results.folder() : results.plan().folder;
  const auto fitted = static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const RunResult& r) { return r.run.status == RunStatus::ok; }));
  Report report = titled_report("campaign", file_name(folder), lead_of(campaign, fitted, pooled.trends));
  report.facts = {{"runs", std::to_string(results.size())},
                  {"fitted", std::to_string(fitted)},
                  {"failed", std::to_string(runs.size() - fitted)},
                  {"missing", std::to_string(results.size() - runs.size())},
                  {"conditions", std::to_string(campaign.groups.size())}};
  constexpr std::size_t kMostWarnings = 200;
  report.warnings = pooled.trends.warnings;
  const auto end = results.plan().problems.begin() +
                   static_cast<std::ptrdiff_t>(std::min(results.plan().problems.size(), kMostWarnings));
  report.warnings.insert(report.warnings.end(), results.plan().problems.begin(), end);
  ReportTable listed = listed_runs(campaign);
  ReportSection first{"first-runs", "", {listed}, Medium::terminal};
  first.plain("+/- is one standard error of the run, from its cycles; held-out error and noise floor are RMSE");
  report.add({std::move(first)});
  if (comparison) report.add({comparison_section(comparison->values, campaign.groups)});
  if (options.charts) report.add({motion_figures(campaign), law_figures(campaign)});
  if (comparison || options.charts) {
    report.add({statements_section(comparison ? comparison->statements : statements_of(results, runs, campaign.groups),
                                   campaign.groups)});
    if (!comparison && report.sections.back().id == "statements") report.sections.back().medium = Medium::page;
  }
  report.add({pooled_section(pooled), trends_section(pooled.trends)});
  if (options.charts) report.add({runs_section(campaign, std::move(listed))});
  report.add({run_section(report, command_line(options.arguments, {options.inputs_or(folder).front()}), {},
                          " Checksums of the traces stand in the results of the runs.")});
  limit_tables(report);
  return report;
}

}  // namespace tribofit
