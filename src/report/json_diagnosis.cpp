#include <utility>

#include "json_parts.hpp"
#include "tribofit/report/json.hpp"

namespace tribofit {
namespace {

Json shares_json(const std::vector<Share>& shares) {
  Json list = Json::array();
  for (const Share& s : shares) {
    list.push_back({{"variable", s.variable}, {"share", number(s.share)}, {"p_value", number(s.p_value)}});
  }
  return list;
}

Json finding_json(const EffectFinding& finding, const Motion& motion) {
  Json parameters = Json::array();
  for (const FitParameter& p : finding.parameters) parameters.push_back(parameter_json(p, motion));
  return {{"key", finding.key},
          {"status", to_string(finding.status)},
          {"held_out_rmse", number(finding.held_out_rmse)},
          {"error_reduction", number(finding.error_reduction)},
          {"p_value", number(finding.p_value)},
          {"parameters", std::move(parameters)},
          {"reason", finding.reason},
          {"held_out_std_error", number(finding.held_out_std_error)}};
}

Json rung_json(const Rung& rung) {
  return {{"added", text_or_null(rung.added)},
          {"held_out_rmse", number(rung.held_out_rmse)},
          {"rmse", number(rung.rmse)},
          {"equivalent", rung.equivalent},
          {"held_out_std_error", number(rung.held_out_std_error)}};
}

Json confirmation_json(const Confirmation& c) {
  return {{"path", c.path},
          {"base_rmse", number(c.base_rmse)},
          {"final_rmse", number(c.final_rmse)},
          {"p_value", number(c.p_value)}};
}

Json diagnosis_json(const Diagnosis& d, const Motion& motion) {
  Json effects = Json::array(), ladder = Json::array(), confirmations = Json::array();
  for (const EffectFinding& finding : d.effects) effects.push_back(finding_json(finding, motion));
  for (const Rung& rung : d.ladder) ladder.push_back(rung_json(rung));
  for (const Confirmation& c : d.confirmations) confirmations.push_back(confirmation_json(c));
  return {{"verdict", to_string(d.verdict)},
          {"law", to_string(d.law)},
          {"from_the_start", d.from_the_start},
          {"where", shares_json(d.where)},
          {"effects", std::move(effects)},
          {"ladder", std::move(ladder)},
          {"floor_rmse", number(d.floor_rmse)},
          {"remaining", shares_json(d.remaining)},
          {"next_experiment", d.next_experiment},
          {"formula", text_or_null(d.formula)},
          {"confirmations", std::move(confirmations)},
          {"messages", d.messages}};
}

/// What the traces are: one object each, or lists of them where there are several.
void add_traces(const std::vector<Identification>& traces, Json& json) {
  if (traces.size() == 1) {
    const Identification& trace = traces.front();
    json["trace"] = trace_json(trace);
    json["conditions"] = conditions_of(trace.motion);
    json["health"] = health_json(trace.motion);
    json["stick_slip"] = stick_slip_json(trace);
    return;
  }
  for (const char* name : {"traces", "conditions", "health", "stick_slip"}) json[name] = Json::array();
  for (std::size_t k = 0; k < traces.size(); ++k) {
    json["traces"].push_back(trace_json(traces[k]));
    json["conditions"].push_back(conditions_of(traces[k].motion));
    json["stick_slip"].push_back(stick_slip_json(traces[k]));
    for (Json item : health_json(traces[k].motion)) {
      item["trace"] = k;
      json["health"].push_back(std::move(item));
    }
  }
}

/// All parameters of traces diagnosed together are shared.
void mark_as_shared(Json& parameters) {
  for (Json& parameter : parameters) parameter["trace"] = nullptr;
}

Json warnings_json(const std::vector<Identification>& traces) {
  Json list = Json::array();
  for (const Identification& trace : traces) {
    for (const std::string& warning : trace.warnings) {
      list.push_back(traces.size() > 1 ? trace.path + ": " + warning : warning);
    }
  }
  return list;
}

}  // namespace

Json diagnosed_json(const DiagnosedTraces& result, const JsonOptions& options) {
  const Motion none;
  const Motion& motion = result.traces.empty() ? none : result.traces.front().motion;
  Json json = {{"tool", tool_json(options)}};
  add_traces(result.traces, json);
  json["fits"] = fits_json(result.fits, motion);
  json["best"] = result.fits.empty() ? Json(nullptr) : Json(result.best);
  json["law_comparison"] = comparisons_json(result.fits, result.best);
  json["analysed"] = result.analysed;
  json["warnings"] = warnings_json(result.traces);
  json["diagnosis"] = diagnosis_json(result.diagnosis, motion);
  if (result.traces.size() > 1) {
    for (Json& fit : json["fits"]) mark_as_shared(fit["parameters"]);
    for (Json& effect : json["diagnosis"]["effects"]) mark_as_shared(effect["parameters"]);
  }
  return json;
}

std::string to_json(const DiagnosedTraces& result, const JsonOptions& options) {
  return text_of(diagnosed_json(result, options));
}

}  // namespace tribofit
