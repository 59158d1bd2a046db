#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>

#include "tribofit/campaign/run_result.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/friction/laws/all.hpp"
#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/ingest/conditions.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/text_of_file.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/output/text.hpp"
#include "tribofit/version.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMethod =
    "The method\n"
    "  Solver: S. Agarwal, K. Mierle and the Ceres Solver team, Ceres Solver 2.1, http://ceres-solver.org\n"
    "  Break-away that differs from cycle to cycle: N. M. Laird, J. H. Ware, Biometrics 38 (1982) 963,\n"
    "    doi:10.2307/2529876\n"
    "  Slow noise: P. Whittle, Ark. Mat. 2 (1953) 423; M. S. Keshner, Proc. IEEE 70 (1982) 212\n";

/// The source of a law or an effect, as a line; throws a UsageError where there is none of that name.
std::string source_of(const std::string& name) {
  std::vector<std::string> known;
  for (const Law& law : law_catalogue()) {
    const LawInfo info = describe(law);
    const std::string key(to_string(law));
    if (key == name) return fmt::format("  {} law: {}; {}\n", name, info.equation, info.source);
    known.push_back(key);
  }
  for (const StateEvolution evolution : state_evolutions) {
    if (law_name(evolution) == name)
      return fmt::format("  {}: {}; {}\n", name, equation_of(evolution), source_of(evolution));
    known.push_back(law_name(evolution));
  }
  for (const Effect& effect : effect_catalogue()) {
    const EffectInfo info = describe(effect);
    if (info.key == name.substr(0, name.find(':'))) return fmt::format("  {}: {}\n", name, info.source);
    known.push_back(info.key);
  }
  throw UsageError(fmt::format("'{}' is neither a law, an effect nor a result (.json){}; 'identify effects' lists them",
                               name, did_you_mean(name, known)));
}

std::string text_in(const Json& json, const char* name) {
  return json.at(name).get<std::string>();
}

/// A value with two digits of its standard error, its interval and its unit.
std::string value_of(const Json& parameter) {
  const std::string effect = parameter.at("effect").is_null() ? "" : text_in(parameter, "effect");
  const std::string name = full_name(text_in(parameter, "name"), effect);
  const double value = parameter.at("value").get<double>();
  const std::string unit = unit_behind(text_in(parameter, "unit"));
  if (!parameter.at("std_error").is_number()) return fmt::format("{} = {}{} (held)", name, general(value), unit);
  const double error = parameter.at("std_error").get<double>();
  std::string text = fmt::format("{} = ({}){}", name, with_error(value, error), unit);
  const Json& interval = parameter.at("ci95");
  if (interval.is_array() && interval.at(0).is_number() && interval.at(1).is_number()) {
    text += " " + interval_text(interval.at(0).get<double>(), interval.at(1).get<double>(), places_for(error));
  }
  return text;
}

std::string conditions_of(const Json& result) {
  const Json& conditions = result.at("conditions");
  std::string text;
  for (const ConditionInfo& info : condition_infos) {
    const Json value = conditions.value(info.column, Json());
    if (!value.is_number()) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", general(value.get<double>(), 4), info.unit);
  }
  return text.empty() ? "" : " (" + text + ")";
}

/// What a paper says of one run, and the names whose sources it cites.
std::string paragraph_of(const Json& result, std::vector<std::string>& names) {
  const Json& fit = result.at("fits").at(result.at("best").get<std::size_t>());
  const Json& trace = result.at("trace");
  names = fit.at("effects").get<std::vector<std::string>>();
  const std::string effects = names.empty() ? "" : fmt::format(" with {}", fmt::join(names, " and "));
  names.insert(names.begin(), text_in(fit, "law"));
  const std::string cycles = fit.at("cycles").is_number() && fit.at("cycles").get<int>() > 0
                                 ? fmt::format(" over {} cycles", fit.at("cycles").get<int>())
                                 : "";
  std::string text = fmt::format("  From a {} record of {} samples{} the {} law{} was identified with tribofit {}{}: ",
                                 text_in(trace, "kind"), trace.at("samples").get<long long>(), conditions_of(result),
                                 names[0], effects, text_in(result.at("tool"), "version"), cycles);
  std::vector<std::string> values;
  for (const Json& parameter : fit.at("parameters")) values.push_back(value_of(parameter));
  text += fmt::format("{} (value +/- standard error [95 % interval]).", fmt::join(values, "; "));
  const Json& error = fit.at("error").at("held_out_rmse");
  if (error.is_number() && fit.at("floor_rmse").is_number()) {
    text += fmt::format(" The error on what was held out of the fit is {} (RMSE), the noise floor {}.",
                        general(error.get<double>(), 3), general(fit.at("floor_rmse").get<double>(), 3));
  }
  if (fit.at("conditional").get<bool>())
    text += " The law does not hold to the noise floor: errors and intervals are conditional on it.";
  const Json diagnosis = result.value("diagnosis", Json());
  if (diagnosis.is_object()) text += fmt::format(" Verdict of the diagnosis: {}.", text_in(diagnosis, "verdict"));
  return text + fmt::format(" Checksum of the record: {}.\n", text_in(trace, "checksum"));
}

std::string paragraph_of_file(const std::string& path, std::vector<std::string>& names) {
  const InputLocation where{path, 0, ""};
  const std::string text = text_of_file(path, std::uint64_t{1} << 30, "give a file that --json wrote");
  if (is_nested_deeper(text)) throw InputError("is nested too deeply", "give a file that --json wrote", where);
  try {
    return paragraph_of(Json::parse(text), names);
  } catch (const Json::exception&) {
    throw InputError("is not the result of one trace",
                     "give a file that 'identify --json' or 'identify diagnose --json' wrote", where);
  }
}

std::string citation(const std::vector<std::string>& what) {
  std::string text = fmt::format(
      "tribofit {}: identification of friction laws from tribometer records. Computer program\n"
      "(CITATION.cff in its sources).\n\n{}",
      tribofit::version, kMethod);
  std::vector<std::string> names;
  std::string paragraphs;
  for (const std::string& one : what) {
    std::vector<std::string> found = {one};
    if (one.ends_with(".json")) paragraphs += "\n" + paragraph_of_file(one, found);
    for (const std::string& name : found) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  if (!names.empty()) text += "\nLaws and effects ([D]: see README)\n";
  for (const std::string& name : names) text += source_of(name);
  if (!paragraphs.empty()) text += "\nIn a paper" + paragraphs;
  return text;
}

}  // namespace

void add_cite(const Command& app) {
  const Command verb = app.add_verb(
      "cite", "How to cite tribofit, its method, and the sources of laws and effects",
      "A result that --json wrote is summarised in a paragraph for a paper, with the sources of what it uses.\n\n"
      "Examples:\n"
      "  identify cite\n"
      "  identify cite exponential runout\n"
      "  identify diagnose --radius 15mm --json found.json trace.csv && identify cite found.json");
  const auto what = std::make_shared<std::vector<std::string>>();
  verb.add_names("WHAT", *what, "Laws, effects, results (.json)");
  verb.on_run([what] {
    std::string text;
    for (const std::string& line : split(citation(*what), '\n'))
      text += folded(line, line.starts_with("  ") ? 4 : 0) + "\n";
    while (text.ends_with("\n\n")) text.pop_back();
    print(text);
  });
}
