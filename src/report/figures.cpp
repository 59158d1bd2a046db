#include "tribofit/report/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/whole_folder.hpp"
#include "condition_cells.hpp"
#include "tribofit/campaign/group_values.hpp"

namespace tribofit {
namespace {

/// A file that begins with a header.
WholeFile& add_file(WholeFolder& folder, const std::string& name, const std::string& header) {
  WholeFile& file = folder.add(name);
  file.write(header + "\n");
  return file;
}

void write_line(WholeFile& file, const std::string& front, std::initializer_list<double> values) {
  std::string line = front;
  for (const double value : values) line += std::isfinite(value) ? fmt::format(",{:.10g}", value) : ",";
  file.write(line + "\n");
}

void write_groups(WholeFolder& files, const ConditionCells& conditions, std::span<const RunResult> runs,
                  std::span<const PooledGroup> groups) {
  WholeFile& rms = add_file(files, "05-rms-velocity.csv",
                            "runs," + conditions.header() + ",rms_velocity_mm_s,rms_velocity_std_error_mm_s");
  WholeFile& levels = add_file(files, "09-static-kinetic.csv",
                               "runs," + conditions.header() +
                                   ",law,protocol,unit,mu_s,mu_s_std_error,mu_k,mu_k_std_error,"
                                   "mu_s_minus_mu_k,mu_s_minus_mu_k_std_error");
  for (const PooledGroup& group : groups) {
    const std::string front = std::to_string(group.runs.size()) + "," + conditions.of(group.conditions, group.others);
    if (const PooledValue* v = pooled_value(group.measures, "rms_velocity"))
      write_line(rms, front, {v->mean, v->standard_error_of_mean});
    for (const PooledGroup::OfFit& fit : group.fits) {
      const PooledValue *mu_s = pooled_value(fit.parameters, "mu_s"), *mu_k = pooled_value(fit.parameters, "mu_k");
      if (mu_s == nullptr || mu_k == nullptr) continue;
      const ResultMeasure drop = drop_of(runs, group, fit);
      write_line(levels, front + "," + fit.law + "," + fit.protocol + "," + mu_s->unit,
                 {mu_s->mean, mu_s->standard_error_of_mean, mu_k->mean, mu_k->standard_error_of_mean, drop.value,
                  drop.std_error});
    }
  }
}

/// The files with rows of single runs.
class RunFiles {
 public:
  RunFiles(WholeFolder& files, const std::string& conditions)
      : cycles_(add_file(files, "06-08-three-cycles.csv", "run," + conditions + ",time_s,v_r_mm_s,friction,unit")),
        spectrum_(add_file(files, "07-spectrum.csv", "run," + conditions + ",frequency_hz,amplitude_mm_s")),
        harmonics_(add_file(files, "07-harmonics.csv", "run," + conditions + ",harmonic,frequency_hz,amplitude_mm_s")),
        bins_(add_file(files, "10-12-over-velocity.csv",
                       "run," + conditions +
                           ",law,protocol,unit,v_r_from_mm_s,v_r_to_mm_s,samples,friction,fitted,"
                           "relative_error_of_mean,mean_relative_error,largest_relative_error")),
        errors_(add_file(files, "12-relative-error.csv",
                         "run," + conditions +
                             ",law,protocol,samples,share_below_0.08,share_of_bins_below_0.08,largest_of_bins,"
                             "mean_relative_error,largest_relative_error")) {}

  void write(const RunFigures& f, const std::string& front, const std::string& unit) {
    for (std::size_t k = 0; k < f.time.size(); ++k) {
      cycles_.write(front + "," + cell(f.time[k]) + "," + cell(f.velocity[k]) + "," + cell(f.friction[k]) + "," + unit +
                    "\n");
    }
    for (std::size_t k = 0; k < f.spectrum.size(); ++k) {
      write_line(spectrum_, front, {static_cast<double>(k) * f.spectrum_step, f.spectrum[k]});
    }
    for (std::size_t k = 0; k < f.harmonics.size(); ++k) {
      write_line(harmonics_, front, {static_cast<double>(k + 1), f.harmonics[k].frequency, f.harmonics[k].amplitude});
    }
    for (const ErrorCurve& curve : f.errors)
      write_curve(f, curve, front + "," + curve.law + "," + curve.protocol, unit);
  }

 private:
  void write_curve(const RunFigures& f, const ErrorCurve& curve, const std::string& front, const std::string& unit) {
    double samples = 0;
    for (std::size_t k = 0; k < f.bin_samples.size(); ++k) {
      const double from = static_cast<double>(k) * f.bin_width, in_bin = static_cast<double>(f.bin_samples[k]);
      samples += in_bin;
      const double of_mean = std::abs((f.bin_friction[k] - curve.fitted[k]) / f.bin_friction[k]);
      write_line(bins_, front + "," + unit,
                 {from, from + f.bin_width, in_bin, f.bin_friction[k], curve.fitted[k], of_mean,
                  curve.bin_mean_relative[k], curve.bin_max_relative[k]});
    }
    write_line(errors_, front,
               {samples, curve.below_limit, curve.bins_below_limit, curve.largest_of_bins, curve.mean_relative,
                curve.max_relative});
  }

  WholeFile &cycles_, &spectrum_, &harmonics_, &bins_, &errors_;
};

}  // namespace

void write_figures(const ResultReader& results, std::span<const RunResult> runs, std::span<const PooledGroup> groups) {
  const std::string folder = (std::filesystem::path(results.folder()) / "figures").string();
  WholeFolder files(folder);
  remove_abandoned_files(folder);
  const ConditionCells conditions(runs);
  write_groups(files, conditions, runs, groups);
  RunFiles of_runs(files, conditions.header());
  for (const RunResult& run : runs) {
    const auto figures = results.figures(run.position);
    if (!figures) continue;
    of_runs.write(*figures, cell(run.run.name) + "," + conditions.of(run.conditions, run.run.others),
                  run.friction_unit);
  }
  files.commit();
}

}  // namespace tribofit
