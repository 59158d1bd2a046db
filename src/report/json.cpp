#include "tribofit/report/json.hpp"

#include <fmt/format.h>

#include <utility>

#include "campaign/described_results.hpp"
#include "fit/assessment.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "rate_state.hpp"
#include "segmentation/counts.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/version.hpp"

namespace tribofit {

TRIBOFIT_DESCRIBED(Share, variable, share, p_value);
TRIBOFIT_DESCRIBED(Confirmation, path, base_rmse, final_rmse, p_value, floor_rmse);

constexpr auto description(const Rung*) {
  using R = Rung;
  return described("added", or_null(&R::added), "held_out_rmse", &R::held_out_rmse, "rmse", &R::rmse, "equivalent",
                   &R::equivalent, "held_out_std_error", &R::held_out_std_error);
}

constexpr auto description(const SlipSpread*) {
  return described("mean", within(&SlipSpread::mean, &Estimate::value), "std_error",
                   within(&SlipSpread::mean, &Estimate::std_error), "scatter", &SlipSpread::scatter);
}

constexpr auto description(const ForceStatistics*) {
  using F = ForceStatistics;
  return described("friction", &F::whole, "slips", &F::slips, "peak", &F::peak, "drop", &F::drop, "period_s",
                   &F::period, "slip_time_s", &F::slip_time, "both_directions", &F::both_directions);
}

constexpr auto description(const FrictionLevels::Bin*) {
  using B = FrictionLevels::Bin;
  return described("velocity_mm_s", in(kMillimetre, &B::velocity), "friction", &B::friction, "slips", &B::slips);
}

constexpr auto description(const FrictionLevels::Level*) {
  using L = FrictionLevels::Level;
  return described("slowest_peak_mm_s", in(kMillimetre, &L::slowest_peak), "fastest_peak_mm_s",
                   in(kMillimetre, &L::fastest_peak), "friction", &L::friction, "slips", &L::slips);
}

TRIBOFIT_DESCRIBED(FrictionLevels, bins, levels);

namespace {

/// In the units in which the parameters are shown; empty where it is not known.
std::vector<std::vector<double>> shown_covariance(const Fit& fit) {
  const std::size_t n = fit.parameters.size();
  std::vector<std::vector<double>> rows;
  if (fit.covariance.size() != n * n) return rows;
  for (std::size_t i = 0; i < n; ++i) {
    rows.emplace_back();
    for (std::size_t j = 0; j < n; ++j) {
      rows[i].push_back(shown(fit.parameters[i], shown(fit.parameters[j], fit.covariance[i * n + j])));
    }
  }
  return rows;
}

ResultFit result_of(const Fit& fit, const Motion& motion) {
  ResultFit out;
  static_cast<FitSummary&>(out) = fit;
  out.law = to_string(fit.model.law());
  out.protocol = to_string(fit.protocol);
  out.effects = fit.model.effect_keys();
  out.effect_names = fit.model.effect_names();
  add_parameters(fit.parameters, fit.correlations, motion, out);
  out.covariance = shown_covariance(fit);
  out.conditional = is_conditional(fit);
  out.samples = fit.observations;
  return out;
}

Json diagnosis_json(const Diagnosis& d, const Motion& motion) {
  const auto finding = [&](const EffectFinding& f) {
    return object("key", f.key, "status", to_string(f.status), "held_out_rmse", f.held_out_rmse, "error_reduction",
                  f.error_reduction, "p_value", f.p_value, "parameters", json_of(results_of(f.parameters, motion)),
                  "reason", f.reason, "held_out_std_error", f.held_out_std_error);
  };
  return object("verdict", to_string(d.verdict), "law", to_string(d.law), "rival_laws",
                list_of(d.rival_laws, [](const Law& law) { return to_string(law); }), "from_the_start",
                d.from_the_start, "where", json_of(d.where), "effects", list_of(d.effects, finding), "ladder",
                json_of(d.ladder), "floor_rmse", d.floor_rmse, "remaining", json_of(d.remaining), "next_experiment",
                d.next_experiment, "formula", text_or_null(d.formula), "confirmations", json_of(d.confirmations),
                "messages", d.messages);
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
  const auto in_mm = [](const Estimate& e) { return Estimate{e.value / kMillimetre, e.std_error / kMillimetre}; };
  RunResult measures;
  measures.cycles = count_of_cycles(s);
  measures.frequency = s.frequency;
  measures.amplitude = in_mm(s.amplitude);
  measures.stick_time = s.stick_time;
  measures.slip_time = s.slip_time;
  measures.rms_velocity = s.rms_velocity / kMillimetre;
  Json json = written(stick_slip_members, measures);
  add_members(json, "slips", s.cycles.size(), "samples_in_slip", samples_in_slip(s), "sticks_over_1_s",
              long_sticks(s).count, "longest_stick_s", long_sticks(s).longest, "branch_difference",
              s.branch_difference.value, "branch_difference_std_error", s.branch_difference.std_error, "motion",
              to_string(s.kind), "notes", s.notes, "spectrum",
              object("peak_hz", peak.frequency, "amplitude_mm_s", peak.amplitude / kMillimetre, "plain_fft_bin_hz",
                     peak.bin_frequency, "plain_fft_bin_width_hz", peak.bin_width));
  return json;
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

Json trace_json(const Identification& r) {
  RunResult trace;
  trace.path = r.path;
  trace.samples = r.samples;
  trace.duration = r.duration;
  trace.rate = r.rate;
  trace.checksum = fmt::format("{:016x}", r.checksum);
  trace.friction_unit = friction_unit(r.motion);
  Json json = written(trace_members, trace);
  add_members(json, "trimmed_s", static_cast<double>(r.motion.trimmed) * r.motion.step, "notes", r.notes, "kind",
              to_string(kind_of_record(r.motion, r.segmentation)), "kind_source", text_or_null(r.motion.kind_source));
  return json;
}

Json conditions_of(const Motion& motion) {
  Json json = json_of(motion.conditions);
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
    item.update(json_of(step.conditions));
    return item;
  });
  return json;
}

void add_parameters(std::span<const FitParameter> parameters, std::span<const Correlation> correlations,
                    const Motion& motion, ResultFit& out) {
  out.parameters = results_of(parameters, motion);
  for (const Correlation& c : correlations) {
    out.correlations.push_back({{parameters[c.first].parameter.name, parameters[c.second].parameter.name}, c.value});
  }
}

Json fits_json(std::span<const Fit> fits, const Motion& motion) {
  return list_of(fits, [&](const Fit& fit) { return json_of(result_of(fit, motion)); });
}

Json record_json(const Identification& trace, const JsonOptions& options) {
  Json json = object("tool", tool_json(options), "trace", trace_json(trace), "conditions", conditions_of(trace.motion),
                     "health", health_json(trace.motion), "stick_slip", stick_slip_json(trace));
  if (trace.force_statistics) json["force"] = json_of(*trace.force_statistics);
  if (trace.friction_levels) json["friction_over_velocity"] = json_of(*trace.friction_levels);
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
              "law_comparison", comparisons_json(r.fits, r.best), "remaining",
              list_of(r.remaining, [](ResidualVariable variable) { return to_string(variable); }), "analysed",
              r.analysed, "warnings", r.warnings);
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
