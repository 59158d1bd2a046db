#include "tribofit/report/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <span>

#include "campaign/csv_table.hpp"
#include "fit/assessment.hpp"
#include "numbers.hpp"
#include "segmentation/counts.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/ingest/output_tables.hpp"

namespace tribofit {
namespace {

/// One of the tables, whose header goes on with `more`.
CsvTable table_in(WholeFolder& folder, const std::string& name, const std::string& more = "") {
  constexpr int kDigits = 10;
  const auto known = std::find_if(output_tables.begin(), output_tables.end(),
                                  [&](const OutputTable& table) { return table.name == name; });
  return {folder, name, std::string(known->header) + more, kDigits};
}

/// An index as a cell, empty where there is none.
double index_cell(std::size_t index) {
  return index == Membership::none ? std::nan("") : static_cast<double>(index);
}

/// Points have no time.
double time_cell(const Motion& motion, std::size_t i) {
  return motion.is_points() ? std::nan("") : motion.time[i];
}

void write_samples(WholeFolder& folder, const Identification& result, const std::vector<double>& model,
                   const Membership& member) {
  const Motion& motion = result.motion;
  const std::vector<bool> slips = slipping_samples(motion, result.segmentation);
  // Of a record whose velocity and friction were made from another channel.
  const bool with_errors = !motion.velocity_std_error.empty();
  CsvTable table = table_in(folder, "samples.csv", with_errors ? ",relative_velocity_std_error_mm_s,mu_std_error" : "");
  auto errors = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (with_errors) errors = {motion.velocity_std_error[i] / kMillimetre, motion.friction_std_error[i]};
    table.row(time_cell(motion, i), motion.relative_velocity[i] / kMillimetre, motion.friction[i],
              model.empty() ? std::nan("") : model[i], slips[i] ? "slip" : "stick", index_cell(member.cycle[i]),
              index_cell(member.fold[i]), errors);
  }
}

void write_cycles(WholeFolder& folder, const Identification& result, const Membership& member) {
  const bool force = friction_unit(result.motion) == "N";
  CsvTable table = table_in(
      folder, "cycles.csv",
      fmt::format("stick_time_s,slip_time_s,period_s,break_away_friction{0},break_away_friction_std_error{0},stick_"
                  "slope{1},static_friction{0},kinetic_friction{0},"
                  "peak_velocity_mm_s,plateau_velocity_mm_s,stick_complete,slip_complete,held_out_fold",
                  force ? "_N" : "", force ? "_N_s" : "_1_s"));
  const std::vector<Cycle>& cycles = result.segmentation.cycles;
  for (std::size_t k = 0; k < cycles.size(); ++k) {
    const Cycle& c = cycles[k];
    const bool held = c.slip.size() > 0 && c.slip.begin < member.fold.size();
    table.row(k, c.direction, c.break_away_time, c.break_away_time_std_error, c.restick_time, c.stick_time, c.slip_time,
              c.period, c.break_away_friction, c.break_away_friction_std_error, c.stick_slope, c.stick_maximum,
              c.slip_minimum, c.peak_velocity / kMillimetre, c.plateau_velocity / kMillimetre, c.stick_complete,
              c.slip_complete, index_cell(held ? member.fold[c.slip.begin] : Membership::none));
  }
}

void write_curves(WholeFolder& folder, std::span<const Fit> fits) {
  constexpr std::size_t kPoints = 201;
  CsvTable table = table_in(folder, "curves.csv");
  for (const Fit& fit : fits) {
    const std::string effects = fmt::format("{}", fmt::join(fit.model.effect_names(), "+"));
    const Curve curve = curve_of(fit, kPoints);
    for (std::size_t i = 0; i < curve.velocity.size(); ++i) {
      table.row(to_string(fit.model.law()), effects, to_string(fit.protocol), curve.velocity[i] / kMillimetre,
                curve.mu[i], curve.lower95[i], curve.upper95[i], curve.velocity[i] <= fit.fastest);
    }
  }
}

void write_errors(WholeFolder& folder, const Identification& result, const std::vector<double>& model,
                  const Membership& member) {
  const Motion& motion = result.motion;
  CsvTable table = table_in(folder, "errors.csv", friction_unit(motion) + ",relative_error_1,cycle,held_out_fold");
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (!std::isfinite(model[i])) continue;
    table.row(time_cell(motion, i), motion.relative_velocity[i] / kMillimetre, motion.friction[i] - model[i],
              relative_error(motion.friction[i], model[i]), index_cell(member.cycle[i]), index_cell(member.fold[i]));
  }
}

/// Adds the files of one trace; `best` is the index of the fit they show, which is of `record` traces, and `before`
/// cycles, before this one.
void add_files(WholeFolder& files, const Identification& trace, std::span<const Fit> fits, std::size_t best,
               std::size_t record = 0, std::size_t before = 0) {
  const Fit* shown = fits.empty() ? nullptr : &fits[best];
  const Membership member = membership(trace.motion, trace.segmentation, shown, before);
  std::vector<double> model;
  if (shown != nullptr) model = predict(*shown, trace.motion, trace.segmentation, record);
  write_samples(files, trace, model, member);
  write_cycles(files, trace, member);
  write_curves(files, fits);
  write_errors(files, trace, model, member);
}

}  // namespace

void write_csv_folder(const std::string& folder, const Identification& result) {
  WholeFolder files(folder);
  add_files(files, result, result.fits, result.best);
  files.commit();
}

void write_csv_folder(const std::string& folder, const DiagnosedTraces& result) {
  WholeFolder outer(folder);
  if (result.traces.size() == 1) {
    add_files(outer, result.traces.front(), result.fits, result.best);
    outer.commit();
    return;
  }
  std::set<std::string> names;
  std::vector<std::unique_ptr<WholeFolder>> folders;
  std::size_t before = 0;
  for (const Identification& trace : result.traces) {
    const std::string stem = std::filesystem::path(trace.path).stem().string();
    std::string name = stem;
    for (int n = 2; !names.insert(name).second; ++n) name = fmt::format("{}-{}", stem, n);
    folders.push_back(std::make_unique<WholeFolder>(folder + "/" + name));
    add_files(*folders.back(), trace, result.fits, result.best, folders.size() - 1, before);
    folders.back()->finish();  // closes its files
    before += evidence_of(trace.motion, trace.segmentation);
  }
  for (const auto& one : folders) one->commit();
}

}  // namespace tribofit
