#include "tribofit/report/figures.hpp"

#include <filesystem>
#include <string>

#include "campaign/described_results.hpp"

namespace tribofit {
namespace {

/// A group, and of one of its fits the levels; or its measure alone.
struct GroupRow {
  const PooledGroup& group;
  const PooledGroup::OfFit* fit;
  const PooledValue *first, *second;  ///< the measure; or mu_s and mu_k
  Estimate drop;
};

void write_groups(WholeFolder& files, const ConditionCells& conditions, std::span<const RunResult> runs,
                  std::span<const PooledGroup> groups) {
  using Row = GroupRow;
  const auto table = [&](const char* name, std::vector<CsvColumn<Row>> more) {
    std::vector<CsvColumn<Row>> columns = {
        {"runs", [](const Row& r) { return r.group.runs.size(); }},
        {conditions.header(), [&](const Row& r) { return conditions.of(r.group.conditions, r.group.others); }}};
    columns.insert(columns.end(), more.begin(), more.end());
    return CsvTable(files, name, std::move(columns), kMeasuredDigits);
  };
  CsvTable rms = table("05-rms-velocity.csv",
                       {{"rms_velocity_mm_s", [](const Row& r) { return r.first->mean; }},
                        {"rms_velocity_std_error_mm_s", [](const Row& r) { return r.first->standard_error_of_mean; }}});
  CsvTable levels =
      table("09-static-kinetic.csv", {{"law", [](const Row& r) { return r.fit->law; }},
                                      {"protocol", [](const Row& r) { return r.fit->protocol; }},
                                      {"unit", [](const Row& r) { return r.first->unit; }},
                                      {"mu_s", [](const Row& r) { return r.first->mean; }},
                                      {"mu_s_std_error", [](const Row& r) { return r.first->standard_error_of_mean; }},
                                      {"mu_k", [](const Row& r) { return r.second->mean; }},
                                      {"mu_k_std_error", [](const Row& r) { return r.second->standard_error_of_mean; }},
                                      {"mu_s_minus_mu_k", [](const Row& r) { return r.drop.value; }},
                                      {"mu_s_minus_mu_k_std_error", [](const Row& r) { return r.drop.std_error; }}});
  for (const PooledGroup& group : groups) {
    if (const PooledValue* v = pooled_value(group.measures, "rms_velocity")) rms.row({group, nullptr, v, nullptr, {}});
    for (const PooledGroup::OfFit& fit : group.fits) {
      const PooledValue *mu_s = pooled_value(fit.parameters, static_level_name),
                        *mu_k = pooled_value(fit.parameters, kinetic_level_name);
      if (mu_s != nullptr && mu_k != nullptr) levels.row({group, &fit, mu_s, mu_k, drop_of(runs, group, fit)});
    }
  }
}

/// Row k of the figures of a run, and of an error curve of it.
struct RunRow {
  const RunResult& run;
  const RunFigures& figures;
  std::size_t k;
  const ErrorCurve* curve;

  double from() const { return static_cast<double>(k) * figures.bin_width; }
};

std::vector<CsvColumn<RunRow>> columns_of_bins() {
  using Row = RunRow;
  return {{"law", [](const Row& r) { return r.curve->law; }},
          {"protocol", [](const Row& r) { return r.curve->protocol; }},
          {"unit", [](const Row& r) { return r.run.friction_unit; }},
          {"v_r_from_mm_s", [](const Row& r) { return r.from(); }},
          {"v_r_to_mm_s", [](const Row& r) { return r.from() + r.figures.bin_width; }},
          {"samples", [](const Row& r) { return r.figures.bin_samples[r.k]; }},
          {"friction", [](const Row& r) { return r.figures.bin_friction[r.k]; }},
          {"fitted", [](const Row& r) { return r.curve->fitted[r.k]; }},
          {"relative_error_of_mean", [](const Row& r) { return r.figures.error_of_mean(*r.curve, r.k); }},
          {"mean_relative_error", [](const Row& r) { return r.curve->bin_mean_relative[r.k]; }},
          {"largest_relative_error", [](const Row& r) { return r.curve->bin_max_relative[r.k]; }}};
}

std::vector<CsvColumn<RunRow>> columns_of_errors() {
  using Row = RunRow;
  const std::string share = "share_", limit = std::string("_") + published_error_limit_text;
  return {{"law", [](const Row& r) { return r.curve->law; }},
          {"protocol", [](const Row& r) { return r.curve->protocol; }},
          {"samples", [](const Row& r) { return r.figures.slip_samples(); }},
          {share + "below" + limit, [](const Row& r) { return r.curve->below_limit; }},
          {share + "of_bins_below" + limit, [](const Row& r) { return r.curve->bins_below_limit; }},
          {"largest_of_bins", [](const Row& r) { return r.curve->largest_of_bins; }},
          {"mean_relative_error", [](const Row& r) { return r.curve->mean_relative; }},
          {"largest_relative_error", [](const Row& r) { return r.curve->max_relative; }}};
}

void write_runs(WholeFolder& files, const ConditionCells& conditions, const ResultReader& results,
                std::span<const RunResult> runs) {
  using Row = RunRow;
  const auto table = [&](const char* name, std::vector<CsvColumn<Row>> more, int digits = kMeasuredDigits) {
    std::vector<CsvColumn<Row>> columns = {
        {"run", [](const Row& r) { return r.run.run.name; }},
        {conditions.header(), [&](const Row& r) { return conditions.of(r.run.conditions, r.run.run.others); }}};
    columns.insert(columns.end(), more.begin(), more.end());
    return CsvTable(files, name, std::move(columns), digits);
  };
  CsvTable cycles = table("06-08-three-cycles.csv",
                          {{"time_s", [](const Row& r) { return r.figures.time[r.k]; }},
                           {"v_r_mm_s", [](const Row& r) { return r.figures.velocity[r.k]; }},
                           {"friction", [](const Row& r) { return r.figures.friction[r.k]; }},
                           {"unit", [](const Row& r) { return r.run.friction_unit; }}},
                          0);
  CsvTable spectrum =
      table("07-spectrum.csv",
            {{"frequency_hz", [](const Row& r) { return static_cast<double>(r.k) * r.figures.spectrum_step; }},
             {"amplitude_mm_s", [](const Row& r) { return r.figures.spectrum[r.k]; }}});
  CsvTable harmonics =
      table("07-harmonics.csv", {{"harmonic", [](const Row& r) { return r.k + 1; }},
                                 {"frequency_hz", [](const Row& r) { return r.figures.harmonics[r.k].frequency; }},
                                 {"amplitude_mm_s", [](const Row& r) { return r.figures.harmonics[r.k].amplitude; }}});
  CsvTable bins = table("10-12-over-velocity.csv", columns_of_bins());
  CsvTable errors = table("12-relative-error.csv", columns_of_errors());
  for (const RunResult& run : runs) {
    const auto f = results.figures(run.position);
    if (!f) continue;
    const auto rows = [&](CsvTable<Row>& file, std::size_t count, const ErrorCurve* curve = nullptr) {
      for (std::size_t k = 0; k < count; ++k) file.row({run, *f, k, curve});
    };
    rows(cycles, f->time.size());
    rows(spectrum, f->spectrum.size());
    rows(harmonics, f->harmonics.size());
    for (const ErrorCurve& curve : f->errors) {
      rows(bins, f->bin_samples.size(), &curve);
      rows(errors, 1, &curve);
    }
  }
}

}  // namespace

void write_figures(const ResultReader& results, std::span<const RunResult> runs, std::span<const PooledGroup> groups) {
  const std::string folder = (std::filesystem::path(results.folder()) / "figures").string();
  WholeFolder files(folder);
  remove_abandoned_files(folder);
  const ConditionCells conditions(runs);
  write_groups(files, conditions, runs, groups);
  write_runs(files, conditions, results, runs);
  files.commit();
}

}  // namespace tribofit
