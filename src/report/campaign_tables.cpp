#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "numbers.hpp"
#include "style.hpp"
#include "summary_rows.hpp"
#include "tribofit/report/campaign.hpp"

namespace tribofit {
namespace {

/// A cell of a CSV file; quoted where it must be, line breaks become blanks.
std::string cell(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

/// Columns in the order in which they first appear, and the cells of one row after the other.
class Sheet {
 public:
  void begin_row() { rows_.emplace_back(); }
  template <class Value>
  void set(const std::string& column, const Value& value) {
    const auto [at, is_new] = index_.emplace(column, columns_.size());
    if (is_new) columns_.push_back(column);
    auto& row = rows_.back();
    if (row.size() <= at->second) row.resize(at->second + 1);
    row[at->second] = cell(value);
  }
  /// Columns that were named before the rows that fill them.
  void declare(const std::string& column) {
    if (index_.emplace(column, columns_.size()).second) columns_.push_back(column);
  }
  std::string text() const {
    std::string text;
    for (std::size_t k = 0; k < columns_.size(); ++k) text += (k > 0 ? "," : "") + cell(columns_[k]);
    text += "\n";
    for (const auto& row : rows_) {
      for (std::size_t k = 0; k < columns_.size(); ++k) text += (k > 0 ? "," : "") + (k < row.size() ? row[k] : "");
      text += "\n";
    }
    return text;
  }

 private:
  std::map<std::string, std::size_t> index_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

void add_measure(Sheet& sheet, const std::string& name, const std::string& unit, const ResultMeasure& measure) {
  sheet.set(name + "_" + unit, measure.value);
  sheet.set(name + "_std_error_" + unit, measure.std_error);
}

void add_fit(Sheet& sheet, const ResultFit& fit, const std::string& friction_unit) {
  const std::string of_fit = fit.law + "_" + fit.protocol + "_";
  const auto with_unit = [](const std::string& name, const std::string& unit) {
    return unit == "1" ? name : name + " [" + unit + "]";
  };
  for (const ResultParameter& p : fit.parameters) {
    sheet.set(with_unit(of_fit + p.name, p.unit), p.value);
    sheet.set(with_unit(of_fit + p.name + "_std_error", p.unit), p.std_error);
    if (p.systematic > 0) sheet.set(with_unit(of_fit + p.name + "_systematic_error", p.unit), p.systematic);
  }
  sheet.set(with_unit(of_fit + "rmse", friction_unit), fit.rmse);
  sheet.set(with_unit(of_fit + "held_out_rmse", friction_unit), fit.held_out_rmse);
  sheet.set(with_unit(of_fit + "floor_rmse", friction_unit), fit.floor_rmse);
  sheet.set(of_fit + "mean_relative", fit.mean_relative);
  sheet.set(of_fit + "max_relative", fit.max_relative);
}

void add_result(Sheet& sheet, const RunResult& result) {
  const RunRecord& run = result.run;
  const bool read = run.status != RunStatus::unreadable;
  const Conditions& conditions = read ? result.conditions : run.conditions;
  sheet.begin_row();
  sheet.set("run", run.name);
  sheet.set("file", run.file);
  sheet.set("status", std::string(to_string(run.status)));
  sheet.set("message", run.message);
  sheet.set("radius_mm", conditions.radius.value / kMillimetre);
  sheet.set("speed_rpm", conditions.speed.value / kRpm);
  sheet.set("load_N", conditions.load.value);
  sheet.set("repeat", run.repeat ? std::to_string(*run.repeat) : "");
  for (const OtherCondition& other : run.others) sheet.set(other.name, other.value);
  if (!read) return;
  sheet.set("samples", std::to_string(result.samples));
  sheet.set("duration_s", result.duration);
  sheet.set("rate_hz", result.rate);
  sheet.set("cycles", std::to_string(result.cycles));
  add_measure(sheet, "frequency", "hz", result.frequency);
  add_measure(sheet, "amplitude", "mm_s", result.amplitude);
  add_measure(sheet, "stick_time", "s", result.stick_time);
  add_measure(sheet, "slip_time", "s", result.slip_time);
  sheet.set("rms_velocity_mm_s", result.rms_velocity);
  sheet.set("best_law", result.fits.empty() ? "" : result.fits[result.best].law);
  for (const ResultFit& fit : result.fits) add_fit(sheet, fit, result.friction_unit);
}

std::string condition_text(const Condition& condition, double unit) {
  return condition.known() ? brief(condition.value / unit) : "-";
}

std::vector<std::string> row_of(const RunResult& result) {
  const RunRecord& run = result.run;
  const Conditions& c = run.status == RunStatus::unreadable ? run.conditions : result.conditions;
  std::vector<std::string> row = {run.name, condition_text(c.radius, kMillimetre), condition_text(c.speed, kRpm),
                                  condition_text(c.load, 1)};
  if (run.status != RunStatus::ok) {
    row.insert(row.end(), {std::string(to_string(run.status)), "", "", "", "", ""});
    return row;
  }
  const ResultFit& best = result.fits[result.best];
  row.push_back(best.law);
  for (std::size_t k = 0; k < 3; ++k) {
    const bool known = k < best.parameters.size() && best.parameters[k].effect.empty();
    row.push_back(known ? with_error(best.parameters[k].value, best.parameters[k].std_error) : "");
  }
  row.push_back(significant(best.held_out_rmse, 3));
  row.push_back(significant(best.floor_rmse, 3));
  return row;
}

}  // namespace

std::string summary_csv(const CampaignResults& results) {
  Sheet sheet;
  for (const char* column : {"run", "file", "status", "message", "radius_mm", "speed_rpm", "load_N", "repeat"}) {
    sheet.declare(column);
  }
  for (const RunResult& result : results.runs) {
    for (const OtherCondition& other : result.run.others) sheet.declare(other.name);
  }
  for_each_run(
      results, [&](const RunResult& result) { add_result(sheet, result); },
      [&](const MissingRun& run) {
        sheet.begin_row();
        sheet.set("run", run.name);
        sheet.set("file", run.file);
        sheet.set("status", std::string("missing"));
      });
  return sheet.text();
}

std::string render_results(const CampaignResults& results, const TerminalOptions& options) {
  constexpr std::size_t kMostRows = 40;
  const Style style(options.colour, options.width);
  Table table({"run", "mm", "rpm", "N", "best law", "mu_s", "mu_k", "alpha, beta", "error", "floor"},
              {true, false, false, false, true});
  std::size_t shown_rows = 0, all = results.runs.size() + results.missing.size();
  for_each_run(
      results,
      [&](const RunResult& result) {
        if (shown_rows++ < kMostRows) table.add(row_of(result));
      },
      [&](const MissingRun& run) {
        if (shown_rows++ < kMostRows) table.add({run.name, "", "", "", "missing", "", "", "", "", ""});
      });
  std::string text = table.text(2, style.bold, style.off);
  if (all > kMostRows) text += fmt::format("  ... and {} more in summary.csv\n", all - kMostRows);
  text += "  " +
          wrapped(
              "+/- is one standard error of the run, from its cycles; alpha, beta in s/mm; error is that on data "
              "not seen (RMSE)",
              style.width, 2) +
          "\n";
  return text;
}

}  // namespace tribofit
