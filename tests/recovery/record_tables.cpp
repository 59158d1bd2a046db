/// Tables of other kinds of record, of what is asked of sliding, and of intervals after naming.
#include <string>

#include "hidden_tables.hpp"

namespace recovery {

using namespace tribofit;

std::string record_kinds_table(const std::vector<Outcome>& outcomes) {
  std::string text =
      "| kind of record | empty | false alarms | rate at most (95 %) | alarms | loaded | named | alone | wrong | "
      "missed | "
      "inside 95 % |\n|---|--:|--:|--:|---|--:|--:|--:|--:|--:|--:|\n";
  const auto row = [&](const std::string& name, const Outcomes& all) {
    Outcomes empty, loaded;
    for (const Outcome* o : all) (o->tested.kind == Kind::nothing ? empty : loaded).push_back(o);
    const std::size_t alarms = empty.size() - count(empty, is_right);
    const Parameters p = parameters(loaded);
    fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name,
                   empty.size(), alarms,
                   empty.empty() ? "" : fmt::format("{:.1f} %", 100 * upper_bound_95(alarms, empty.size())),
                   list(alarms_of(empty)), loaded.size(), percent(count(loaded, is_right), loaded.size()),
                   count(loaded, Naming::alone), count(loaded, Naming::wrong) + count(loaded, Naming::beside),
                   count(loaded, Naming::missed), percent(p.covered, p.n));
  };
  std::map<std::string, Outcomes> kinds;
  Outcomes all;
  for (const Outcome& o : outcomes) {
    kinds[o.tested.record_kind].push_back(&o);
    kinds[o.tested.flicker      ? "with 1/f noise"
          : o.tested.colour > 0 ? "with AR(1) noise"
                                : "with white noise"]
        .push_back(&o);
    all.push_back(&o);
  }
  for (const auto& [name, cases] : kinds) row(name, cases);
  row("all", all);
  return text;
}

std::string groups_table(const std::vector<Outcome>& outcomes) {
  std::string text = "| asked | n | named | beside another | something else | nothing |\n|---|--:|--:|--:|--:|--:|\n";
  Outcomes all;
  for (const Outcome& o : outcomes) all.push_back(&o);
  const auto row = [&](const std::string& name, const Outcomes& g) {
    const auto wrong = [](Naming naming) {
      return [naming](const Outcome* o) { return !o->right && o->naming == naming; };
    };
    fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} | {} |\n", name, g.size(),
                   percent(count(g, is_right), g.size()), count(g, wrong(Naming::beside)),
                   count(g, wrong(Naming::wrong)), count(g, wrong(Naming::missed)));
  };
  for (const Outcomes& g : by_group(all)) row(g[0]->tested.group, g);
  row("all", all);
  return text;
}

namespace {

/// Intervals of effects that the ladder found.
struct Coverage {
  std::size_t n = 0, covered = 0;

  void add(const Recovered& p) {
    ++n;
    covered += p.is_covered() ? 1u : 0u;
  }
};

/// Where the effects were found, and where law and effects were known.
struct Coverages {
  Coverage found, known;
};

std::string cells(const Coverage& coverage) {
  return fmt::format("{} | {} | {}", coverage.n, coverage.covered, percent(coverage.covered, coverage.n));
}

std::string noise_of(const Case& c) {
  return fmt::format("{} noise, {} scatter",
                     c.flicker      ? "1/f"
                     : c.colour > 0 ? "AR(1) 0.9"
                                    : "white",
                     c.wander > 0 ? "wandering" : "independent");
}

}  // namespace

std::string coverage_table(const std::vector<Outcome>& outcomes) {
  constexpr const char* kAll = "all";
  std::map<std::string, Coverages> by_condition, by_parameter;
  for (const Outcome& o : outcomes) {
    const auto add = [&](Coverage Coverages::*which, const Recovered& p) {
      for (const std::string& name :
           {fmt::format("{} hidden", o.tested.hidden.size()), noise_of(o.tested),
            fmt::format("named {}", to_string(o.naming)),
            std::string(o.law == o.tested.law ? "the law itself" : "another law"), std::string(kAll)}) {
        (by_condition[name].*which).add(p);
      }
      (by_parameter[fmt::format("`{}` {}", p.key, p.parameter)].*which).add(p);
    };
    for (const Recovered& p : o.parameters) add(&Coverages::found, p);
    for (const Recovered& p : o.known) add(&Coverages::known, p);
  }
  std::string text =
      "| 95 % intervals | after naming | hold the truth | | where known | hold the truth | |\n"
      "|---|--:|--:|--:|--:|--:|--:|\n";
  for (const auto* rows : {&by_condition, &by_parameter}) {
    for (const auto& [name, coverages] : *rows) {
      fmt::format_to(std::back_inserter(text), "| {} | {} | {} |\n", name, cells(coverages.found),
                     cells(coverages.known));
    }
  }
  return text;
}

}  // namespace recovery
