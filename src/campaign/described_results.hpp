#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conditions.hpp"
#include "output/csv_table.hpp"
#include "output/described.hpp"
#include "segmentation/counts.hpp"
#include "tribofit/campaign/pool.hpp"

namespace tribofit {

/// The object in a file that sealed() made (run_result.hpp); nothing where it is missing, damaged or no object.
std::optional<Json> read_sealed(const std::string& path);

/// "radius_source".
inline std::string source_key(const ConditionInfo& info) {
  return std::string(info.name) + "_source";
}

/// {"radius_mm", "speed_rpm", "load_N"}, null where not known.
inline Json condition_values(const Conditions& conditions) {
  Json values = Json::object();
  for (const ConditionInfo& info : condition_infos) {
    values[info.column] = number((conditions.*info.member).value / info.si);
  }
  return values;
}

/// The same with "radius_source", ..., null where nothing said it.
inline Json json_of(const Conditions& conditions) {
  Json json = condition_values(conditions);
  for (const ConditionInfo& info : condition_infos) {
    json[source_key(info)] = text_or_null((conditions.*info.member).source);
  }
  return json;
}
inline void read_json(const Json& json, Conditions& conditions) {
  for (const ConditionInfo& info : condition_infos) {
    Condition& one = conditions.*info.member;
    const Json value = json.value(info.column, Json()), source = json.value(source_key(info), Json());
    one.value = value.is_number() ? value.get<double>() * info.si : std::nan("");
    one.source = source.is_string() ? source.get<std::string>() : "";
  }
}

/// The columns of conditions in tables of a campaign: radius_mm, speed_rpm, load_N and those that any run states.
class ConditionCells {
 public:
  explicit ConditionCells(std::span<const RunResult> runs) {
    for (const RunResult& run : runs) add_names(run.run.others, names_);
  }
  explicit ConditionCells(std::span<const PooledGroup> groups) {
    for (const PooledGroup& group : groups) add_names(group.others, names_);
  }

  std::string header() const {
    const std::string line = csv_line(Json(names_));
    return csv_names(condition_values({})) + (names_.empty() ? "" : "," + line.substr(0, line.size() - 1));
  }
  /// The cells of a row, as a list.
  Json of(const Conditions& conditions, const std::vector<OtherCondition>& others) const {
    Json row = {condition_values(conditions)};
    for (const std::string& name : names_) row.push_back(text_or_null(value_of(others, name)));
    return row;
  }

 private:
  std::vector<std::string> names_;
};

/// The names under which results stand in files: report/json.cpp writes by them what ResultReader reads.

constexpr auto description(const Estimate*) {
  return described("value", &Estimate::value, "std_error", &Estimate::std_error, "ci95", [](const Estimate& estimate) {
    const Interval ci = estimate.interval95();
    return interval_json(ci.lower, ci.upper);
  });
}

TRIBOFIT_DESCRIBED(OtherCondition, name, value);

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
                   or_null(&P::systematic), "profile_ci95", ends(&P::profile_lower95, &P::profile_upper95), "range",
                   ends(&P::range_lower, &P::range_upper), "start", &P::start, "bounds", ends(&P::lower, &P::upper),
                   "at_bound", &P::at_bound, "determined", &P::determined);
}

TRIBOFIT_DESCRIBED(ResultFit::Correlated, parameters, value);
TRIBOFIT_DESCRIBED(ErrorFigures, rmse, mean_relative, max_relative, held_out_rmse);
TRIBOFIT_DESCRIBED(Floor, noise, scatter, level_scatter, slow_noise, source);

constexpr auto description(const ResultFit*) {
  using F = ResultFit;
  return described("law", &F::law, "protocol", &F::protocol, "effects", &F::effects, "effect_names", &F::effect_names,
                   "parameters", &F::parameters, "error", &F::error, "floor_rmse", within(&F::floor, &Floor::rmse),
                   "converged", &F::converged, "conditional", &F::conditional, "messages", &F::messages, "floor",
                   &F::floor, "explained", &F::explained, "stick_creep_rmse_mm_s", in(kMillimetre, &F::stick_rmse),
                   "fastest_mm_s", in(kMillimetre, &F::fastest), "samples", &F::samples, "cycles", &F::cycles,
                   "correlations", &F::correlations, "covariance", &F::covariance, "degrees_of_freedom",
                   &F::degrees_of_freedom);
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

TRIBOFIT_DESCRIBED(PlannedRun, name, file, settings);

constexpr auto description(const CampaignPlan*) {
  return described("folder", or_null(&CampaignPlan::folder), "runs", &CampaignPlan::runs, "problems",
                   &CampaignPlan::problems);
}

}  // namespace tribofit
