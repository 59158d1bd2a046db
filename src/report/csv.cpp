#include "tribofit/report/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <utility>

#include "campaign/whole_folder.hpp"
#include "fit/assessment.hpp"
#include "numbers.hpp"
#include "tribofit/campaign/whole_file.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/output_tables.hpp"

namespace tribofit {
namespace {

/// How the header of one of the tables begins.
std::string_view header_of(std::string_view name) {
  return std::find_if(output_tables.begin(), output_tables.end(), [&](const OutputTable& f) { return f.name == name; })
      ->header;
}

/// One line of a CSV file, cell by cell. What is not known is an empty cell.
class Row {
 public:
  explicit Row(WholeFile& file) : file_(file) {}
  Row& operator<<(double value) {
    separate();
    if (std::isfinite(value)) fmt::format_to(std::back_inserter(line_), "{:.10g}", value);
    return *this;
  }
  Row& operator<<(std::string_view text) {
    separate();
    line_.append(text);
    return *this;
  }
  Row& count(std::size_t value) {
    separate();
    if (value != Membership::none) fmt::format_to(std::back_inserter(line_), "{}", value);
    return *this;
  }
  void end() {
    line_.push_back('\n');
    file_.write({line_.data(), line_.size()});
    line_.clear();
    first_ = true;
  }

 private:
  void separate() {
    if (!first_) line_.push_back(',');
    first_ = false;
  }

  WholeFile& file_;
  bool first_ = true;
  fmt::memory_buffer line_;
};

void write_samples(WholeFile& file, const Identification& result, const std::vector<double>& model,
                   const Membership& member) {
  const Motion& motion = result.motion;
  std::vector<bool> slips(motion.size(), false);
  for (const Cycle& cycle : result.segmentation.cycles) {
    for (std::size_t i = cycle.slip.begin; i < std::min(cycle.slip.end, motion.size()); ++i) slips[i] = true;
  }
  file.write(std::string(header_of("samples.csv")) + "\n");
  Row row(file);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const double v = motion.relative_velocity[i];
    // Before the first and after the last cycle only the speed shows it.
    const bool outside = member.cycle[i] == Membership::none;
    const bool slip = outside ? std::abs(v) > result.segmentation.slip_threshold : slips[i];
    row << motion.time[i] << v / kMillimetre << motion.friction[i] << (model.empty() ? std::nan("") : model[i])
        << (slip ? "slip" : "stick");
    row.count(member.cycle[i]).count(member.fold[i]).end();
  }
}

void write_cycles(WholeFile& file, const Identification& result, const Membership& member) {
  const std::string unit = friction_unit(result.motion) == "N" ? "_N" : "";
  const std::string slope = unit.empty() ? "_1_s" : "_N_s";
  file.write(std::string(header_of("cycles.csv")));
  file.write(
      fmt::format("stick_time_s,slip_time_s,period_s,break_away_friction{0},break_away_friction_std_error{0},stick_"
                  "slope{1},static_friction{0},kinetic_friction{0},"
                  "peak_velocity_mm_s,plateau_velocity_mm_s,stick_complete,slip_complete,held_out_fold\n",
                  unit, slope));
  Row row(file);
  const std::vector<Cycle>& cycles = result.segmentation.cycles;
  for (std::size_t k = 0; k < cycles.size(); ++k) {
    const Cycle& c = cycles[k];
    row.count(k) << static_cast<double>(c.direction) << c.break_away_time << c.break_away_time_std_error
                 << c.restick_time << c.stick_time << c.slip_time << c.period << c.break_away_friction
                 << c.break_away_friction_std_error << c.stick_slope << c.stick_maximum << c.slip_minimum
                 << c.peak_velocity / kMillimetre << c.plateau_velocity / kMillimetre << (c.stick_complete ? "1" : "0")
                 << (c.slip_complete ? "1" : "0");
    row.count(c.slip.size() > 0 && c.slip.begin < member.fold.size() ? member.fold[c.slip.begin] : Membership::none)
        .end();
  }
}

void write_curves(WholeFile& file, std::span<const Fit> fits) {
  constexpr std::size_t kPoints = 201;
  file.write(std::string(header_of("curves.csv")) + "\n");
  Row row(file);
  for (const Fit& fit : fits) {
    std::string effects;
    for (const std::string& name : fit.model.effect_names()) effects += (effects.empty() ? "" : "+") + name;
    const Curve curve = curve_of(fit, kPoints);
    for (std::size_t i = 0; i < curve.velocity.size(); ++i) {
      row << to_string(fit.model.law()) << effects << to_string(fit.protocol) << curve.velocity[i] / kMillimetre
          << curve.mu[i] << curve.lower95[i] << curve.upper95[i] << (curve.velocity[i] <= fit.fastest ? "1" : "0");
      row.end();
    }
  }
}

void write_errors(WholeFile& file, const Identification& result, const std::vector<double>& model,
                  const Membership& member) {
  const Motion& motion = result.motion;
  file.write(std::string(header_of("errors.csv")) +
             fmt::format("{},relative_error_1,cycle,held_out_fold\n", friction_unit(motion)));
  Row row(file);
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (!std::isfinite(model[i])) continue;
    const double residual = motion.friction[i] - model[i];
    row << motion.time[i] << motion.relative_velocity[i] / kMillimetre << residual
        << std::abs(residual / motion.friction[i]);
    row.count(member.cycle[i]).count(member.fold[i]).end();
  }
}

/// Adds the files of one trace; `best` is the fit they show, `before` the cycles of the traces it holds before this
/// one.
void add_files(WholeFolder& files, const Identification& trace, std::span<const Fit> fits, const Fit* best,
               std::size_t before) {
  const Membership member = membership(trace.motion, trace.segmentation, best, before);
  std::vector<double> model;
  if (best != nullptr) model = predict(*best, trace.motion, trace.segmentation);
  write_samples(files.add("samples.csv"), trace, model, member);
  write_cycles(files.add("cycles.csv"), trace, member);
  write_curves(files.add("curves.csv"), fits);
  write_errors(files.add("errors.csv"), trace, model, member);
}

const Fit* best_of(std::span<const Fit> fits, std::size_t best) {
  return fits.empty() ? nullptr : &fits[best];
}

/// A name for each trace: that of its file without ending, numbered where several share it.
std::vector<std::string> folder_names(const std::vector<Identification>& traces) {
  std::vector<std::string> names;
  for (const Identification& trace : traces) {
    const std::string stem = std::filesystem::path(trace.path).stem().string();
    std::string name = stem;
    for (int n = 2; std::find(names.begin(), names.end(), name) != names.end(); ++n)
      name = fmt::format("{}-{}", stem, n);
    names.push_back(name);
  }
  return names;
}

}  // namespace

void write_csv_folder(const std::string& folder, const Identification& result) {
  WholeFolder files(folder);
  add_files(files, result, result.fits, best_of(result.fits, result.best), 0);
  files.commit();
}

void write_csv_folder(const std::string& folder, const DiagnosedTraces& result) {
  const Fit* best = best_of(result.fits, result.best);
  WholeFolder outer(folder);
  if (result.traces.size() == 1) {
    add_files(outer, result.traces.front(), result.fits, best, 0);
    outer.commit();
    return;
  }
  const std::vector<std::string> names = folder_names(result.traces);
  std::vector<std::unique_ptr<WholeFolder>> folders;
  std::size_t before = 0;
  for (std::size_t k = 0; k < result.traces.size(); ++k) {
    folders.push_back(std::make_unique<WholeFolder>(folder + "/" + names[k]));
    add_files(*folders.back(), result.traces[k], result.fits, best, before);
    folders.back()->finish();  // closes its files
    before += evidence_of(result.traces[k].motion, result.traces[k].segmentation);
  }
  for (const auto& one : folders) one->commit();
}

}  // namespace tribofit
