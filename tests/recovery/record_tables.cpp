/// Tables of records with nothing hidden, of what is asked of sliding, and of intervals after naming.
#include <string>

#include "hidden_tables.hpp"

namespace recovery {

using namespace tribofit;

namespace {

/// How many intervals hold the truth.
struct Coverage {
  std::size_t n = 0, covered = 0;

  void add(const Recovered& p) {
    if (!p.has_interval()) return;
    ++n;
    covered += p.is_covered() ? 1u : 0u;
  }
  std::string cell() const { return n == 0 ? "" : fmt::format("{} of {}: {}", covered, n, share(covered, n)); }
};

/// Where the effects were found, and where law and effects were known.
struct Coverages {
  Coverage found, known;
};

std::string noise_of(const Case& c) {
  return fmt::format("{} noise, {} scatter",
                     c.flicker      ? "1/f"
                     : c.colour > 0 ? "AR(1) 0.9"
                                    : "white",
                     c.wander > 0 ? "wandering" : "independent");
}

}  // namespace

std::string empties_table(const Outcomes& empties) {
  std::string text =
      "| nothing hidden | n | something named | rate (95 %) | named | called unexplained | other verdicts | the law "
      "itself | its 95 % intervals hold the truth |\n|---|--:|--:|--:|---|--:|---|--:|--:|\n";
  const auto row = [&](const std::string& name, const Outcomes& all) {
    std::map<std::string, std::size_t> named, verdicts;
    std::size_t alarms = 0, unexplained = 0, right_law = 0;
    Coverage law;
    for (const Outcome* o : all) {
      for (const Name& n : o->names) ++named[n.added];
      alarms += o->names.empty() ? 0u : 1u;
      right_law += o->law == o->tested.law ? 1u : 0u;
      for (const Recovered& p : o->of_law) law.add(p);
      if (o->verdict == Verdict::unexplained) {
        ++unexplained;
      } else if (o->verdict != Verdict::sufficient && o->names.empty()) {
        ++verdicts[std::string(o->failure.empty() ? to_string(o->verdict) : "no result")];
      }
    }
    fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name, all.size(),
                   alarms, share(alarms, all.size()), list(named), share(unexplained, all.size()), list(verdicts),
                   share(right_law, all.size()), law.cell());
  };
  std::map<std::string, Outcomes> kinds;
  for (const Outcome* o : empties) {
    const Case& c = o->tested;
    const double scatter = c.level_scatter > 0 ? c.level_scatter : c.scatter / c.friction[0];
    kinds[c.record_kind.empty() ? std::string(to_string(c.setting)) : c.record_kind].push_back(o);
    kinds[c.flicker ? "with 1/f noise" : c.colour > 0 ? "with AR(1) noise" : "with white noise"].push_back(o);
    if (c.programme == Programme::stick_slip) {
      kinds[fmt::format("{} scatter {}", c.wander > 0 ? "wandering" : "independent",
                        scatter < 0.01   ? "below 1 %"
                        : scatter < 0.02 ? "of 1 to 2 %"
                                         : "above 2 %")]
          .push_back(o);
    }
  }
  for (const auto& [name, cases] : kinds) row(name, cases);
  row("all", empties);
  return text;
}

std::string groups_table(const Outcomes& all) {
  std::string text = "| asked | n | named | beside another | something else | nothing |\n|---|--:|--:|--:|--:|--:|\n";
  const auto row = [&](const std::string& name, const Outcomes& g) {
    const auto wrong = [](Naming naming) {
      return [naming](const Outcome* o) { return !o->right && o->naming == naming; };
    };
    fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} | {} |\n", name, g.size(),
                   share(count(g, is_right), g.size()), count(g, wrong(Naming::beside)), count(g, wrong(Naming::wrong)),
                   count(g, wrong(Naming::missed)));
  };
  for (const Outcomes& g : by_group(all)) row(g[0]->tested.group, g);
  row("all", all);
  return text;
}

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
    for (const Recovered& p : o.of_law) by_parameter[fmt::format("{} law, {}", p.key, p.parameter)].found.add(p);
  }
  std::string text =
      "| 95 % intervals | hold the truth after naming | where law and effects are known |\n|---|--:|--:|\n";
  for (const auto* rows : {&by_condition, &by_parameter}) {
    for (const auto& [name, coverages] : *rows) {
      fmt::format_to(std::back_inserter(text), "| {} | {} | {} |\n", name, coverages.found.cell(),
                     coverages.known.cell());
    }
  }
  return text;
}

}  // namespace recovery
