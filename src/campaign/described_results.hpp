#pragma once

#include "condition_cells.hpp"
#include "output/described.hpp"
#include "segmentation/counts.hpp"
#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// The names under which results stand in files: report/json.cpp writes by them what ResultReader reads.

constexpr auto description(const Estimate*) {
  return described("value", &Estimate::value, "std_error", &Estimate::std_error, "ci95", [](const Estimate& estimate) {
    const Interval ci = estimate.interval95();
    return interval_json(ci.lower, ci.upper);
  });
}

constexpr auto description(const OtherCondition*) {
  return described("name", &OtherCondition::name, "value", &OtherCondition::value);
}

void read_json(const Json& json, RunStatus& status);

constexpr auto description(const RunRecord*) {
  using R = RunRecord;
  return described("name", &R::name, "file", &R::file, "key", &R::key, "settings", &R::settings, "status", &R::status,
                   "message", or_null(&R::message), "stated", &R::conditions, "repeat", &R::repeat, "others",
                   &R::others);
}

constexpr auto description(const ResultParameter*) {
  using P = ResultParameter;
  return described("name", &P::name, "value", &P::value, "std_error", &P::std_error, "ci95",
                   ends(&P::lower95, &P::upper95), "unit", &P::unit, "effect", or_null(&P::effect), "systematic_error",
                   or_null(&P::systematic), "profile_ci95", ends(&P::profile_lower95, &P::profile_upper95), "start",
                   &P::start, "bounds", ends(&P::lower, &P::upper), "at_bound", &P::at_bound, "determined",
                   &P::determined);
}

constexpr auto description(const ResultFit::Correlated*) {
  return described("parameters", &ResultFit::Correlated::parameters, "value", &ResultFit::Correlated::value);
}

/// What a fit leaves; see ErrorFigures.
inline constexpr auto error_members =
    described("rmse", &ResultFit::rmse, "mean_relative", &ResultFit::mean_relative, "max_relative",
              &ResultFit::max_relative, "held_out_rmse", &ResultFit::held_out_rmse);

constexpr auto description(const ResultFit*) {
  using F = ResultFit;
  return described(
      "law", &F::law, "protocol", &F::protocol, "effects", &F::effects, "effect_names", &F::effect_names, "parameters",
      &F::parameters, "error", error_members, "floor_rmse", &F::floor_rmse, "converged", &F::converged, "conditional",
      &F::conditional, "messages", &F::messages, "floor",
      described("noise", &F::noise, "scatter", &F::scatter, "slow_noise", &F::slow_noise, "source", &F::floor_source),
      "explained", &F::explained, "stick_creep_rmse_mm_s", in(kMillimetre, &F::stick_creep), "fastest_mm_s",
      in(kMillimetre, &F::fastest), "samples", &F::samples, "cycles", &F::cycles, "correlations", &F::correlations,
      "covariance", &F::covariance, "degrees_of_freedom", &F::degrees_of_freedom);
}

inline constexpr auto trace_members =
    described("path", &RunResult::path, "samples", &RunResult::samples, "duration_s", &RunResult::duration, "rate_hz",
              &RunResult::rate, "checksum", &RunResult::checksum, "friction_unit", &RunResult::friction_unit);

inline constexpr auto stick_slip_members =
    described("cycles", &RunResult::cycles, "frequency_hz", &RunResult::frequency, "amplitude_mm_s",
              within(&RunResult::amplitude, &Estimate::value), "rms_velocity_mm_s", &RunResult::rms_velocity,
              "stick_time_s", within(&RunResult::stick_time, &Estimate::value), "amplitude_std_error_mm_s",
              within(&RunResult::amplitude, &Estimate::std_error), "stick_time_std_error_s",
              within(&RunResult::stick_time, &Estimate::std_error), "slip_time_s",
              within(&RunResult::slip_time, &Estimate::value), "slip_time_std_error_s",
              within(&RunResult::slip_time, &Estimate::std_error));

constexpr auto description(const RunResult*) {
  using R = RunResult;
  return described("run", &R::run, "trace", trace_members, "conditions", &R::conditions, "stick_slip",
                   stick_slip_members, "fits", &R::fits, "best", or_null(&R::best), "warnings", &R::warnings);
}

constexpr auto description(const PlannedRun*) {
  return described("name", &PlannedRun::name, "file", &PlannedRun::file, "settings", &PlannedRun::settings);
}

constexpr auto description(const CampaignPlan*) {
  return described("folder", or_null(&CampaignPlan::folder), "runs", &CampaignPlan::runs, "problems",
                   &CampaignPlan::problems);
}

}  // namespace tribofit
