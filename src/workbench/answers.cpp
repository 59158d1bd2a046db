#include "answers.hpp"

#include <utility>
#include <variant>

#include "choice_json.hpp"
#include "report/numbers.hpp"
#include "tribofit/execution/parallel.hpp"
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

std::string_view name_of(WorkbenchDiagnosis::State state) {
  switch (state) {
    case WorkbenchDiagnosis::State::none:
      return "none";
    case WorkbenchDiagnosis::State::running:
      return "running";
    case WorkbenchDiagnosis::State::done:
      return "done";
    case WorkbenchDiagnosis::State::cancelled:
      return "cancelled";
    case WorkbenchDiagnosis::State::failed:
      break;
  }
  return "failed";
}

}  // namespace

Json problem_json(const std::string& problem, const std::string& why, const std::string& suggestion) {
  return {{"problem", problem}, {"why", why}, {"suggestion", suggestion}};
}

Json rung_json(const WorkbenchRung& rung, const Motion& motion, bool with_parameters) {
  const Fit& fit = rung.fit;
  Json json = {{"number", rung.number == WorkbenchRung::passed_by ? Json(nullptr) : Json(rung.number)},
               {"name", fit.model.name()},
               {"choice", choice_json(rung.choice)},
               {"held_out_rmse", number(fit.error.held_out_rmse)},
               {"held_out_std_error", number(held_out_std_error(fit))},
               {"rmse", number(fit.error.rmse)},
               {"mean_relative", number(fit.error.mean_relative)},
               {"floor_rmse", number(fit.floor.rmse)},
               {"unit", friction_unit(motion)},
               {"cycles", fit.cycles},
               {"converged", fit.converged},
               {"full", rung.detail == FitDetail::full},
               {"command", rung.command},
               {"fit_ms", 1e3 * rung.seconds}};
  if (!with_parameters) return json;
  json["messages"] = fit.messages;
  json["parameters"] = Json::array();
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    Json parameter = parameter_json(fit.parameters[k], motion);
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

std::string text_of_answer(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

namespace {

/// Sections as text; their items, which are long, are written side by side.
std::vector<std::string> section_texts(const std::vector<const ReportSection*>& sections) {
  std::vector<const ReportItem*> items;
  for (const ReportSection* section : sections) {
    for (const ReportItem& item : section->items) items.push_back(&item);
  }
  std::vector<std::string> written(items.size());
  run_tasks(items.size(), 0, [&](std::size_t k) { written[k] = text_of_answer(item_json(*items[k])); });
  std::vector<std::string> out;
  auto next = written.begin();
  for (const ReportSection* section : sections) {
    std::string text = text_of_answer(object("id", section->id, "title", section->title));
    text.pop_back();  // the closing brace
    text += ",\"items\":[";
    for (const auto end = next + static_cast<std::ptrdiff_t>(section->items.size()); next != end; ++next) {
      if (text.back() != '[') text += ',';
      text += *next;
    }
    out.push_back(text + "]}");
  }
  return out;
}

}  // namespace

std::optional<std::string> WrittenSections::text_of(const std::shared_ptr<const ReportSection>& section) {
  const std::lock_guard lock(mutex_);
  for (const auto& [known, text] : kept_) {
    if (known == section) return text;
  }
  return std::nullopt;
}

void WrittenSections::keep(const std::shared_ptr<const ReportSection>& section, const std::string& text) {
  constexpr std::size_t kMostKept = 4;
  const std::lock_guard lock(mutex_);
  std::erase_if(kept_,
                [&](const auto& one) { return one.first == section; });  // another page may have asked for it meanwhile
  if (kept_.size() >= kMostKept) kept_.erase(kept_.begin());
  kept_.emplace_back(section, text);
}

std::string picture_text(const WorkbenchPicture& picture, double turn, const WorkbenchSession& session,
                         WrittenSections& written) {
  const std::optional<std::string> known = written.text_of(picture.cycles);
  std::vector<const ReportSection*> sections;
  for (const ReportSection& section : picture.report.sections) sections.push_back(&section);
  if (!known) sections.push_back(picture.cycles.get());
  std::vector<std::string> texts = section_texts(sections);
  if (known) {
    texts.push_back(*known);
  } else {
    written.keep(picture.cycles, texts.back());
  }
  if (picture.cycles->items.empty()) {
    texts.pop_back();
  } else if (texts.size() > 1) {  // the cycles stand before what was run, which ends the report
    std::swap(texts.back(), texts[texts.size() - 2]);
  }
  const Json others = {
      {"rung", rung_json(picture.rung, session.motion(), true)}, {"rungs", rungs_json(session)}, {"turn", turn}};
  std::string out = text_of_answer(others), shown = text_of_answer(report_json_without_sections(picture.report));
  out.pop_back(), shown.pop_back();  // the closing braces
  out += ",\"report\":" + shown + ",\"sections\":[";
  for (std::size_t k = 0; k < texts.size(); ++k) out += (k > 0 ? "," : "") + texts[k];
  return out + "]}}";
}

Json curve_json(const Curve& curve) {
  constexpr int kDigits = 5;
  return {{"x", rounded_list(in_unit(curve.velocity, kMillimetre), kDigits)}, {"y", rounded_list(curve.mu, kDigits)}};
}

Json diagnosis_json(const WorkbenchDiagnosis& diagnosis) {
  Json json = {{"state", name_of(diagnosis.state)},
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
