#include "summary_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "csv_cells.hpp"

namespace tribofit {
namespace {

constexpr std::array<const char*, 8> kFirst = {"run",       "file",      "status", "message",
                                               "radius_mm", "speed_rpm", "load_N", "repeat"};

/// Name of the column of a further condition; one that is called like a column of ours is told from it.
std::string column_of(const OtherCondition& other) {
  const bool taken = std::find(kFirst.begin(), kFirst.end(), other.name) != kFirst.end();
  return taken ? "condition " + other.name : other.name;
}

/// Hands over every cell of a result beyond the first columns: name and value.
template <class Add>
void visit_measure(const std::string& name, const std::string& unit, const ResultMeasure& measure, Add&& add) {
  add(name + "_" + unit, cell(measure.value));
  add(name + "_std_error_" + unit, cell(measure.std_error));
}

template <class Add>
void visit_fit(const ResultFit& fit, const std::string& friction_unit, Add&& add) {
  const std::string of_fit = fit.law + "_" + fit.protocol + "_";
  const auto with_unit = [](const std::string& name, const std::string& unit) {
    return unit == "1" ? name : name + " [" + unit + "]";
  };
  for (const ResultParameter& p : fit.parameters) {
    add(with_unit(of_fit + p.name, p.unit), cell(p.value));
    add(with_unit(of_fit + p.name + "_std_error", p.unit), cell(p.std_error));
    if (p.systematic > 0) add(with_unit(of_fit + p.name + "_systematic_error", p.unit), cell(p.systematic));
  }
  add(with_unit(of_fit + "rmse", friction_unit), cell(fit.rmse));
  add(with_unit(of_fit + "held_out_rmse", friction_unit), cell(fit.held_out_rmse));
  add(with_unit(of_fit + "floor_rmse", friction_unit), cell(fit.floor_rmse));
  add(of_fit + "mean_relative", cell(fit.mean_relative));
  add(of_fit + "max_relative", cell(fit.max_relative));
}

template <class Add>
void visit_analysis(const RunResult& result, Add&& add) {
  if (result.run.status == RunStatus::unreadable) return;
  add("samples", std::to_string(result.samples));
  add("duration_s", cell(result.duration));
  add("rate_hz", cell(result.rate));
  add("cycles", std::to_string(result.cycles));
  visit_measure("frequency", "hz", result.frequency, add);
  visit_measure("amplitude", "mm_s", result.amplitude, add);
  visit_measure("stick_time", "s", result.stick_time, add);
  visit_measure("slip_time", "s", result.slip_time, add);
  add("rms_velocity_mm_s", cell(result.rms_velocity));
  add("best_law", result.fits.empty() ? "" : result.fits[result.best].law);
  for (const ResultFit& fit : result.fits) visit_fit(fit, result.friction_unit, add);
}

const Conditions& known_conditions(const RunResult& result) {
  return result.run.status == RunStatus::unreadable ? result.run.conditions : result.conditions;
}

std::map<std::string, std::string> cells_of(const RunResult& result) {
  const RunRecord& run = result.run;
  const Conditions& c = known_conditions(result);
  std::map<std::string, std::string> cells = {{"run", cell(run.name)},
                                              {"file", cell(run.file)},
                                              {"status", std::string(to_string(run.status))},
                                              {"message", cell(run.message)},
                                              {"radius_mm", cell(c.radius.value / kMillimetre)},
                                              {"speed_rpm", cell(c.speed.value / kRpm)},
                                              {"load_N", cell(c.load.value)},
                                              {"repeat", run.repeat ? std::to_string(*run.repeat) : ""}};
  for (const OtherCondition& other : run.others) cells.emplace(column_of(other), cell(other.value));
  visit_analysis(result,
                 [&](const std::string& column, std::string value) { cells.emplace(column, std::move(value)); });
  return cells;
}

std::string condition_text(const Condition& condition, double unit) {
  return condition.known() ? brief(condition.value / unit) : "-";
}

std::vector<std::string> row_of(const RunResult& result) {
  const RunRecord& run = result.run;
  const Conditions& c = known_conditions(result);
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

SummarySheet::SummarySheet() {
  for (const char* column : kFirst) known_.emplace(column, true);
}

void SummarySheet::declare(const RunResult& result) {
  for (const OtherCondition& other : result.run.others) {
    if (known_.emplace(column_of(other), true).second) conditions_.push_back(column_of(other));
  }
  visit_analysis(result, [&](const std::string& column, const std::string&) {
    if (known_.emplace(column, true).second) columns_.push_back(column);
  });
}

std::string SummarySheet::header() const {
  std::string text;
  for (const char* column : kFirst) text += (text.empty() ? "" : ",") + std::string(column);
  for (const auto* columns : {&conditions_, &columns_}) {
    for (const std::string& column : *columns) text += "," + cell(column);
  }
  return text + "\n";
}

std::string SummarySheet::row(const std::map<std::string, std::string>& cells) const {
  const auto value = [&](const std::string& column) {
    const auto found = cells.find(column);
    return found == cells.end() ? std::string() : found->second;
  };
  std::string text;
  for (const char* column : kFirst) text += (column == kFirst.front() ? "" : ",") + value(column);
  for (const auto* columns : {&conditions_, &columns_}) {
    for (const std::string& column : *columns) text += "," + value(column);
  }
  return text + "\n";
}

std::string SummarySheet::row(const RunResult& result) const {
  return row(cells_of(result));
}

std::string SummarySheet::row(const MissingRun& run) const {
  return row({{"run", cell(run.name)}, {"file", cell(run.file)}, {"status", "missing"}});
}

ResultTable::ResultTable(const TerminalOptions& options)
    : style_(options.colour, options.width),
      table_({"run", "mm", "rpm", "N", "best law", "mu_s", "mu_k", "alpha, beta", "error", "floor"},
             {true, false, false, false, true}) {}

void ResultTable::add(const RunResult& result) {
  if (rows_++ < kMostRows) table_.add(row_of(result));
}

void ResultTable::add(const MissingRun& run) {
  if (rows_++ < kMostRows) table_.add({run.name, "", "", "", "missing", "", "", "", "", ""});
}

std::string ResultTable::text() const {
  std::string text = table_.text(2, style_.bold, style_.off);
  if (rows_ > kMostRows) text += fmt::format("  ... and {} more in summary.csv\n", rows_ - kMostRows);
  return text + "  " +
         wrapped(
             "+/- is one standard error of the run, from its cycles; alpha, beta in s/mm; error is that on data not "
             "seen (RMSE)",
             style_.width, 2) +
         "\n";
}

}  // namespace tribofit
