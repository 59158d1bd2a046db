#include "tribofit/report/csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <span>

#include "fit/assessment.hpp"
#include "numbers.hpp"
#include "output/csv_table.hpp"
#include "output/json.hpp"
#include "segmentation/counts.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/segmentation/strokes.hpp"

namespace tribofit {
namespace {

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
  const Motion& m = result.motion;
  const std::vector<bool> slips = slipping_samples(m, result.segmentation);
  const Strokes strokes = strokes_of(m, result.segmentation);
  const bool derived = !m.velocity_std_error.empty();  // velocity and friction were made from another channel
  std::string names = "time_s,relative_velocity_mm_s,mu,mu_model,phase,cycle,held_out_fold";
  if (derived) names += ",relative_velocity_std_error_mm_s,mu_std_error";
  if (strokes.known()) names += ",reversal_distance_mm";
  CsvFile file(folder, "samples.csv", names);
  for (std::size_t i = 0; i < m.size(); ++i) {
    file.add(time_cell(m, i), m.relative_velocity[i] / kMillimetre, m.friction[i],
             model.empty() ? std::nan("") : model[i], slips[i] ? "slip" : "stick", index_cell(member.cycle[i]),
             index_cell(member.fold[i]));
    if (derived) file.add(m.velocity_std_error[i] / kMillimetre, m.friction_std_error[i]);
    if (strokes.known()) file.add(strokes.distance[i] / kMillimetre);
    file.row();
  }
}

void write_cycles(WholeFolder& folder, const Identification& result, const Membership& member) {
  const bool force = friction_unit(result.motion) == "N";
  const std::string unit = force ? "_N" : "";
  const std::vector<Cycle>& cycles = result.segmentation.cycles;
  const auto row_of = [&](std::size_t k) {
    const Cycle c = k < cycles.size() ? cycles[k] : Cycle{};
    const bool held = c.slip.size() > 0 && c.slip.begin < member.fold.size();
    return object("cycle", k, "direction", c.direction, "break_away_time_s", c.break_away_time,
                  "break_away_time_std_error_s", c.break_away_time_std_error, "restick_time_s", c.restick_time,
                  "stick_time_s", c.stick_time, "slip_time_s", c.slip_time, "period_s", c.period,
                  "break_away_friction" + unit, c.break_away_friction, "break_away_friction_std_error" + unit,
                  c.break_away_friction_std_error, force ? "stick_slope_N_s" : "stick_slope_1_s", c.stick_slope,
                  "static_friction" + unit, c.stick_maximum, "kinetic_friction" + unit, c.slip_minimum,
                  "peak_velocity_mm_s", c.peak_velocity / kMillimetre, "plateau_velocity_mm_s",
                  c.plateau_velocity / kMillimetre, "stick_complete", c.stick_complete, "slip_complete",
                  c.slip_complete, "held_out_fold", index_cell(held ? member.fold[c.slip.begin] : Membership::none));
  };
  write_rows(folder, "cycles.csv", cycles.size(), row_of, kMeasuredDigits);
}

void write_curves(WholeFolder& folder, std::span<const Fit> fits) {
  constexpr std::size_t kPoints = 201;
  CsvFile file(folder, "curves.csv",
               "law,effects,protocol,relative_velocity_mm_s,mu,mu_lower95,mu_upper95,within_data");
  for (const Fit& fit : fits) {
    const std::string effects = fmt::format("{}", fmt::join(fit.model.effect_names(), "+"));
    const Curve curve = curve_of(fit, kPoints);
    for (std::size_t i = 0; i < curve.velocity.size(); ++i) {
      file.row(to_string(fit.model.law()), effects, to_string(fit.protocol), curve.velocity[i] / kMillimetre,
               curve.mu[i], curve.lower95[i], curve.upper95[i], curve.velocity[i] <= fit.fastest);
    }
  }
}

void write_errors(WholeFolder& folder, const Identification& result, const std::vector<double>& model,
                  const Membership& member) {
  const Motion& m = result.motion;
  CsvFile file(folder, "errors.csv",
               "time_s,relative_velocity_mm_s,residual_" + friction_unit(m) + ",relative_error_1,cycle,held_out_fold");
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (!std::isfinite(model[i])) continue;
    file.row(time_cell(m, i), m.relative_velocity[i] / kMillimetre, m.friction[i] - model[i],
             relative_error(m.friction[i], model[i]), index_cell(member.cycle[i]), index_cell(member.fold[i]));
  }
}

/// The files of one trace with the fit `best`; `record` traces with `before` cycles stand before it.
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

void write_response(WholeFolder& folder, const RateStateAnalysis& analysis) {
  CsvFile file(folder, "response.csv", "step_number,time_s,load_point_um,mu,mu_model,mu_other");
  for (const RateStateCurve& c : analysis.curves) {
    for (std::size_t i = 0; i < c.time.size(); ++i) {
      file.row(c.step + 1, c.time[i], c.displacement[i] / kMicrometre, c.friction[i], c.model[i],
               c.other.empty() ? std::nan("") : c.other[i]);
    }
  }
}

void write_steps(WholeFolder& folder, const RateStateAnalysis& analysis) {
  const RateStateFit* whole = analysis.fitted() ? &analysis.fits[analysis.best] : nullptr;
  const auto row_of = [&](std::size_t s) {
    const VelocityStep step = s < analysis.steps.size() ? analysis.steps[s] : VelocityStep{};
    Json row = object("step_number", s + 1, "time_s", step.time, "time_std_error_s", step.time_std_error,
                      "recorded_time_s", step.recorded, "from_um_s", step.before / kMicrometre, "to_um_s",
                      step.after / kMicrometre, "hold_s", step.hold);
    if (whole == nullptr) return row;
    const RateStateFit* own = analysis.each.empty()        ? (s == 0 ? whole : nullptr)
                              : analysis.each[s].converged ? &analysis.each[s]
                                                           : nullptr;
    for (std::size_t k = 0; k < whole->parameters.size(); ++k) {
      const Parameter& p = whole->parameters[k].parameter;
      const std::string unit = p.unit == "1" ? "" : p.unit == "um" ? "_um" : "_per_um";
      const auto cell = [&](double FitParameter::*value) {
        return own == nullptr ? std::nan("") : shown(own->parameters[k], own->parameters[k].*value);
      };
      add_members(row, p.name + unit, cell(&FitParameter::value), p.name + "_std_error" + unit,
                  cell(&FitParameter::std_error));
    }
    row["mu_0"] = number(whole->base_friction[s].value);
    return row;
  };
  write_rows(folder, "steps.csv", analysis.steps.size(), row_of, kMeasuredDigits);
}

}  // namespace

void write_csv_folder(const std::string& folder, const Identification& result) {
  WholeFolder files(folder);
  if (result.rate_state) {
    write_response(files, *result.rate_state);
    write_steps(files, *result.rate_state);
  } else {
    add_files(files, result, result.fits, result.best);
  }
  files.commit();
}

void write_csv_folder(const std::string& folder, const DiagnosedTraces& result) {
  WholeFolder outer(folder);
  std::set<std::string> names;
  std::vector<std::unique_ptr<WholeFolder>> folders;
  for (std::size_t k = 0, before = 0; k < result.traces.size(); ++k) {
    const Identification& trace = result.traces[k];
    const std::string stem = std::filesystem::path(trace.path).stem().string();
    std::string name = stem;
    for (int n = 2; !names.insert(name).second; ++n) name = fmt::format("{}-{}", stem, n);
    if (result.traces.size() > 1) folders.push_back(std::make_unique<WholeFolder>(folder + "/" + name));
    WholeFolder& own = folders.empty() ? outer : *folders.back();
    add_files(own, trace, result.fits, result.best, k, before);
    own.finish();  // closes its files
    before += evidence_of(trace.motion, trace.segmentation);
  }
  outer.commit();
  for (const auto& one : folders) one->commit();
}

}  // namespace tribofit
