/// What the outcomes say, as Markdown.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "hidden_tables.hpp"

namespace recovery {

using namespace tribofit;

namespace {

bool is_low(const Outcome* o) {
  return o->last > 0 && o->last <= 1.15 * o->floor;
}
bool was_tried(const Outcome* o) {
  return !o->partners.empty();
}
bool failed(const Outcome* o) {
  return !o->failure.empty();
}

std::string mean_group(const Outcomes& outcomes) {
  double sum = 0;
  std::size_t n = 0;
  for (const Outcome* o : outcomes) {
    if (o->group_size == 0) continue;
    sum += static_cast<double>(o->group_size);
    ++n;
  }
  return n == 0 ? "" : fmt::format("{:.1f}", sum / static_cast<double>(n));
}

void add_row(std::string& text, const std::string& name, const Outcomes& g) {
  const Parameters p = parameters(g);
  fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name, g.size(),
                 count(g, Naming::alone), count(g, Naming::group), count(g, Naming::beside), count(g, Naming::wrong),
                 count(g, Naming::missed), mean_group(g), percent(count(g, is_low), g.size()), percent(p.close, p.n),
                 percent(p.covered, p.intervals));
}

std::string singles_table(const Outcomes& singles) {
  std::string text =
      "| hidden | n | alone | in a group of at most 4 | beside another | wrong | missed | mean group | "
      "error within 1.15 | parameter within 10 % | inside 95 % |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
  for (const Outcomes& g : by_group(singles)) add_row(text, fmt::format("`{}`", g[0]->tested.group), g);
  add_row(text, "all", singles);
  return text;
}

std::string pairs_table(const Outcomes& pairs) {
  std::string text =
      "| hidden | n | all | all, beside another | some | none | nothing | error within 1.15 |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|\n";
  const auto row = [&](const std::string& name, const Outcomes& g) {
    fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} | {} | {} | {} |\n", name, g.size(),
                   count(g, is_right), count(g, Naming::beside), count(g, Naming::partly), count(g, Naming::wrong),
                   count(g, Naming::missed), percent(count(g, is_low), g.size()));
  };
  for (const Outcomes& g : by_group(pairs)) row(fmt::format("`{}`", g[0]->tested.group), g);
  row("all", pairs);
  return text;
}

/// Confusion matrix without its zeros: a row for each hidden effect, what was said to be missing, and what was offered
/// beside it as equal.
std::string confusion_table(const Outcomes& singles) {
  struct Row {
    std::size_t n = 0;
    std::map<std::string, std::size_t> added, equal;
  };
  std::vector<std::string> order;
  std::map<std::string, Row> rows;
  for (const Outcome* o : singles) {
    const std::string& key = o->tested.hidden[0].key;
    if (rows.count(key) == 0) order.push_back(key);
    Row& row = rows[key];
    ++row.n;
    if (o->names.empty()) ++row.added["nothing"];
    for (const Name& name : o->names) {
      ++row.added[name.added];
      for (const std::string& other : name.equivalent) ++row.equal[other];
    }
  }
  std::string text = "| hidden | n | named | offered as equal |\n|---|--:|---|---|\n";
  for (const std::string& key : order) {
    const Row& row = rows[key];
    fmt::format_to(std::back_inserter(text), "| `{}` | {} | {} | {} |\n", key, row.n, list(row.added), list(row.equal));
  }
  return text;
}

/// Of groups that formed, and of pairs of the catalogue that look alike.
std::string experiments_table(const Outcomes& tried) {
  std::map<std::pair<std::string, std::string>, std::pair<std::size_t, std::size_t>> groups;
  for (const Outcome* o : tried) {
    std::string partners;
    for (const std::string& partner : o->partners) partners += (partners.empty() ? "`" : ", `") + partner + "`";
    auto& [n, split] = groups[{o->tested.hidden[0].key, partners}];
    ++n;
    split += o->split ? 1u : 0u;
  }
  std::string text = "| hidden | to distinguish from | n | distinguished |\n|---|---|--:|--:|\n";
  for (const auto& [group, counts] : groups) {
    fmt::format_to(std::back_inserter(text), "| `{}` | {} | {} | {} |\n", group.first, group.second, counts.first,
                   counts.second);
  }
  return text;
}

std::string others_table(const Outcomes& outcomes) {
  std::string text =
      "| hidden | n | right | something named all the same | verdicts | largest remaining share over |\n"
      "|---|--:|--:|--:|---|---|\n";
  for (const Outcomes& g : by_group(outcomes)) {
    std::map<std::string, std::size_t> verdicts, variables;
    for (const Outcome* o : g) {
      ++verdicts[std::string(to_string(o->verdict))];
      ++variables[o->remaining.empty() ? "none" : o->remaining];
    }
    fmt::format_to(std::back_inserter(text), "| `{}` | {} | {} | {} | {} | {} |\n", g[0]->tested.group, g.size(),
                   count(g, is_right), count(g, [](const Outcome* o) { return !o->names.empty(); }), list(verdicts),
                   list(variables));
  }
  return text;
}

/// By what is not the effect: is one radius, law or noise worse than the others?
std::string conditions_table(const Outcomes& outcomes) {
  std::string text = "| condition | n | named (95 % interval) |\n|---|--:|--:|\n";
  const auto row = [&](const std::string& name, auto&& belongs) {
    Outcomes g;
    std::copy_if(outcomes.begin(), outcomes.end(), std::back_inserter(g), belongs);
    if (g.empty()) return;
    fmt::format_to(std::back_inserter(text), "| {} | {} | {} |\n", name, g.size(), share(count(g, is_right), g.size()));
  };
  for (const Law& law : {Law(ExponentialLaw{}), Law(FractionalLaw{})}) {
    row(std::string(to_string(law)), [&](const Outcome* o) { return o->tested.law == law; });
  }
  for (const double radius : {0.009, 0.012, 0.015, 0.018}) {
    row(fmt::format("{:g} mm", radius * 1e3), [&](const Outcome* o) { return o->tested.radius == radius; });
  }
  row("white noise", [](const Outcome* o) { return o->tested.colour == 0; });
  row("AR(1) 0.9 noise", [](const Outcome* o) { return o->tested.colour > 0; });
  row("independent scatter", [](const Outcome* o) { return o->tested.wander == 0; });
  row("wandering scatter", [](const Outcome* o) { return o->tested.wander > 0; });
  row("scatter below 0.01", [](const Outcome* o) { return o->tested.scatter < 0.01; });
  row("scatter 0.01 to 0.02", [](const Outcome* o) { return o->tested.scatter >= 0.01; });
  return text;
}

std::string summary(const std::vector<Outcome>& all) {
  const Outcomes singles = of_kind(all, Kind::single), pairs = of_kind(all, Kind::pair),
                 empties = of_kind(all, Kind::nothing), aliens = of_kind(all, Kind::alien),
                 unknowable = of_kind(all, Kind::unknowable);
  std::string text = "| what is asked | of | figure (95 % interval) |\n|---|--:|--:|\n";
  const auto row = [&](const char* name, std::size_t n, const std::string& figure) {
    if (n > 0) fmt::format_to(std::back_inserter(text), "| {} | {} | {} |\n", name, n, figure);
  };
  const auto share = [&](const char* name, const Outcomes& asked, const auto& what) {
    row(name, asked.size(), recovery::share(count(asked, what), asked.size()));
  };
  share("single effects named, alone or in a group of at most 4", singles, is_right);
  share("single effects named alone", singles, [](const Outcome* o) { return o->naming == Naming::alone; });
  share("pairs of which both are named", pairs, is_right);
  share("threes of which all are named", of_kind(all, Kind::triple), is_right);
  const std::size_t alarms = empties.size() - count(empties, is_right);
  row("something named, or left unexplained, where nothing is hidden", empties.size(),
      recovery::share(alarms, empties.size()));
  share("effects of no catalogue called unexplained over the right variable", aliens, is_right);
  share("ageing at one constant speed called untestable", unknowable, is_right);
  Outcomes named;
  for (const Outcomes& asked : {singles, pairs})
    std::copy_if(asked.begin(), asked.end(), std::back_inserter(named), is_right);
  share("held-out error within 1.15 times what the true law leaves, where named", named, is_low);
  const Parameters p = parameters(named);
  row("main parameters within 10 %", p.n, recovery::share(p.close, p.n));
  row("main parameters inside their 95 % interval", p.intervals, recovery::share(p.covered, p.intervals));
  row("mean size of the group that holds the hidden effect", singles.size(), mean_group(singles));
  Outcomes tried;
  std::copy_if(singles.begin(), singles.end(), std::back_inserter(tried), was_tried);
  share("next experiment, simulated, splits its group", tried, [](const Outcome* o) { return o->split; });
  share("pairs that look alike distinguished by the experiment of the catalogue", of_kind(all, Kind::look_alike),
        is_right);
  double seconds = 0, slowest = 0;
  std::size_t failures = 0;
  for (const Outcome& o : all) {
    seconds += o.seconds;
    slowest = std::max(slowest, o.seconds);
    failures += failed(&o) ? 1u : 0u;
  }
  row("processor seconds of a diagnosis, mean (longest)", all.size(),
      fmt::format("{:.2f} ({:.2f})", seconds / static_cast<double>(std::max<std::size_t>(1, all.size())), slowest));
  row("cases that threw", failures, fmt::format("{}", failures));
  return text;
}

}  // namespace

std::string tables(const std::vector<Outcome>& all) {
  std::string text = summary(all);
  const auto section = [&](const char* title, const Outcomes& asked, auto&& table) {
    if (!asked.empty()) fmt::format_to(std::back_inserter(text), "\n**{}**\n\n{}", title, table(asked));
  };
  const Outcomes singles = of_kind(all, Kind::single);
  section("One effect hidden", singles, singles_table);
  section("Two effects hidden", of_kind(all, Kind::pair), pairs_table);
  section("Three effects hidden", of_kind(all, Kind::triple), pairs_table);
  section("Nothing hidden", of_kind(all, Kind::nothing), empties_table);
  Outcomes others = of_kind(all, Kind::alien);
  const Outcomes unknowable = of_kind(all, Kind::unknowable);
  others.insert(others.end(), unknowable.begin(), unknowable.end());
  section("In no catalogue, or not to be seen in these data", others, others_table);
  section("What was named for what was hidden", singles, confusion_table);
  Outcomes tried;
  std::copy_if(singles.begin(), singles.end(), std::back_inserter(tried), was_tried);
  section("The next experiment, simulated", tried, experiments_table);
  section("Pairs that look alike, after the experiment of the catalogue", of_kind(all, Kind::look_alike),
          experiments_table);
  section("By condition, single effects", singles, conditions_table);
  return text;
}

}  // namespace recovery
