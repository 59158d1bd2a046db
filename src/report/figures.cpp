#include "tribofit/report/figures.hpp"

#include <filesystem>
#include <numeric>
#include <string>

#include "campaign/condition_cells.hpp"
#include "tribofit/campaign/group_values.hpp"

namespace tribofit {
namespace {

constexpr int kDigits = 10;

void write_groups(WholeFolder& files, const ConditionCells& conditions, std::span<const RunResult> runs,
                  std::span<const PooledGroup> groups) {
  const auto table = [&](const char* name, const std::string& columns) {
    return CsvTable(files, name, "runs," + conditions.header() + "," + columns, kDigits);
  };
  CsvTable rms = table("05-rms-velocity.csv", "rms_velocity_mm_s,rms_velocity_std_error_mm_s");
  CsvTable levels =
      table("09-static-kinetic.csv",
            "law,protocol,unit,mu_s,mu_s_std_error,mu_k,mu_k_std_error,mu_s_minus_mu_k,mu_s_minus_mu_k_std_error");
  for (const PooledGroup& group : groups) {
    const Json of_group = {group.runs.size(), conditions.of(group.conditions, group.others)};
    if (const PooledValue* v = pooled_value(group.measures, "rms_velocity")) {
      rms.row(of_group, v->mean, v->standard_error_of_mean);
    }
    for (const PooledGroup::OfFit& fit : group.fits) {
      const PooledValue *mu_s = pooled_value(fit.parameters, "mu_s"), *mu_k = pooled_value(fit.parameters, "mu_k");
      if (mu_s == nullptr || mu_k == nullptr) continue;
      const ResultMeasure drop = drop_of(runs, group, fit);
      levels.row(of_group, fit.law, fit.protocol, mu_s->unit, mu_s->mean, mu_s->standard_error_of_mean, mu_k->mean,
                 mu_k->standard_error_of_mean, drop.value, drop.std_error);
    }
  }
}

void write_runs(WholeFolder& files, const ConditionCells& conditions, const ResultReader& results,
                std::span<const RunResult> runs) {
  const auto table = [&](const char* name, const std::string& columns, int digits = kDigits) {
    return CsvTable(files, name, "run," + conditions.header() + "," + columns, digits);
  };
  CsvTable cycles = table("06-08-three-cycles.csv", "time_s,v_r_mm_s,friction,unit", 0);
  CsvTable spectrum = table("07-spectrum.csv", "frequency_hz,amplitude_mm_s");
  CsvTable harmonics = table("07-harmonics.csv", "harmonic,frequency_hz,amplitude_mm_s");
  CsvTable bins = table("10-12-over-velocity.csv",
                        "law,protocol,unit,v_r_from_mm_s,v_r_to_mm_s,samples,friction,fitted,relative_error_of_mean,"
                        "mean_relative_error,largest_relative_error");
  CsvTable errors = table("12-relative-error.csv",
                          "law,protocol,samples,share_below_0.08,share_of_bins_below_0.08,largest_of_bins,mean_"
                          "relative_error,largest_relative_error");
  for (const RunResult& run : runs) {
    const auto f = results.figures(run.position);
    if (!f) continue;
    const Json of_run = {run.run.name, conditions.of(run.conditions, run.run.others)};
    for (std::size_t k = 0; k < f->time.size(); ++k) {
      cycles.row(of_run, f->time[k], f->velocity[k], f->friction[k], run.friction_unit);
    }
    for (std::size_t k = 0; k < f->spectrum.size(); ++k) {
      spectrum.row(of_run, static_cast<double>(k) * f->spectrum_step, f->spectrum[k]);
    }
    for (std::size_t k = 0; k < f->harmonics.size(); ++k) {
      harmonics.row(of_run, k + 1, f->harmonics[k].frequency, f->harmonics[k].amplitude);
    }
    const std::size_t samples = std::accumulate(f->bin_samples.begin(), f->bin_samples.end(), std::size_t{0});
    for (const ErrorCurve& curve : f->errors) {
      for (std::size_t k = 0; k < f->bin_samples.size(); ++k) {
        const double from = static_cast<double>(k) * f->bin_width;
        bins.row(of_run, curve.law, curve.protocol, run.friction_unit, from, from + f->bin_width, f->bin_samples[k],
                 f->bin_friction[k], curve.fitted[k], f->error_of_mean(curve, k), curve.bin_mean_relative[k],
                 curve.bin_max_relative[k]);
      }
      errors.row(of_run, curve.law, curve.protocol, samples, curve.below_limit, curve.bins_below_limit,
                 curve.largest_of_bins, curve.mean_relative, curve.max_relative);
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
