#include "session_json.hpp"

#include <array>
#include <utility>

#include "campaign/described_results.hpp"
#include "report/charts/styles.hpp"
#include "report/numbers.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit::workbench {

namespace {

/// Why the trace cannot show the effect; empty where it can.
std::string lacking(const EffectInfo& info, const Motion& motion) {
  if (info.needs.load && motion.load.empty()) return "needs the channel 'load'";
  if (info.needs.temperature && motion.temperature.empty()) return "needs the channel 'temperature'";
  if (info.needs.angle && motion.disc_angle.empty() && !motion.conditions.speed.known()) return "needs the disc angle";
  return "";
}

Json effect_json(const EffectInfo& info, const std::string& name, const Motion& motion) {
  return {{"name", name},
          {"group", to_string(info.group)},
          {"statement", info.statement},
          {"equation", info.equation},
          {"lacking", lacking(info, motion)}};
}

Json catalogue_json(const Motion& motion) {
  Json list = Json::array();
  for (const Effect& effect : effect_catalogue()) {
    // Undone wherever they are found, asked for or not; the other effects of the motion are switched.
    const EffectInfo info = describe(effect);
    if (info.kinematic_effect && info.plateau_correction == PlateauCorrection::none) continue;
    list.push_back(effect_json(info, info.key, motion));
    for (const EffectForm& form : info.forms) {
      const std::string name = info.key + ":" + form.name;
      const EffectInfo of_form = describe(make_effect(name));
      if (!of_form.kinematic_effect) list.push_back(effect_json(of_form, name, motion));
    }
  }
  return list;
}

/// In the order of WorkbenchDiagnosis::State.
constexpr std::array<const char*, 5> kStates = {"none", "running", "done", "cancelled", "failed"};

/// A rung with its errors and parameters; without the parameters where it is only listed.
Json rung_json(const WorkbenchRung& rung, const Motion& motion, bool with_parameters) {
  const Fit& fit = rung.fit;
  Json json = {{"number", rung.number == WorkbenchRung::passed_by ? Json(nullptr) : Json(rung.number)},
               {"name", fit.model.name()},
               {"choice", choice_json(rung.choice)},
               {"held_out_rmse", number(fit.error.held_out_rmse)},
               {"held_out_std_error", number(held_out_std_error(fit))},
               {"rmse", number(fit.error.rmse)},
               {"floor_rmse", number(fit.floor.rmse)},
               {"unit", friction_unit(motion)},
               {"cycles", fit.cycles},
               {"full", rung.detail == FitDetail::full},
               {"command", rung.command}};
  if (!with_parameters) return json;
  json["messages"] = fit.messages;
  json["parameters"] = Json::array();
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    Json parameter = json_of(result_of(fit.parameters[k], motion));
    parameter["full_name"] = fit.model.parameters()[k].full_name();
    json["parameters"].push_back(std::move(parameter));
  }
  return json;
}

Json rungs_json(const WorkbenchSession& session) {
  Json list = Json::array();
  for (const WorkbenchRung& rung : session.rungs()) list.push_back(rung_json(rung, session.motion(), false));
  return list;
}

}  // namespace

Json begin_json(const WorkbenchSession& session) {
  const WorkbenchRecord& record = session.record();
  return {{"trace", Json::parse(record.json)},
          {"cycles", record.cycles},
          {"sticks", record.sticks},
          {"laws", law_keys()},
          {"effects", catalogue_json(session.motion())},
          {"begin", choice_json(session.begin())},
          {"conditions", conditions_of(session.motion())},
          {"rungs", rungs_json(session)}};
}

Json picture_json(const WorkbenchPicture& picture, double turn, const WorkbenchSession& session) {
  return object("rung", rung_json(picture.rung, session.motion(), true), "rungs", rungs_json(session), "turn", turn,
                "report", report_json(picture.report));
}

Json curve_json(const Curve& curve) {
  constexpr int kDigits = 5;
  return {{"x", rounded_list(in_unit(curve.velocity, kMillimetre), kDigits)}, {"y", rounded_list(curve.mu, kDigits)}};
}

Json diagnosis_json(const WorkbenchDiagnosis& diagnosis) {
  Json json = {{"state", style_of(diagnosis.state, kStates)},
               {"doing", diagnosis.doing},
               {"part", diagnosis.part},
               {"sentence", diagnosis.sentence},
               {"command", diagnosis.command},
               {"floor_rmse", number(diagnosis.floor_rmse)}};
  json["found"] = diagnosis.state == WorkbenchDiagnosis::State::done ? choice_json(diagnosis.found) : Json(nullptr);
  json["ladder"] = Json::array();
  for (const auto& step : diagnosis.ladder) {
    json["ladder"].push_back({{"added", text_or_null(step.added)},
                              {"held_out_rmse", number(step.held_out_rmse)},
                              {"held_out_std_error", number(step.held_out_std_error)},
                              {"rmse", number(step.rmse)}});
  }
  json["leaves_open"] = diagnosis.leaves_open;
  json["plan"] = diagnosis.plan ? section_json(*diagnosis.plan) : Json(nullptr);
  return json;
}

}  // namespace tribofit::workbench
