#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "campaign/whole_folder.hpp"
#include "csv_text.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "tribofit/report/study.hpp"

namespace tribofit {
namespace {

Json range_json(const Range& range, double unit) {
  return interval_json(range.lower95 / unit, range.upper95 / unit);
}

/// The regime and the measures, under the names of the columns in CSV.
Json settled_json(const Settled& settled) {
  Json out = object("regime", to_string(settled.regime));
  for (const MeasureInfo& measure : measures()) out[measure.column] = number(settled.*measure.value / measure.si);
  return out;
}

/// The same, and why a motion did not settle.
Json explained_json(const Settled& settled) {
  Json out = settled_json(settled);
  if (!settled.seen.empty()) out["seen"] = settled.seen;
  return out;
}

Json machine_json(const StudiedMachine& of) {
  const Machine& m = of.machine;
  Json parameters = Json::array();
  for (std::size_t k = 0; k < m.parameters.size(); ++k) {
    const FrictionModel::Slot& slot = m.model.parameters()[k];
    parameters.push_back(object("name", slot.parameter.name, "value", m.parameters[k] / slot.parameter.si, "unit",
                                slot.parameter.unit, "effect", text_or_null(slot.effect)));
  }
  return object("source", of.source, "mass_kg", m.rig.mass, "damping_N_s_per_mm", 1e-3 * m.rig.damping,
                "stiffness_N_per_mm", 1e-3 * m.rig.stiffness, "damping_ratio", m.rig.damping_ratio(), "load_N", m.load,
                "radius_mm", m.radius / kMillimetre, "speed_rpm", m.speed / kRpm, "velocity_mm_s",
                m.disc_velocity() / kMillimetre, "law", to_string(m.model.law()), "effects", m.model.effect_names(),
                "parameters", parameters, "sharpness_s_per_mm", positive_or_null(1e-3 * of.sharpness), "warnings",
                of.warnings, "notes", of.notes);
}

std::string study_text(const StudiedMachine& of, const char* kind, const Json& body, const JsonOptions& options) {
  Json study = object("kind", kind, "machine", machine_json(of));
  study.update(body);
  return text_of(object("tool", tool_json(options), "study", std::move(study)));
}

Json harmonic_json(const ResponseLine& h) {
  return object("frequency_hz", h.frequency, "force_N", h.force, "displacement_mm", h.displacement / kMillimetre,
                "velocity_mm_s", h.velocity / kMillimetre);
}

Json motion_json(const SimulatedMotion& motion) {
  const auto millimetres = [](double value) { return Json(1e3 * value); };
  return object("time_s", motion.time, "displacement_mm", list_of(motion.displacement, millimetres),
                "block_velocity_mm_s", list_of(motion.velocity, millimetres));
}

/// ",frequency_hz,stick_time_s,..." with something before each name.
std::string measure_columns(const std::string& before = "") {
  std::string text;
  for (const MeasureInfo& measure : measures()) text += "," + before + measure.column;
  return text;
}

void write_motion(WholeFile& file, const SimulatedMotion& motion) {
  file.write("time_s,displacement_mm,block_velocity_mm_s,relative_velocity_mm_s,friction,phase\n");
  for (std::size_t i = 0; i < motion.size(); ++i) {
    file.write(fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", motion.time[i], 1e3 * motion.displacement[i],
                           1e3 * motion.velocity[i], 1e3 * motion.relative_velocity[i], motion.friction[i],
                           motion.sticks[i] != 0 ? "stick" : "slip"));
  }
}

/// "stiffness_N_per_mm", as columns are called.
std::string column_of(const Variable& variable) {
  const std::string text = variable.name + (variable.unit == "1" ? "" : "_" + variable.unit);
  std::string out;
  for (const char c : text) {
    if (c == '/') {
      out += variable.unit.find('/') == 0 ? "1_per_" : "_per_";
    } else {
      out += c == ' ' || c == '-' ? '_' : c;
    }
  }
  return out;
}

/// A cell of a map from the rest of its line; nothing where that is not one.
std::optional<MapCell> map_cell_from(const std::string& line) {
  MapCell cell;
  std::size_t comma = line.find(',');
  bool named = false;
  for (const Regime r : kRegimes) {
    if (line.substr(0, comma) != to_string(r)) continue;
    cell.regime = r;
    named = true;
  }
  if (!named) return std::nullopt;
  for (const MeasureInfo& measure : measures()) {
    const std::size_t begin = comma + 1;
    comma = line.find(',', begin);
    if (comma == std::string::npos) return std::nullopt;
    double value = std::numeric_limits<double>::quiet_NaN();
    if (comma > begin && std::from_chars(line.data() + begin, line.data() + comma, value).ptr != line.data() + comma) {
      return std::nullopt;
    }
    cell.values.push_back(value * measure.si);
  }
  return cell;
}

}  // namespace

std::string study_json(const StudiedMachine& of, const SpeedStudy& study, const JsonOptions& options) {
  Json points = Json::array();
  for (std::size_t i = 0; i < study.velocity.size(); ++i) {
    points.push_back(object("velocity_mm_s", study.velocity[i] / kMillimetre, "growth_rate_1_s", study.growth_rate[i],
                            "up", explained_json(study.up[i]), "down", explained_json(study.down[i])));
  }
  Json own = explained_json(study.own);
  for (std::size_t k = 0; k < study.own_ranges.size(); ++k) {
    own["ci95"][measures()[k].column] = range_json(study.own_ranges[k], measures()[k].si);
  }
  const CriticalSpeed& c = study.critical;
  const Json critical =
      object("linear_mm_s", list_of(c.linear, [](double v) { return number(v / kMillimetre); }), "linear_ci95_mm_s",
             range_json(study.linear_range, kMillimetre), "stick_vanishes_mm_s", c.stick_vanishes / kMillimetre,
             "stick_vanishes_ci95_mm_s", range_json(study.vanishes_range, kMillimetre), "stick_returns_mm_s",
             c.stick_returns / kMillimetre, "stick_returns_ci95_mm_s", range_json(study.returns_range, kMillimetre),
             "searched_mm_s", interval_json(c.lowest / kMillimetre, c.highest / kMillimetre), "nothing_sticks",
             c.below_range, "always_sticks", c.above_range);
  return study_text(of, "speed", object("own", own, "critical_speed", critical, "points", points), options);
}

std::string study_json(const StudiedMachine& of, const std::vector<Portrait>& study, const JsonOptions& options) {
  const auto portrait = [](const Portrait& p) {
    return object("velocity_mm_s", p.velocity / kMillimetre, "settled", explained_json(p.settled), "start",
                  motion_json(p.start), "cycle", p.cycle.size() > 0 ? motion_json(p.cycle) : Json());
  };
  return study_text(of, "phase", object("portraits", list_of(study, portrait)), options);
}

std::string study_json(const StudiedMachine& of, const Response& study, const JsonOptions& options) {
  Json curve = Json::array();
  for (std::size_t i = 0; i < study.frequency.size(); ++i) {
    curve.push_back(interval_json(study.frequency[i], study.amplitude[i] / kMillimetre));
  }
  return study_text(
      of, "response",
      object("natural_frequency_hz", study.natural_frequency, "damped_natural_frequency_hz",
             study.damped_natural_frequency, "force_N", study.force, "settled", explained_json(study.settled),
             "harmonics", list_of(study.harmonics, harmonic_json), "curve_hz_mm", curve),
      options);
}

std::string study_json(const StudiedMachine& of, const std::vector<Sensitivity>& study, const JsonOptions& options) {
  const auto variable = [](const Sensitivity& one) {
    Json elasticities = Json::object(), sweep = Json::array();
    for (std::size_t k = 0; k < one.elasticities.size(); ++k) {
      elasticities[measures()[k].name] = number(one.elasticities[k]);
    }
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      Json point = object("value", one.values[i] / one.variable.si);
      point.update(explained_json(one.settled[i]));
      sweep.push_back(point);
    }
    return object("name", one.variable.name, "unit", one.variable.unit, "value", one.base / one.variable.si,
                  "elasticities", elasticities, "sweep", sweep);
  };
  Json order = Json::object();
  for (std::size_t k = 0; k < measures().size(); ++k) {
    order[measures()[k].name] = list_of(ranked(study, k), [&](std::size_t i) { return Json(study[i].variable.name); });
  }
  return study_text(of, "sensitivity", object("variables", list_of(study, variable), "ranked", order), options);
}

std::string map_json(const StudiedMachine& of, const MapRequest& request, const MapRows& rows,
                     const JsonOptions& options) {
  const auto axis = [](const MapAxis& a) {
    return object("name", a.variable.name, "unit", a.variable.unit, "values",
                  list_of(a.values, [&](double v) { return number(v / a.variable.si); }));
  };
  const auto grid = [&](auto&& value) {
    return list_of(rows, [&](const std::vector<MapCell>& row) { return list_of(row, value); });
  };
  Json by_measure = Json::object();
  for (std::size_t k = 0; k < measures().size(); ++k) {
    by_measure[measures()[k].column] =
        grid([&](const MapCell& cell) { return number(cell.values[k] / measures()[k].si); });
  }
  const Json regimes = grid([](const MapCell& cell) { return Json(to_string(cell.regime)); });
  return study_text(of, "map",
                    object("x", axis(request.x), "y", axis(request.y), "regimes", regimes, "measures", by_measure),
                    options);
}

void write_study(const std::string& folder, const SpeedStudy& study) {
  WholeFolder files(folder);
  WholeFile& table = files.add("speed.csv");
  table.write("velocity_mm_s,growth_rate_1_s,regime_up" + measure_columns("up_") + ",regime_down" +
              measure_columns("down_") + "\n");
  for (std::size_t i = 0; i < study.velocity.size(); ++i) {
    table.write(csv_line({cell(1e3 * study.velocity[i]), cell(study.growth_rate[i]), cells(settled_json(study.up[i])),
                          cells(settled_json(study.down[i]))}));
  }
  files.commit();
}

void write_study(const std::string& folder, const std::vector<Portrait>& study) {
  WholeFolder files(folder);
  WholeFile& list = files.add("portraits.csv");
  list.write("portrait,velocity_mm_s,regime" + measure_columns() + "\n");
  for (std::size_t i = 0; i < study.size(); ++i) {
    const Portrait& portrait = study[i];
    const std::string name = std::to_string(i + 1);
    list.write(csv_line({name, cell(1e3 * portrait.velocity), cells(settled_json(portrait.settled))}));
    write_motion(files.add("phase_" + name + ".csv"), portrait.start);
    if (portrait.cycle.size() > 0) write_motion(files.add("cycle_" + name + ".csv"), portrait.cycle);
  }
  files.commit();
}

void write_study(const std::string& folder, const Response& study) {
  WholeFolder files(folder);
  WholeFile& curve = files.add("response.csv");
  curve.write("frequency_hz,displacement_amplitude_mm\n");
  for (std::size_t i = 0; i < study.frequency.size(); ++i) {
    curve.write(csv_line({cell(study.frequency[i]), cell(1e3 * study.amplitude[i])}));
  }
  WholeFile& lines = files.add("harmonics.csv");
  lines.write("harmonic,frequency_hz,force_N,displacement_mm,velocity_mm_s\n");
  for (std::size_t n = 0; n < study.harmonics.size(); ++n) {
    lines.write(csv_line({std::to_string(n + 1), cells(harmonic_json(study.harmonics[n]))}));
  }
  files.commit();
}

void write_study(const std::string& folder, const std::vector<Sensitivity>& study) {
  WholeFolder files(folder);
  WholeFile& sweeps = files.add("sensitivity.csv");
  sweeps.write("variable,unit,value,relative_value,regime" + measure_columns() + "\n");
  WholeFile& table = files.add("elasticities.csv");
  std::vector<std::string> header = {"variable", "unit", "value"};
  for (const MeasureInfo& measure : measures()) header.push_back(measure.name);
  table.write(csv_line(header));
  for (const Sensitivity& one : study) {
    const std::string name = cell(one.variable.name), unit = cell(one.variable.unit);
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      sweeps.write(csv_line({name, unit, cell(one.values[i] / one.variable.si), cell(one.values[i] / one.base),
                             cells(settled_json(one.settled[i]))}));
    }
    table.write(csv_line({name, unit, cell(one.base / one.variable.si), cells(list_of(one.elasticities, number))}));
  }
  files.commit();
}

std::string map_csv_header(const MapRequest& request) {
  return column_of(request.x.variable) + "," + column_of(request.y.variable) + ",regime" + measure_columns() + "\n";
}

std::string map_csv_row(const MapRequest& request, std::size_t row, const std::vector<MapCell>& all) {
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<std::string> line = {cell(request.x.values[i] / request.x.variable.si),
                                     cell(request.y.values[row] / request.y.variable.si),
                                     std::string(to_string(all[i].regime))};
    for (std::size_t k = 0; k < all[i].values.size(); ++k) line.push_back(cell(all[i].values[k] / measures()[k].si));
    text += csv_line(line);
  }
  return text;
}

std::vector<MapCell> map_row_from_csv(const MapRequest& request, std::size_t row, const std::string& text) {
  std::vector<MapCell> all;
  std::size_t at = 0;
  for (const double x : request.x.values) {
    const std::string front =
        cell(x / request.x.variable.si) + "," + cell(request.y.values[row] / request.y.variable.si) + ",";
    const std::size_t end = text.find('\n', at);
    if (text.compare(at, front.size(), front) != 0 || end == std::string::npos) return {};
    const auto known = map_cell_from(text.substr(at + front.size(), end - at - front.size()) + ",");
    if (!known) return {};
    all.push_back(*known);
    at = end + 1;
  }
  return at == text.size() ? all : std::vector<MapCell>{};
}

}  // namespace tribofit
