#include "json_parts.hpp"
#include "numbers.hpp"
#include "tribofit/report/study.hpp"

namespace tribofit {
namespace {

Json range_json(const Range& range, double unit) {
  return Json::array({number(range.lower95 / unit), number(range.upper95 / unit)});
}

Json settled_json(const Settled& settled) {
  Json out = {{"regime", to_string(settled.regime)}};
  for (const MeasureInfo& measure : measures()) out[measure.column] = number(settled.*measure.value / measure.si);
  if (!settled.seen.empty()) out["seen"] = settled.seen;
  return out;
}

Json machine_json(const StudiedMachine& of) {
  const Machine& m = of.machine;
  Json parameters = Json::array();
  for (std::size_t k = 0; k < m.parameters.size(); ++k) {
    const FrictionModel::Slot& slot = m.model.parameters()[k];
    parameters.push_back({{"name", slot.parameter.name},
                          {"value", number(m.parameters[k] / slot.parameter.si)},
                          {"unit", slot.parameter.unit},
                          {"effect", text_or_null(slot.effect)}});
  }
  return {{"source", of.source},
          {"mass_kg", number(m.rig.mass)},
          {"damping_N_s_per_mm", number(1e-3 * m.rig.damping)},
          {"stiffness_N_per_mm", number(1e-3 * m.rig.stiffness)},
          {"damping_ratio", number(m.rig.damping_ratio())},
          {"load_N", number(m.load)},
          {"radius_mm", number(m.radius / kMillimetre)},
          {"speed_rpm", number(m.speed / kRpm)},
          {"velocity_mm_s", number(m.disc_velocity() / kMillimetre)},
          {"law", to_string(m.model.law())},
          {"effects", m.model.effect_names()},
          {"parameters", parameters},
          {"sharpness_s_per_mm", of.sharpness > 0 ? number(1e-3 * of.sharpness) : Json()},
          {"notes", of.notes}};
}

std::string study_text(const StudiedMachine& of, const char* kind, Json body, const JsonOptions& options) {
  Json study = {{"kind", kind}, {"machine", machine_json(of)}};
  study.update(body);
  return text_of({{"tool", tool_json(options)}, {"study", std::move(study)}});
}

Json motion_json(const SimulatedMotion& motion) {
  Json out = {{"time_s", Json::array()}, {"displacement_mm", Json::array()}, {"block_velocity_mm_s", Json::array()}};
  for (std::size_t i = 0; i < motion.size(); ++i) {
    out["time_s"].push_back(motion.time[i]);
    out["displacement_mm"].push_back(1e3 * motion.displacement[i]);
    out["block_velocity_mm_s"].push_back(1e3 * motion.velocity[i]);
  }
  return out;
}

}  // namespace

std::string study_json(const StudiedMachine& of, const SpeedStudy& study, const JsonOptions& options) {
  Json points = Json::array();
  for (std::size_t i = 0; i < study.velocity.size(); ++i) {
    points.push_back({{"velocity_mm_s", number(study.velocity[i] / kMillimetre)},
                      {"growth_rate_1_s", number(study.growth_rate[i])},
                      {"up", settled_json(study.up[i])},
                      {"down", settled_json(study.down[i])}});
  }
  Json linear = Json::array();
  for (const double v : study.critical.linear) linear.push_back(number(v / kMillimetre));
  Json own = settled_json(study.own);
  for (std::size_t k = 0; k < study.own_ranges.size(); ++k) {
    own["ci95"][measures()[k].column] = range_json(study.own_ranges[k], measures()[k].si);
  }
  const CriticalSpeed& c = study.critical;
  const Json critical = {{"linear_mm_s", linear},
                         {"linear_ci95_mm_s", range_json(study.linear_range, kMillimetre)},
                         {"stick_vanishes_mm_s", number(c.stick_vanishes / kMillimetre)},
                         {"stick_vanishes_ci95_mm_s", range_json(study.vanishes_range, kMillimetre)},
                         {"stick_returns_mm_s", number(c.stick_returns / kMillimetre)},
                         {"stick_returns_ci95_mm_s", range_json(study.returns_range, kMillimetre)},
                         {"searched_mm_s", {number(c.lowest / kMillimetre), number(c.highest / kMillimetre)}},
                         {"nothing_sticks", c.below_range},
                         {"always_sticks", c.above_range}};
  return study_text(of, "speed", {{"own", own}, {"critical_speed", critical}, {"points", points}}, options);
}

std::string study_json(const StudiedMachine& of, const std::vector<Portrait>& study, const JsonOptions& options) {
  Json portraits = Json::array();
  for (const Portrait& p : study) {
    portraits.push_back({{"velocity_mm_s", number(p.velocity / kMillimetre)},
                         {"settled", settled_json(p.settled)},
                         {"start", motion_json(p.start)},
                         {"cycle", p.cycle.size() > 0 ? motion_json(p.cycle) : Json()}});
  }
  return study_text(of, "phase", {{"portraits", portraits}}, options);
}

std::string study_json(const StudiedMachine& of, const Response& study, const JsonOptions& options) {
  Json harmonics = Json::array(), curve = Json::array();
  for (const ResponseLine& h : study.harmonics) {
    harmonics.push_back({{"frequency_hz", number(h.frequency)},
                         {"force_N", number(h.force)},
                         {"displacement_mm", number(h.displacement / kMillimetre)},
                         {"velocity_mm_s", number(h.velocity / kMillimetre)}});
  }
  for (std::size_t i = 0; i < study.frequency.size(); ++i) {
    curve.push_back({number(study.frequency[i]), number(study.amplitude[i] / kMillimetre)});
  }
  return study_text(of, "response",
                    {{"natural_frequency_hz", number(study.natural_frequency)},
                     {"damped_natural_frequency_hz", number(study.damped_natural_frequency)},
                     {"force_N", number(study.force)},
                     {"settled", settled_json(study.settled)},
                     {"harmonics", harmonics},
                     {"curve_hz_mm", curve}},
                    options);
}

std::string study_json(const StudiedMachine& of, const std::vector<Sensitivity>& study, const JsonOptions& options) {
  Json variables = Json::array();
  for (const Sensitivity& one : study) {
    Json elasticities = Json::object(), sweep = Json::array();
    for (std::size_t k = 0; k < one.elasticities.size(); ++k) {
      elasticities[measures()[k].name] = number(one.elasticities[k]);
    }
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      Json point = {{"value", number(one.values[i] / one.variable.si)}};
      point.update(settled_json(one.settled[i]));
      sweep.push_back(point);
    }
    variables.push_back({{"name", one.variable.name},
                         {"unit", one.variable.unit},
                         {"value", number(one.base / one.variable.si)},
                         {"elasticities", elasticities},
                         {"sweep", sweep}});
  }
  Json order = Json::object();
  for (std::size_t k = 0; k < measures().size(); ++k) {
    Json names = Json::array();
    for (const std::size_t i : ranked(study, k)) names.push_back(study[i].variable.name);
    order[measures()[k].name] = names;
  }
  return study_text(of, "sensitivity", {{"variables", variables}, {"ranked", order}}, options);
}

std::string map_json(const StudiedMachine& of, const MapRequest& request, const std::vector<std::vector<MapCell>>& rows,
                     const JsonOptions& options) {
  const auto axis = [](const MapAxis& a) {
    Json values = Json::array();
    for (const double v : a.values) values.push_back(number(v / a.variable.si));
    return Json{{"name", a.variable.name}, {"unit", a.variable.unit}, {"values", values}};
  };
  Json regimes = Json::array(), by_measure = Json::object();
  for (const auto& row : rows) {
    Json line = Json::array();
    for (const MapCell& cell : row) line.push_back(to_string(cell.regime));
    regimes.push_back(line);
  }
  for (std::size_t k = 0; k < measures().size(); ++k) {
    Json grid = Json::array();
    for (const auto& row : rows) {
      Json line = Json::array();
      for (const MapCell& cell : row) line.push_back(number(cell.values[k] / measures()[k].si));
      grid.push_back(line);
    }
    by_measure[measures()[k].column] = grid;
  }
  return study_text(of, "map",
                    {{"x", axis(request.x)}, {"y", axis(request.y)}, {"regimes", regimes}, {"measures", by_measure}},
                    options);
}

}  // namespace tribofit
