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
  std::vector<CsvColumn<std::size_t>> columns = {
      {"time_s", [&](std::size_t i) { return time_cell(m, i); }},
      {"relative_velocity_mm_s", [&](std::size_t i) { return m.relative_velocity[i] / kMillimetre; }},
      {"mu", [&](std::size_t i) { return m.friction[i]; }},
      {"mu_model", [&](std::size_t i) { return model.empty() ? std::nan("") : model[i]; }},
      {"phase", [&](std::size_t i) { return slips[i] ? "slip" : "stick"; }},
      {"cycle", [&](std::size_t i) { return index_cell(member.cycle[i]); }},
      {"held_out_fold", [&](std::size_t i) { return index_cell(member.fold[i]); }},
  };
  if (!m.velocity_std_error.empty()) {  // velocity and friction were made from another channel
    columns.emplace_back("relative_velocity_std_error_mm_s",
                         [&](std::size_t i) { return m.velocity_std_error[i] / kMillimetre; });
    columns.emplace_back("mu_std_error", [&](std::size_t i) { return m.friction_std_error[i]; });
  }
  const Strokes strokes = strokes_of(m, result.segmentation);
  if (strokes.known()) {
    columns.emplace_back("reversal_distance_mm", [&](std::size_t i) { return strokes.distance[i] / kMillimetre; });
  }
  CsvTable table(folder, "samples.csv", std::move(columns), kMeasuredDigits);
  for (std::size_t i = 0; i < m.size(); ++i) table.row(i);
}

void write_cycles(WholeFolder& folder, const Identification& result, const Membership& member) {
  const bool force = friction_unit(result.motion) == "N";
  const std::string unit = force ? "_N" : "";
  const std::vector<Cycle>& cycles = result.segmentation.cycles;
  std::vector<CsvColumn<Cycle>> columns = {
      {"cycle", [&](const Cycle& c) { return static_cast<std::size_t>(&c - cycles.data()); }},
      {"direction", &Cycle::direction},
      {"break_away_time_s", &Cycle::break_away_time},
      {"break_away_time_std_error_s", &Cycle::break_away_time_std_error},
      {"restick_time_s", &Cycle::restick_time},
      {"stick_time_s", &Cycle::stick_time},
      {"slip_time_s", &Cycle::slip_time},
      {"period_s", &Cycle::period},
      {"break_away_friction" + unit, &Cycle::break_away_friction},
      {"break_away_friction_std_error" + unit, &Cycle::break_away_friction_std_error},
      {force ? "stick_slope_N_s" : "stick_slope_1_s", &Cycle::stick_slope},
      {"static_friction" + unit, &Cycle::stick_maximum},
      {"kinetic_friction" + unit, &Cycle::slip_minimum},
      {"peak_velocity_mm_s", [](const Cycle& c) { return c.peak_velocity / kMillimetre; }},
      {"plateau_velocity_mm_s", [](const Cycle& c) { return c.plateau_velocity / kMillimetre; }},
      {"stick_complete", &Cycle::stick_complete},
      {"slip_complete", &Cycle::slip_complete},
      {"held_out_fold",
       [&](const Cycle& c) {
         const bool held = c.slip.size() > 0 && c.slip.begin < member.fold.size();
         return index_cell(held ? member.fold[c.slip.begin] : Membership::none);
       }},
  };
  CsvTable table(folder, "cycles.csv", std::move(columns), kMeasuredDigits);
  for (const Cycle& cycle : cycles) table.row(cycle);
}

struct CurvePoint {
  const Fit& fit;
  const std::string& effects;
  const Curve& curve;
  std::size_t i;
};

void write_curves(WholeFolder& folder, std::span<const Fit> fits) {
  constexpr std::size_t kPoints = 201;
  using P = CurvePoint;
  std::vector<CsvColumn<P>> columns = {
      {"law", [](const P& p) { return to_string(p.fit.model.law()); }},
      {"effects", [](const P& p) { return p.effects; }},
      {"protocol", [](const P& p) { return to_string(p.fit.protocol); }},
      {"relative_velocity_mm_s", [](const P& p) { return p.curve.velocity[p.i] / kMillimetre; }},
      {"mu", [](const P& p) { return p.curve.mu[p.i]; }},
      {"mu_lower95", [](const P& p) { return p.curve.lower95[p.i]; }},
      {"mu_upper95", [](const P& p) { return p.curve.upper95[p.i]; }},
      {"within_data", [](const P& p) { return p.curve.velocity[p.i] <= p.fit.fastest; }},
  };
  CsvTable table(folder, "curves.csv", std::move(columns), kMeasuredDigits);
  for (const Fit& fit : fits) {
    const std::string effects = fmt::format("{}", fmt::join(fit.model.effect_names(), "+"));
    const Curve curve = curve_of(fit, kPoints);
    for (std::size_t i = 0; i < curve.velocity.size(); ++i) table.row({fit, effects, curve, i});
  }
}

void write_errors(WholeFolder& folder, const Identification& result, const std::vector<double>& model,
                  const Membership& member) {
  const Motion& m = result.motion;
  std::vector<CsvColumn<std::size_t>> columns = {
      {"time_s", [&](std::size_t i) { return time_cell(m, i); }},
      {"relative_velocity_mm_s", [&](std::size_t i) { return m.relative_velocity[i] / kMillimetre; }},
      {"residual_" + friction_unit(m), [&](std::size_t i) { return m.friction[i] - model[i]; }},
      {"relative_error_1", [&](std::size_t i) { return relative_error(m.friction[i], model[i]); }},
      {"cycle", [&](std::size_t i) { return index_cell(member.cycle[i]); }},
      {"held_out_fold", [&](std::size_t i) { return index_cell(member.fold[i]); }},
  };
  CsvTable table(folder, "errors.csv", std::move(columns), kMeasuredDigits);
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (std::isfinite(model[i])) table.row(i);
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

constexpr double kMicron = 1e-6;

void write_response(WholeFolder& folder, const RateStateAnalysis& analysis) {
  struct Value {
    const RateStateCurve& curve;
    std::size_t i;
  };
  std::vector<CsvColumn<Value>> columns = {
      {"step_number", [](const Value& v) { return v.curve.step + 1; }},
      {"time_s", [](const Value& v) { return v.curve.time[v.i]; }},
      {"load_point_um", [](const Value& v) { return v.curve.displacement[v.i] / kMicron; }},
      {"mu", [](const Value& v) { return v.curve.friction[v.i]; }},
      {"mu_model", [](const Value& v) { return v.curve.model[v.i]; }},
      {"mu_other", [](const Value& v) { return v.curve.other.empty() ? std::nan("") : v.curve.other[v.i]; }},
  };
  CsvTable table(folder, "response.csv", std::move(columns), kMeasuredDigits);
  for (const RateStateCurve& curve : analysis.curves) {
    for (std::size_t i = 0; i < curve.time.size(); ++i) table.row({curve, i});
  }
}

void write_steps(WholeFolder& folder, const RateStateAnalysis& analysis) {
  std::vector<CsvColumn<std::size_t>> columns = {
      {"step_number", [](std::size_t s) { return s + 1; }},
      {"time_s", [&](std::size_t s) { return analysis.steps[s].time; }},
      {"time_std_error_s", [&](std::size_t s) { return analysis.steps[s].time_std_error; }},
      {"recorded_time_s", [&](std::size_t s) { return analysis.steps[s].recorded; }},
      {"from_um_s", [&](std::size_t s) { return analysis.steps[s].before / kMicron; }},
      {"to_um_s", [&](std::size_t s) { return analysis.steps[s].after / kMicron; }},
      {"hold_s", [&](std::size_t s) { return analysis.steps[s].hold; }},
  };
  const auto own = [&](std::size_t s) -> const RateStateFit* {
    if (analysis.each.empty()) return s == 0 && analysis.fitted() ? &analysis.fits[analysis.best] : nullptr;
    return analysis.each[s].converged ? &analysis.each[s] : nullptr;
  };
  if (analysis.fitted()) {
    const std::vector<FitParameter>& parameters = analysis.fits[analysis.best].parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const Parameter& p = parameters[k].parameter;
      const std::string unit = p.unit == "1" ? "" : p.unit == "um" ? "_um" : "_per_um";
      const auto cell = [own, k](std::size_t s, double FitParameter::*value) {
        const RateStateFit* fit = own(s);
        return fit == nullptr ? std::nan("") : shown(fit->parameters[k], fit->parameters[k].*value);
      };
      columns.emplace_back(p.name + unit, [cell](std::size_t s) { return cell(s, &FitParameter::value); });
      columns.emplace_back(p.name + "_std_error" + unit,
                           [cell](std::size_t s) { return cell(s, &FitParameter::std_error); });
    }
    columns.emplace_back("mu_0", [&](std::size_t s) { return analysis.fits[analysis.best].base_friction[s].value; });
  }
  CsvTable table(folder, "steps.csv", std::move(columns), kMeasuredDigits);
  for (std::size_t s = 0; s < analysis.steps.size(); ++s) table.row(s);
}

}  // namespace

void write_csv_folder(const std::string& folder, const Identification& result) {
  WholeFolder files(folder);
  if (result.rate_state) {
    write_response(files, *result.rate_state);
    write_steps(files, *result.rate_state);
    files.commit();
    return;
  }
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
