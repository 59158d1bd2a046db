/// The files of exported records.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "exported_records.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/ingest/units.hpp"

namespace recovery {

using namespace tribofit;
using nlohmann::json;

namespace {

struct ExportedColumn {
  const char* header;
  const std::vector<double>* values;
  double unit;  ///< [SI]
};

std::vector<ExportedColumn> exported_columns(const Trace& trace) {
  const bool points = trace.kind == RecordKind::points, slider = trace.kind == RecordKind::spring_slider;
  std::vector<ExportedColumn> columns;
  if (!points) columns.push_back({"time_s", &trace.time, 1});
  columns.push_back({slider ? "pull_N" : "mu", &trace.friction, 1});
  if (!trace.velocity.empty()) {
    const bool relative = trace.velocity_kind == VelocityKind::relative;
    columns.push_back({relative ? "v_r_mm_s" : "v_b_mm_s", &trace.velocity, kMillimetre});
  }
  if (!trace.load.empty()) columns.push_back({"load_N", &trace.load, 1});
  if (!trace.temperature.empty()) columns.push_back({"temperature_C", &trace.temperature, 1});
  if (!trace.disc_speed.empty()) columns.push_back({"speed_rpm", &trace.disc_speed, kRpm});
  return columns;
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(fmt::format("{} cannot be written", path.string()));
}

std::string csv_of(const Trace& trace) {
  const std::vector<ExportedColumn> columns = exported_columns(trace);
  std::string text;
  for (const ExportedColumn& column : columns) text.append(text.empty() ? "" : ",").append(column.header);
  text += '\n';
  for (std::size_t i = 0; i < trace.size(); ++i) {
    for (const ExportedColumn& column : columns) {
      const int digits = column.values == &trace.time ? 9 : 6;
      fmt::format_to(std::back_inserter(text), "{:.{}g}{}", (*column.values)[i] / column.unit, digits,
                     &column == &columns.back() ? '\n' : ',');
    }
  }
  return text;
}

json known(const Condition& condition, double unit) {
  return condition.known() ? json(condition.value / unit) : json(nullptr);
}

/// What is known of a record before it is looked at: conditions, not what is hidden.
json index_of(const std::string& name, const ExportedRecord& record) {
  json files = json::array();
  for (std::size_t k = 0; k < record.traces.size(); ++k) {
    const Trace& trace = *record.traces[k];
    const Conditions& conditions = trace.conditions;
    files.push_back({{"file", fmt::format("{}{}.csv", name, record.traces.size() > 1 ? fmt::format("-{}", k + 1) : "")},
                     {"radius_mm", known(conditions.radius, kMillimetre)},
                     {"speed_rpm", trace.disc_speed.empty() ? known(conditions.speed, kRpm) : json(nullptr)},
                     {"load_N", known(conditions.load, 1)}});
  }
  json out = {{"record", name}, {"kind", record.kind}, {"files", std::move(files)}};
  const SpringDrive& spring = record.traces.front()->spring;
  if (record.traces.front()->kind == RecordKind::spring_slider) {
    out["spring"] = {{"drive_mm_s", spring.velocity.value / kMillimetre},
                     {"stiffness_N_per_mm", spring.stiffness.value * kMillimetre},
                     {"mass_kg", spring.mass.value}};
  }
  return out;
}

json truth_of(const std::string& name, const ExportedRecord& record) {
  json hidden = json::array();
  for (const Ingredient& what : record.hidden) {
    const bool in_catalogue = std::any_of(effect_catalogue().begin(), effect_catalogue().end(),
                                          [&](const Effect& e) { return describe(e).key == what.key; });
    if (!in_catalogue) continue;
    json parameters = json::array();
    const EffectInfo info = describe(make_effect(what.key));
    for (std::size_t k = 0; k < info.parameters.size() && k < what.values.size(); ++k) {
      const auto& main = what.main_parameters;
      parameters.push_back({{"name", info.parameters[k].name},
                            {"value", what.values[k]},
                            {"unit", info.parameters[k].unit},
                            {"main", std::find(main.begin(), main.end(), k) != main.end()}});
    }
    hidden.push_back({{"effect", what.key}, {"parameters", std::move(parameters)}});
  }
  json law = json::array();
  const LawInfo info = describe(record.law);
  for (std::size_t k = 0; k < record.friction.size() && k < info.parameters.size(); ++k) {
    law.push_back({{"name", info.parameters[k].name},
                   {"value", record.friction[k] / info.parameters[k].si},
                   {"unit", info.parameters[k].unit}});
  }
  return {{"record", name},
          {"case", record.case_name},
          {"kind", record.kind},
          {"noise", record.noise},
          {"expected", record.expected},
          {"hidden", std::move(hidden)},
          {"law", to_string(record.law)},
          {"law_parameters", std::move(law)},
          {"floor_rmse", record.floor_rmse > 0 ? json(record.floor_rmse) : json(nullptr)}};
}

std::string cell(const json& value) {
  return value.is_null() ? "" : fmt::format("{:.9g}", value.get<double>());
}

}  // namespace

void export_records(const std::vector<RecordMaker>& records, const std::string& folder, std::uint64_t seed,
                    const std::function<void(std::size_t)>& done) {
  namespace fs = std::filesystem;
  const fs::path root(folder);
  if (fs::exists(root / "records")) throw std::runtime_error(fmt::format("{} holds records already", folder));
  fs::create_directories(root / "records");
  fs::create_directories(root / "truth");
  std::string index, truth, manifest = "file,radius_mm,speed_rpm,load_N\n";
  for (std::size_t k = 0; k < records.size(); ++k) {
    const ExportedRecord record = records[k]();
    const std::string name = fmt::format("r{:03}", k + 1);
    const json known_of_it = index_of(name, record);
    for (std::size_t i = 0; i < record.traces.size(); ++i) {
      const json& file = known_of_it["files"][i];
      const std::string file_name = file["file"];
      write_file(root / "records" / file_name, csv_of(*record.traces[i]));
      manifest += fmt::format("{},{},{},{}\n", file_name, cell(file["radius_mm"]), cell(file["speed_rpm"]),
                              cell(file["load_N"]));
    }
    index += known_of_it.dump() + "\n";
    truth += truth_of(name, record).dump() + "\n";
    if (done) done(k + 1);
  }
  write_file(root / "records" / "index.jsonl", index);
  write_file(root / "records" / "manifest.csv", manifest);
  write_file(root / "truth" / "truth.jsonl", truth);
  write_file(root / "README.md", export_readme(records.size(), seed));
}

}  // namespace recovery
