#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <limits>

#include "csv_cells.hpp"
#include "tribofit/report/study.hpp"
#include "whole_folder.hpp"

namespace tribofit {
namespace {

void write_line(WholeFile& file, std::initializer_list<std::string> front, const std::vector<double>& numbers) {
  std::string line;
  for (const std::string& text : front) line += (line.empty() ? "" : ",") + cell(text);
  for (const double value : numbers) line += (line.empty() ? "" : ",") + cell(value);
  file.write(line + "\n");
}

/// ",frequency_hz,stick_time_s,..." with something before each name.
std::string measure_columns(const std::string& before = "") {
  std::string text;
  for (const MeasureInfo& measure : measures()) text += "," + before + measure.column;
  return text;
}

std::vector<double> measure_values(const Settled& settled) {
  std::vector<double> values;
  for (const MeasureInfo& measure : measures()) values.push_back(settled.*measure.value / measure.si);
  return values;
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
  std::string unit = variable.unit == "1" ? "" : "_" + variable.unit;
  std::string text = variable.name + unit, out;
  for (const char c : text) {
    if (c == '/') {
      out += variable.unit.find('/') == 0 ? "1_per_" : "_per_";
    } else {
      out += c == ' ' || c == '-' ? '_' : c;
    }
  }
  return out;
}

}  // namespace

void write_study(const std::string& folder, const SpeedStudy& study) {
  WholeFolder files(folder);
  WholeFile& table = files.add("speed.csv");
  table.write("velocity_mm_s,growth_rate_1_s,regime_up" + measure_columns("up_") + ",regime_down" +
              measure_columns("down_") + "\n");
  for (std::size_t i = 0; i < study.velocity.size(); ++i) {
    std::string line = cell(1e3 * study.velocity[i]) + "," + cell(study.growth_rate[i]);
    for (const Settled* settled : {&study.up[i], &study.down[i]}) {
      line += "," + std::string(to_string(settled->regime));
      for (const double value : measure_values(*settled)) line += "," + cell(value);
    }
    table.write(line + "\n");
  }
  files.commit();
}

void write_study(const std::string& folder, const std::vector<Portrait>& study) {
  WholeFolder files(folder);
  WholeFile& list = files.add("portraits.csv");
  list.write("portrait,velocity_mm_s,regime" + measure_columns() + "\n");
  for (std::size_t i = 0; i < study.size(); ++i) {
    const Portrait& portrait = study[i];
    std::vector<double> numbers = measure_values(portrait.settled);
    write_line(
        list,
        {fmt::format("{}", i + 1), cell(1e3 * portrait.velocity), std::string(to_string(portrait.settled.regime))},
        numbers);
    write_motion(files.add(fmt::format("phase_{}.csv", i + 1)), portrait.start);
    if (portrait.cycle.size() > 0) write_motion(files.add(fmt::format("cycle_{}.csv", i + 1)), portrait.cycle);
  }
  files.commit();
}

void write_study(const std::string& folder, const Response& study) {
  WholeFolder files(folder);
  WholeFile& curve = files.add("response.csv");
  curve.write("frequency_hz,displacement_amplitude_mm\n");
  for (std::size_t i = 0; i < study.frequency.size(); ++i) {
    write_line(curve, {}, {study.frequency[i], 1e3 * study.amplitude[i]});
  }
  WholeFile& lines = files.add("harmonics.csv");
  lines.write("harmonic,frequency_hz,force_N,displacement_mm,velocity_mm_s\n");
  for (std::size_t n = 0; n < study.harmonics.size(); ++n) {
    const ResponseLine& h = study.harmonics[n];
    write_line(lines, {fmt::format("{}", n + 1)}, {h.frequency, h.force, 1e3 * h.displacement, 1e3 * h.velocity});
  }
  files.commit();
}

void write_study(const std::string& folder, const std::vector<Sensitivity>& study) {
  WholeFolder files(folder);
  WholeFile& sweeps = files.add("sensitivity.csv");
  sweeps.write("variable,unit,value,relative_value,regime" + measure_columns() + "\n");
  WholeFile& table = files.add("elasticities.csv");
  std::string header = "variable,unit,value";
  for (const MeasureInfo& measure : measures()) header += "," + measure.name;
  table.write(header + "\n");
  for (const Sensitivity& one : study) {
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      write_line(sweeps,
                 {one.variable.name, one.variable.unit, cell(one.values[i] / one.variable.si),
                  cell(one.values[i] / one.base), std::string(to_string(one.settled[i].regime))},
                 measure_values(one.settled[i]));
    }
    write_line(table, {one.variable.name, one.variable.unit, cell(one.base / one.variable.si)}, one.elasticities);
  }
  files.commit();
}

std::string map_csv_header(const MapRequest& request) {
  return column_of(request.x.variable) + "," + column_of(request.y.variable) + ",regime" + measure_columns() + "\n";
}

std::string map_csv_row(const MapRequest& request, std::size_t row, const std::vector<MapCell>& cells) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    text += cell(request.x.values[i] / request.x.variable.si) + "," +
            cell(request.y.values[row] / request.y.variable.si) + "," + std::string(to_string(cells[i].regime));
    for (std::size_t k = 0; k < cells[i].values.size(); ++k) text += "," + cell(cells[i].values[k] / measures()[k].si);
    text += "\n";
  }
  return text;
}

std::vector<MapCell> map_row_from_csv(const MapRequest& request, std::size_t row, const std::string& text) {
  std::vector<MapCell> cells;
  std::size_t at = 0;
  for (const double x : request.x.values) {
    const std::string front =
        cell(x / request.x.variable.si) + "," + cell(request.y.values[row] / request.y.variable.si) + ",";
    if (text.compare(at, front.size(), front) != 0) return {};
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) return {};
    std::string line = text.substr(at + front.size(), end - at - front.size()) + ",";
    at = end + 1;
    MapCell& known = cells.emplace_back();
    std::size_t comma = line.find(',');
    const std::string regime = line.substr(0, comma);
    bool named = false;
    for (const Regime r : {Regime::stick_slip, Regime::vibration, Regime::sliding, Regime::not_settled}) {
      if (regime != to_string(r)) continue;
      known.regime = r;
      named = true;
    }
    if (!named) return {};
    for (const MeasureInfo& measure : measures()) {
      const std::size_t begin = comma + 1;
      comma = line.find(',', begin);
      if (comma == std::string::npos) return {};
      double value = std::numeric_limits<double>::quiet_NaN();
      if (comma > begin && std::from_chars(line.data() + begin, line.data() + comma, value).ptr != line.data() + comma)
        return {};
      known.values.push_back(value * measure.si);
    }
  }
  return at == text.size() ? cells : std::vector<MapCell>{};
}

}  // namespace tribofit
