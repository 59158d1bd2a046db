#include <filesystem>
#include <string>

#include "campaign/described_results.hpp"
#include "tribofit/report/campaign.hpp"

namespace tribofit {
namespace {

/// The files of one folder; a row begins with the run, or the number of runs, and its conditions.
struct FigureFiles {
  WholeFolder folder;
  ConditionCells conditions;

  CsvFile file(const char* name, const char* first, const std::string& columns, int digits = kMeasuredDigits) {
    return {folder, name, std::string(first) + "," + conditions.header() + "," + columns, digits};
  }

  void write_groups(std::span<const RunResult> runs, std::span<const PooledGroup> groups) {
    CsvFile rms = file("05-rms-velocity.csv", "runs", "rms_velocity_mm_s,rms_velocity_std_error_mm_s");
    CsvFile levels = file("09-static-kinetic.csv", "runs",
                          "law,protocol,unit,mu_s,mu_s_std_error,mu_k,mu_k_std_error,mu_s_minus_mu_k,"
                          "mu_s_minus_mu_k_std_error");
    for (const PooledGroup& group : groups) {
      const std::size_t count = group.runs.size();
      const Json cells = conditions.of(group.conditions, group.others);
      const PooledValue* v = pooled_value(group.measures, "rms_velocity");
      if (v != nullptr) rms.row(count, cells, v->mean, v->standard_error_of_mean);
      for (const PooledGroup::OfFit& fit : group.fits) {
        const PooledValue* mu_s = pooled_value(fit.parameters, static_level_name);
        const PooledValue* mu_k = pooled_value(fit.parameters, kinetic_level_name);
        if (mu_s == nullptr || mu_k == nullptr) continue;
        const Estimate drop = drop_of(runs, group, fit);
        levels.row(count, cells, fit.law, fit.protocol, mu_s->unit, mu_s->mean, mu_s->standard_error_of_mean,
                   mu_k->mean, mu_k->standard_error_of_mean, drop.value, drop.std_error);
      }
    }
  }

  void write_runs(const ResultReader& results, std::span<const RunResult> runs) {
    CsvFile cycles = file("06-08-three-cycles.csv", "run", "time_s,v_r_mm_s,friction,unit", 0);
    CsvFile spectrum = file("07-spectrum.csv", "run", "frequency_hz,amplitude_mm_s");
    CsvFile harmonics = file("07-harmonics.csv", "run", "harmonic,frequency_hz,amplitude_mm_s");
    CsvFile bins = file("10-12-over-velocity.csv", "run",
                        "law,protocol,unit,v_r_from_mm_s,v_r_to_mm_s,samples,friction,fitted,"
                        "relative_error_of_mean,mean_relative_error,largest_relative_error");
    const std::string limit = published_error_limit_text;
    CsvFile errors = file("12-relative-error.csv", "run",
                          "law,protocol,samples,share_below_" + limit + ",share_of_bins_below_" + limit +
                              ",largest_of_bins,mean_relative_error,largest_relative_error");
    for (const RunResult& r : runs) {
      const auto kept = results.figures(r.position);
      if (!kept) continue;
      const RunFigures& f = *kept;
      const Json cells = conditions.of(r.run.conditions, r.run.others);
      const std::string& name = r.run.name;
      for (std::size_t k = 0; k < f.time.size(); ++k) {
        cycles.row(name, cells, f.time[k], f.velocity[k], f.friction[k], r.friction_unit);
      }
      for (std::size_t k = 0; k < f.spectrum.size(); ++k) {
        spectrum.row(name, cells, static_cast<double>(k) * f.spectrum_step, f.spectrum[k]);
      }
      for (std::size_t k = 0; k < f.harmonics.size(); ++k) {
        harmonics.row(name, cells, k + 1, f.harmonics[k].frequency, f.harmonics[k].amplitude);
      }
      for (const ErrorCurve& c : f.errors) {
        for (std::size_t k = 0; k < f.bin_samples.size(); ++k) {
          const double from = static_cast<double>(k) * f.bin_width;
          bins.row(name, cells, c.law, c.protocol, r.friction_unit, from, from + f.bin_width, f.bin_samples[k],
                   f.bin_friction[k], c.fitted[k], f.error_of_mean(c, k), c.bin_mean_relative[k],
                   c.bin_max_relative[k]);
        }
        errors.row(name, cells, c.law, c.protocol, f.slip_samples(), c.below_limit, c.bins_below_limit,
                   c.largest_of_bins, c.mean_relative, c.max_relative);
      }
    }
  }
};

}  // namespace

void write_figures(const ResultReader& results, std::span<const RunResult> runs, std::span<const PooledGroup> groups) {
  const std::string folder = (std::filesystem::path(results.folder()) / "figures").string();
  FigureFiles files{WholeFolder(folder), ConditionCells(runs)};
  remove_abandoned_files(folder);
  files.write_groups(runs, groups);
  files.write_runs(results, runs);
  files.folder.commit();
}

}  // namespace tribofit
