#include "tribofit/report/json.hpp"
#include "tribofit/kinematics/health.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "campaign/condition_cells.hpp"
#include "fit/assessment.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "rate_state.hpp"
#include "segmentation/counts.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

// In the order of HealthItem::Status and MotionKind.

/// In the units in which the parameters are shown; empty where it is not known.
Json covariance_json(const Fit& fit) {
  Json rows = Json::array();
  const std::size_t n = fit.parameters.size();
  if (fit.covariance.size() != n * n) return rows;
  for (std::size_t i = 0; i < n; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < n; ++j) {
      row.push_back(number(shown(fit.parameters[i], shown(fit.parameters[j], fit.covariance[i * n + j]))));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

Json error_json(double rmse, double mean_relative, double max_relative, double held_out_rmse) {
  return object("rmse", rmse, "mean_relative", mean_relative, "max_relative", max_relative, "held_out_rmse",
                held_out_rmse);
}

namespace {

Json fit_json(const Fit& fit, const Motion& motion) {
  const auto parameter = [&](const FitParameter& p) { return parameter_json(p, motion); };
  const auto correlation = [&](const Correlation& c) {
    return object("parameters", Json{fit.parameters[c.first].parameter.name, fit.parameters[c.second].parameter.name},
                  "value", c.value);
  };
  const Json floor = object("noise", fit.floor.noise, "scatter", fit.floor.scatter, "slow_noise", fit.floor.slow_noise,
                            "source", fit.floor.source);
  return object("law", to_string(fit.model.law()), "protocol", to_string(fit.protocol), "effects",
                fit.model.effect_keys(), "effect_names", fit.model.effect_names(), "parameters",
                list_of(fit.parameters, parameter), "error",
                error_json(fit.error.rmse, fit.error.mean_relative, fit.error.max_relative, fit.error.held_out_rmse),
                "floor_rmse", fit.floor.rmse, "converged", fit.converged, "conditional", is_conditional(fit),
                "messages", fit.messages, "floor", floor, "explained", fit.explained, "stick_creep_rmse_mm_s",
                fit.stick_rmse / kMillimetre, "fastest_mm_s", fit.fastest / kMillimetre, "samples", fit.observations,
                "cycles", fit.cycles, "correlations", list_of(fit.correlations, correlation), "covariance",
                covariance_json(fit), "degrees_of_freedom", fit.degrees_of_freedom);
}

Json spread_json(const SlipSpread& spread) {
  return object("mean", spread.mean.value, "std_error", spread.mean.std_error, "scatter", spread.scatter);
}

Json estimate_json(const Estimate& estimate) {
  const Interval ci = interval_of(estimate);
  return object("value", estimate.value, "std_error", estimate.std_error, "ci95", interval_json(ci.lower, ci.upper));
}

Json force_json(const ForceStatistics& force) {
  return object("friction", spread_json(force.whole), "slips", force.slips, "peak", spread_json(force.peak), "drop",
                spread_json(force.drop), "period_s", spread_json(force.period), "slip_time_s",
                spread_json(force.slip_time), "both_directions", force.both_directions);
}

Json friction_levels_json(const FrictionLevels& levels) {
  return object("bins",
                list_of(levels.bins,
                        [](const FrictionLevels::Bin& bin) {
                          return object("velocity_mm_s", bin.velocity / kMillimetre, "friction",
                                        estimate_json(bin.friction), "slips", bin.slips);
                        }),
                "levels", list_of(levels.levels, [](const FrictionLevels::Level& level) {
                  return object("slowest_peak_mm_s", level.slowest_peak / kMillimetre, "fastest_peak_mm_s",
                                level.fastest_peak / kMillimetre, "friction", estimate_json(level.friction), "slips",
                                level.slips);
                }));
}

Json shares_json(const std::vector<Share>& shares) {
  return list_of(shares, [](const Share& s) {
    return object("variable", to_string(s.variable), "share", s.share, "p_value", s.p_value);
  });
}

Json diagnosis_json(const Diagnosis& d, const Motion& motion) {
  const auto finding = [&](const EffectFinding& f) {
    return object("key", f.key, "status", to_string(f.status), "held_out_rmse", f.held_out_rmse, "error_reduction",
                  f.error_reduction, "p_value", f.p_value, "parameters",
                  list_of(f.parameters, [&](const FitParameter& p) { return parameter_json(p, motion); }), "reason",
                  f.reason, "held_out_std_error", f.held_out_std_error);
  };
  const auto rung = [](const Rung& r) {
    return object("added", text_or_null(r.added), "held_out_rmse", r.held_out_rmse, "rmse", r.rmse, "equivalent",
                  r.equivalent, "held_out_std_error", r.held_out_std_error);
  };
  const auto confirmation = [](const Confirmation& c) {
    return object("path", c.path, "base_rmse", c.base_rmse, "final_rmse", c.final_rmse, "p_value", c.p_value,
                  "floor_rmse", c.floor_rmse);
  };
  return object("verdict", to_string(d.verdict), "law", to_string(d.law), "rival_laws",
                list_of(d.rival_laws, [](const Law& law) { return to_string(law); }), "from_the_start",
                d.from_the_start, "where", shares_json(d.where), "effects", list_of(d.effects, finding), "ladder",
                list_of(d.ladder, rung), "floor_rmse", d.floor_rmse, "remaining", shares_json(d.remaining),
                "next_experiment", d.next_experiment, "formula", text_or_null(d.formula), "confirmations",
                list_of(d.confirmations, confirmation), "messages", d.messages);
}

Json health_json(const Motion& motion) {
  return list_of(motion.health, [](const HealthItem& item) {
    const bool made = health_check::was_made(item.message);
    return object("check", item.check, "status", made ? to_string(item.status) : "not-checked", "message",
                  item.message);
  });
}

Json stick_slip_json(const Identification& result) {
  const Segmentation& s = result.segmentation;
  const SpectralPeak& peak = result.spectral_peak;
  return object("cycles", count_of_cycles(s), "frequency_hz", estimate_json(s.frequency), "amplitude_mm_s",
                s.amplitude.value / kMillimetre, "rms_velocity_mm_s", s.rms_velocity / kMillimetre, "stick_time_s",
                s.stick_time.value, "amplitude_std_error_mm_s", s.amplitude.std_error / kMillimetre,
                "stick_time_std_error_s", s.stick_time.std_error, "slip_time_s", s.slip_time.value,
                "slip_time_std_error_s", s.slip_time.std_error, "slips", s.cycles.size(), "samples_in_slip",
                samples_in_slip(s), "sticks_over_1_s", long_sticks(s).count, "longest_stick_s", long_sticks(s).longest,
                "branch_difference", s.branch_difference.value, "branch_difference_std_error",
                s.branch_difference.std_error, "motion", to_string(s.kind), "notes", s.notes, "spectrum",
                object("peak_hz", peak.frequency, "amplitude_mm_s", peak.amplitude / kMillimetre, "plain_fft_bin_hz",
                       peak.bin_frequency, "plain_fft_bin_width_hz", peak.bin_width));
}

Json comparisons_json(std::span<const Fit> fits, std::size_t best) {
  return list_of(compare_laws(fits, best), [](const LawComparison& c) {
    return object("first", c.first, "second", c.second, "difference", c.comparison.difference, "std_error",
                  c.comparison.std_error, "p_value", c.comparison.p_value, "first_better", c.comparison.first_better);
  });
}

/// What several traces are: lists of what each is.
void add_traces(const std::vector<Identification>& traces, Json& json) {
  json["traces"] = list_of(traces, trace_json);
  json["conditions"] = list_of(traces, [](const Identification& trace) { return conditions_of(trace.motion); });
  json["health"] = Json::array();
  for (std::size_t k = 0; k < traces.size(); ++k) {
    for (Json item : health_json(traces[k].motion)) {
      item["trace"] = k;
      json["health"].push_back(std::move(item));
    }
  }
  json["stick_slip"] = list_of(traces, stick_slip_json);
}

/// All parameters of traces diagnosed together are shared.
void mark_as_shared(Json& holders) {
  for (Json& holder : holders) {
    for (Json& parameter : holder["parameters"]) parameter["trace"] = nullptr;
  }
}

}  // namespace

Json tool_json(const JsonOptions& options) {
  return object("name", "tribofit", "version", version, "arguments", options.arguments);
}

Json conditions_json(const Conditions& c) {
  Json json = condition_values(c);
  for (const ConditionInfo& info : condition_infos) json[source_key(info)] = text_or_null((c.*info.member).source);
  return json;
}

Json trace_json(const Identification& r) {
  return object("path", r.path, "samples", r.samples, "duration_s", r.duration, "rate_hz", r.rate, "checksum",
                fmt::format("{:016x}", r.checksum), "friction_unit", friction_unit(r.motion), "trimmed_s",
                static_cast<double>(r.motion.trimmed) * r.motion.step, "notes", r.notes, "kind",
                to_string(kind_of_record(r.motion, r.segmentation)), "kind_source", text_or_null(r.motion.kind_source));
}

Json conditions_of(const Motion& motion) {
  Json json = conditions_json(motion.conditions);
  if (motion.kind == RecordKind::spring_slider) {
    json["spring"] = object("drive_mm_s", motion.spring.velocity.value / kMillimetre, "stiffness_N_per_mm",
                            motion.spring.stiffness.value * kMillimetre, "mass_kg", motion.spring.mass.value);
  }
  if (motion.kind == RecordKind::motion_only) {
    json["spring"] = object("stiffness_N_per_m", motion.spring.stiffness.value, "mass_kg", motion.spring.mass.value,
                            "damping_N_s_per_m", motion.spring.damping.value, "rubs_on",
                            motion.spring.counterface == Counterface::base ? "base" : "ground");
  }
  if (motion.steps.size() < 2) return json;
  json["steps"] = list_of(motion.steps, [](const Step& step) {
    Json item = object("label", step.label, "begin", step.begin, "end", step.end);
    item.update(conditions_json(step.conditions));
    return item;
  });
  return json;
}

Json parameter_json(const FitParameter& p, const Motion& motion) {
  const auto in_unit = [&](double si) { return shown(p, si); };
  return object("name", p.parameter.name, "value", in_unit(p.value), "std_error", in_unit(p.std_error), "ci95",
                interval_json(in_unit(p.lower95), in_unit(p.upper95)), "unit", shown_unit(p, motion), "effect",
                text_or_null(p.effect), "systematic_error", positive_or_null(in_unit(p.systematic)), "profile_ci95",
                interval_json(in_unit(p.profile_lower95), in_unit(p.profile_upper95)), "start", in_unit(p.start),
                "bounds", interval_json(p.parameter.lower, p.parameter.upper), "at_bound", p.at_bound, "determined",
                p.determined);
}

Json fits_json(std::span<const Fit> fits, const Motion& motion) {
  return list_of(fits, [&](const Fit& fit) { return fit_json(fit, motion); });
}

Json record_json(const Identification& trace, const JsonOptions& options) {
  Json json = object("tool", tool_json(options), "trace", trace_json(trace), "conditions", conditions_of(trace.motion),
                     "health", health_json(trace.motion), "stick_slip", stick_slip_json(trace));
  if (trace.force_statistics) json["force"] = force_json(*trace.force_statistics);
  if (trace.friction_levels) json["friction_over_velocity"] = friction_levels_json(*trace.friction_levels);
  return json;
}

Json identification_json(const Identification& r, const JsonOptions& options) {
  Json json = record_json(r, options);
  const bool driven = r.rate_state && !r.rate_state->fits.empty();
  if (r.rate_state) json["rate_state"] = rate_state_json(*r.rate_state, r.motion);
  add_members(json, "fits", driven ? rate_state_fits_json(*r.rate_state, r.motion) : fits_json(r.fits, r.motion),
              "best",
              driven           ? Json(r.rate_state->best)
              : r.fits.empty() ? Json(nullptr)
                               : Json(r.best),
              "law_comparison", comparisons_json(r.fits, r.best), "analysed", r.analysed, "warnings", r.warnings);
  return json;
}

Json diagnosed_json(const DiagnosedTraces& result, const JsonOptions& options) {
  const Motion none;
  const Motion& motion = result.traces.empty() ? none : result.traces.front().motion;
  const bool one = result.traces.size() == 1;
  Json json = one ? record_json(result.traces.front(), options) : object("tool", tool_json(options));
  if (!one) add_traces(result.traces, json);
  Json warnings = Json::array();
  for (const Identification& trace : result.traces) {
    for (const std::string& warning : trace.warnings) warnings.push_back(one ? warning : trace.path + ": " + warning);
  }
  add_members(json, "fits", fits_json(result.fits, motion), "best",
              result.fits.empty() ? Json(nullptr) : Json(result.best), "law_comparison",
              comparisons_json(result.fits, result.best), "analysed", result.analysed, "warnings", std::move(warnings),
              "diagnosis", diagnosis_json(result.diagnosis, motion));
  if (result.traces.size() > 1) {
    mark_as_shared(json["fits"]);
    mark_as_shared(json["diagnosis"]["effects"]);
  }
  return json;
}

std::string to_json(const DiagnosedTraces& result, const JsonOptions& options) {
  return text_of(diagnosed_json(result, options));
}

std::string to_json(const Identification& result, const JsonOptions& options) {
  return text_of(identification_json(result, options));
}

}  // namespace tribofit
