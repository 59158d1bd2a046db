/// The benchmark of hidden effects: simulates, diagnoses, judges, and prints the tables of data/validation.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "hidden_effects.hpp"
#include "hidden_recipes.hpp"
#include "hidden_tables.hpp"

namespace recovery {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Name, added, equivalent)

void to_json(nlohmann::json& j, const Recovered& p) {
  j = {{"effect", p.key},  {"name", p.parameter},      {"truth", p.truth},
       {"value", p.value}, {"std_error", p.std_error}, {"ci95", {p.lower95, p.upper95}}};
}

/// What is no number is written as null.
void from_json(const nlohmann::json& j, Recovered& p) {
  const auto number = [](const nlohmann::json& x) { return x.is_number() ? x.get<double>() : NAN; };
  p = {j.at("effect"),           j.at("name"),
       number(j.at("truth")),    number(j.at("value")),
       number(j.at("ci95")[0]),  number(j.at("ci95")[1]),
       number(j.at("std_error"))};
}

}  // namespace recovery

namespace {

using namespace recovery;
using nlohmann::json;

struct Options {
  PlanOptions plan;
  std::vector<std::string> kinds;
  std::size_t records = 20;
  std::optional<std::size_t> empty;
  std::string only, one, json_path;
  int threads = 0;
  bool quiet = false, experiments = true, asked = false, coverage = false, known = false, only_known = false,
       halved = false;
};

std::string describe(const Name& name) {
  std::string text = name.added;
  for (const std::string& other : name.equivalent) text += "|" + other;
  return text;
}

std::string names(const std::vector<Name>& all) {
  std::string text;
  for (const Name& name : all) text += (text.empty() ? "" : ", ") + describe(name);
  return text.empty() ? "nothing" : text;
}

std::string line(const Outcome& o) {
  if (!o.failure.empty()) return fmt::format("THREW {:<34} {}", o.tested.name, o.failure);
  return fmt::format("{:<5} {:<34} {:<8} {} ({}{}){}; error {:.5f} -> {:.5f}, floor {:.5f}; {:.1f} s",
                     o.right ? "ok" : "MISS", o.tested.name, to_string(o.naming), names(o.names),
                     tribofit::to_string(o.verdict), o.remaining.empty() ? "" : ", remaining over " + o.remaining,
                     o.partners.empty() ? "" : (o.split ? "; split: " : "; NOT SPLIT: ") + names(o.after), o.first,
                     o.last, o.floor, o.seconds);
}

json json_of(const Outcome& o) {
  json hidden = json::array();
  for (const Ingredient& what : o.tested.hidden) hidden.push_back({{"key", what.key}, {"values", what.values}});
  return {{"case", o.tested.name},
          {"kind", to_string(o.tested.kind)},
          {"setting", to_string(o.tested.setting)},
          {"record_kind", o.tested.record_kind},
          {"seed", o.tested.seed},
          {"hidden", hidden},
          {"law", tribofit::to_string(o.tested.law)},
          {"radius_mm", o.tested.radius * 1e3},
          {"noise_colour", o.tested.colour},
          {"noise_flicker", o.tested.flicker},
          {"scatter", o.tested.scatter},
          {"wander", o.tested.wander},
          {"named", o.names},
          {"after", o.after},
          {"naming", to_string(o.naming)},
          {"right", o.right},
          {"verdict", tribofit::to_string(o.verdict)},
          {"law_found", tribofit::to_string(o.law)},
          {"remaining", o.remaining},
          {"remaining_share", o.remaining_share},
          {"status", o.status},
          {"next_experiment", o.experiment},
          {"partners", o.partners},
          {"split", o.split},
          {"held_out_rmse", {o.first, o.last}},
          {"floor_rmse", o.floor},
          {"parameters", o.parameters},
          {"parameters_of_law", o.of_law},
          {"parameters_where_known", o.known},
          {"seconds", o.seconds},
          {"failure", o.failure}};
}

Outcome outcome_from(const Case& c, const json& j) {
  Outcome o;
  o.tested = c;
  o.names = j.at("named").get<std::vector<Name>>();
  o.after = j.at("after").get<std::vector<Name>>();
  using tribofit::Verdict;
  for (int k = 0; k <= static_cast<int>(Verdict::unfinished); ++k) {
    if (j.at("verdict") == to_string(static_cast<Verdict>(k))) o.verdict = static_cast<Verdict>(k);
  }
  o.law = tribofit::make_law(j.at("law_found").get<std::string>());
  j.at("remaining").get_to(o.remaining);
  j.at("remaining_share").get_to(o.remaining_share);
  j.at("status").get_to(o.status);
  j.at("partners").get_to(o.partners);
  j.at("split").get_to(o.split);
  o.first = j.at("held_out_rmse")[0], o.last = j.at("held_out_rmse")[1];
  j.at("floor_rmse").get_to(o.floor);
  j.at("parameters").get_to(o.parameters);
  j.at("parameters_of_law").get_to(o.of_law);
  j.at("parameters_where_known").get_to(o.known);
  j.at("seconds").get_to(o.seconds);
  j.at("failure").get_to(o.failure);
  judge(o);
  return o;
}

/// Outcomes of cases of this plan that stand in a file of an earlier run, each in a line; the cases are taken from the
/// plan.
std::vector<Outcome> take_known(const std::string& path, std::vector<Case>& cases) {
  std::vector<Outcome> known;
  std::ifstream file(path);
  for (std::string text; std::getline(file, text);) {
    const json j = json::parse(text, nullptr, false);
    if (j.is_discarded()) continue;  // the last one, where the run was stopped
    const auto at = std::find_if(cases.begin(), cases.end(), [&](const Case& c) { return j.at("case") == c.name; });
    if (at == cases.end() || j.at("seed") != at->seed) continue;
    known.push_back(outcome_from(*at, j));
    cases.erase(at);
  }
  return known;
}

/// One case in full, as a user would see it.
void explain(const Case& c) {
  const Outcome outcome = run_case(c, {.experiments = true});
  fmt::print("{}\n{}\n", line(outcome), json_of(outcome).dump(1));
  const auto diagnosed = diagnose_case(simulate_case(c)).diagnosis;
  for (const auto& finding : diagnosed.effects) {
    fmt::print("{:<24} {:<12} error {:.5f}, takes away {:.3f}, p {:.2g}; {}\n", finding.key,
               tribofit::to_string(finding.status), finding.held_out_rmse, finding.error_reduction, finding.p_value,
               finding.reason);
    for (const auto& p : finding.parameters) {
      if (p.effect != finding.key) continue;
      fmt::print("    {} = {:.5g} ({:.5g} .. {:.5g}) {}\n", p.parameter.name, p.value / p.parameter.si,
                 p.lower95 / p.parameter.si, p.upper95 / p.parameter.si, p.parameter.unit);
    }
  }
  for (const auto& rung : diagnosed.ladder) fmt::print("rung {:<20} {:.5f}\n", rung.added, rung.held_out_rmse);
  for (const auto& share : diagnosed.remaining) {
    fmt::print("remaining {:<12} {:.3f}, p {:.2g}\n", tribofit::to_string(share.variable), share.share, share.p_value);
  }
  for (const std::string& message : diagnosed.messages) fmt::print("{}\n", message);
  fmt::print("next: {}\n", diagnosed.next_experiment);
}

std::vector<Case> plan(Options options) {
  if (!options.experiments) options.plan.look_alikes = 0;
  if (options.kinds.empty() && !options.asked) return plan_cases(options.plan);
  if (!options.kinds.empty() && options.kinds.front() == "all") options.kinds.clear();
  if (options.asked) return plan_asked_of_sliding(options.kinds, options.records, options.plan.seed);
  const std::size_t empty = options.empty.value_or(options.records);
  return plan_record_kinds(options.kinds, empty, options.empty ? 0 : options.records, options.plan.seed);
}

void in_order_of(const std::vector<Case>& plan, std::vector<Outcome>& outcomes) {
  std::map<std::string, std::size_t> places;
  for (const Case& c : plan) places.emplace(c.name, places.size());
  std::stable_sort(outcomes.begin(), outcomes.end(), [&](const Outcome& a, const Outcome& b) {
    return places.at(a.tested.name) < places.at(b.tested.name);
  });
}

int run(const Options& options) {
  std::vector<Case> cases = plan(options);
  if (!options.one.empty()) {
    for (const Case& c : cases) {
      if (c.name != options.one) continue;
      explain(c);
      return 0;
    }
    fmt::print(stderr, "no case '{}' in this plan: give --runs, --nothing and --seed as in the run it comes from\n",
               options.one);
    return 2;
  }
  if (options.halved) cases = recovery::halved(std::move(cases));
  std::erase_if(cases, [&](const Case& c) {
    std::stringstream all(options.only);
    for (std::string one; std::getline(all, one, ';');) {
      if (c.name.find(one) != std::string::npos) return false;
    }
    return !options.only.empty();
  });
  const RunOptions run_options = {.experiments = options.experiments,
                                  .known = options.known || options.only_known,
                                  .diagnose = !options.only_known};
  std::vector<Outcome> outcomes = take_known(options.json_path, cases);
  // In any order, so that what a run has done until it is stopped stands for all.
  std::stable_sort(cases.begin(), cases.end(),
                   [](const Case& a, const Case& b) { return hash(a.name, 0) < hash(b.name, 0); });
  std::ofstream json_lines(options.json_path, std::ios::app);
  for (Outcome& outcome : run_cases(cases, options.threads, run_options, [&](const Outcome&o, std::size_t done) {
         if (!options.quiet) fmt::print(stderr, "{}/{} {}\n", done, cases.size(), line(o));
         json_lines << json_of(o).dump() << std::endl;
       })) {
    outcomes.push_back(std::move(outcome));
  }
  in_order_of(plan(options), outcomes);
  if (options.coverage || options.only_known) fmt::print("{}\n", coverage_table(outcomes));
  if (options.only_known) return 0;
  if (options.kinds.empty() && !options.asked) {
    fmt::print("{}", tables(outcomes));
    return 0;
  }
  const Outcomes empties = of_kind(outcomes, Kind::nothing);
  Outcomes others;
  for (const Outcome& o : outcomes) {
    if (o.tested.kind != Kind::nothing) others.push_back(&o);
  }
  if (!empties.empty()) fmt::print("{}\n", empties_table(empties));
  if (!others.empty()) fmt::print("{}\n", groups_table(others));
  for (const Outcome& o : outcomes) {
    const bool is_quiet = o.tested.kind == Kind::nothing && o.names.empty() && o.failure.empty();
    if (!o.right && !is_quiet) fmt::print("- {}\n", line(o));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Diagnoses records in which effects of the catalogue are hidden, and counts what was named");
  app.add_option("--runs", options.plan.runs, "cases of each effect and size")->capture_default_str();
  app.add_option("--pairs", options.plan.pairs, "cases of each pair")->capture_default_str();
  app.add_option("--triples", options.plan.triples, "cases of each three")->capture_default_str();
  app.add_option("--nothing", options.plan.nothing, "cases with nothing hidden")->capture_default_str();
  app.add_option("--aliens", options.plan.aliens, "cases of each effect in no catalogue")->capture_default_str();
  app.add_option("--unknowable", options.plan.unknowable, "cases of ageing at one constant speed")
      ->capture_default_str();
  app.add_option("--look-alikes", options.plan.look_alikes, "cases of each pair that looks alike, for each of the two")
      ->capture_default_str();
  app.add_option("--kinds", options.kinds,
                 "instead of those cases, records of these kinds: all, or some of " +
                     fmt::format("{}", fmt::join(record_kinds(), ", ")))
      ->delimiter(',');
  app.add_option("--records", options.records, "of each kind: so many with nothing hidden, and so many with an effect")
      ->capture_default_str();
  app.add_option("--empty", options.empty, "of each kind: only so many with nothing hidden");
  app.add_flag("--asked", options.asked,
               "of each kind of sliding: viscous, drift, asymmetry, a logarithmic law, and Stribeck curves with "
               "viscous friction");
  app.add_option("--seed", options.plan.seed, "of all cases")->capture_default_str();
  app.add_flag("--halved", options.halved, "records half as long where that is enough, as in the tests");
  app.add_flag("--coverage", options.coverage, "how often the intervals of effects that were named hold the truth");
  app.add_flag("--known", options.known, "the same where law and effects are known, beside --coverage");
  app.add_flag("--only-known", options.only_known, "only that: nothing is diagnosed");
  app.add_option(
      "--only", options.only,
      "only cases whose name holds this (or one of these, with ; between), e.g. runout, 'drift=', nothing, +, ~");
  app.add_option("--case", options.one, "one case by name, in full");
  app.add_option("--json", options.json_path,
                 "a line for each case; those that stand there from an earlier run are not run again");
  app.add_option("--threads", options.threads, "0: as many as there are; results do not depend on it");
  app.add_flag("!--no-experiments", options.experiments, "do not simulate the next experiment where a group was named");
  app.add_flag("--quiet", options.quiet, "no line for each case");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& e) {
    fmt::print(stderr, "hidden_effects_benchmark: {}\n", e.what());
    return 2;
  }
}
