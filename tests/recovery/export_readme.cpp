/// What is said to whoever takes part.
#include <fmt/format.h>

#include "exported_records.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/friction/laws/all.hpp"

namespace recovery {

using namespace tribofit;

namespace {

constexpr const char* kTask = R"(# Hidden effects: a benchmark

{records} simulated records of friction (seed {seed}). In most of them one or two physical effects are hidden beside a base
law; in some nothing is; in a few there is something that no list holds. The task, for each record:

- **name the effect**, or each of them, by the names of the list below; or a small group of names where the record cannot
  tell them apart;
- **give its parameters**, with 95 % intervals, in the units of the list;
- **stay silent** where nothing is hidden: noise, break-away that scatters (and wanders) from cycle to cycle, noise that is
  coloured or as 1/f are no effects;
- **say "unexplained"** where something is there that no name of the list explains.

## Files

- `records/index.jsonl`: one JSON object a line: `record`, `kind`, and the `files` of the record with what is known of each
  (`radius_mm`, `speed_rpm`, `load_N`; null: not stated, then it stands in a column or is not known). Several files are runs
  of one rig and have the same truth. `records/manifest.csv` says the same of each file.
- `records/*.csv`: columns with units in their names.
- `truth/truth.jsonl`: what was hidden. Do not read it before you answer.
- `score.py`: scores answers; Python 3.9 alone.

Kinds of record:

- `stick-slip`: a block on a spring against a rotating disc; `mu` and the velocity of the block `v_b_mm_s`. The sliding
  velocity is v_r = omega r - v_b, mu is positive when v_r is. In stick the spring sets mu, not the law. Rigs are of every
  size: slips last from a millisecond to a minute.
- `sliding`: the block stands still, the disc turns at `speed_rpm`; v_r = omega r.
- `points`: mu over `v_r_mm_s`, without time.
- `spring-slider`: a spring of known stiffness draws a mass at a constant speed; `pull_N` of the spring alone is recorded.
  The `spring` of the index gives `stiffness_N_per_mm`, `drive_mm_s` and `mass_kg`.

## Answers

One JSON object a line:

```
{{"record": "r001", "effects": [{{"effect": "viscous", "or": ["drift"], "parameters": {{"sigma": {{"value": 0.0011, "ci95": [0.0010, 0.0012]}}}}}}], "error_left": 0.0041}}
{{"record": "r002", "effects": []}}
{{"record": "r003", "effects": [], "unexplained": true}}
```

`or`, `parameters`, `ci95`, `unexplained` and `error_left` may be left out. `or` holds the other names of a group; a group
of more than four counts as no name. Parameters are those of `effect`. `error_left` is the root mean square of what the
whole model leaves of mu over the samples in which the block slides, as you state it; it is not checked.

## Score

`python3 score.py truth/truth.jsonl answers.jsonl` prints (`--json` as JSON): how often what was hidden was named (alone, in
a group, beside something else, partly, wrongly, not); the size of the group; false alarms where nothing is hidden;
"unexplained" where it should be said and where not; parameters within 10 % and inside their intervals; the error left over
that of the true law. A record without an answer counts as silent.

## Base laws

v is |v_r|.

)";

std::string parameter_list(const std::vector<Parameter>& parameters) {
  std::string text;
  for (const Parameter& p : parameters) {
    const std::string unit = p.unit == "1" ? "" : fmt::format(" [{}]", p.unit);
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", p.name, unit);
  }
  return text;
}

}  // namespace

std::string export_readme(std::size_t records, std::uint64_t seed) {
  std::string text = fmt::format(fmt::runtime(kTask), fmt::arg("records", records), fmt::arg("seed", seed));
  text += "| law | equation | parameters |\n|---|---|---|\n";
  for (const std::string& key : law_keys()) {
    const LawInfo info = describe(make_law(key));
    text += fmt::format("| `{}` | {} | {} |\n", key, info.equation, parameter_list(info.parameters));
  }
  text +=
      "\n## Names of effects\n\nf is the base law.\n\n| effect | what it is | equation | parameters "
      "|\n|---|---|---|---|\n";
  for (const Effect& effect : effect_catalogue()) {
    const EffectInfo info = describe(effect);
    text += fmt::format("| `{}` | {} | {} | {} |\n", info.key, info.statement, info.equation,
                        parameter_list(info.parameters));
  }
  return text;
}

}  // namespace recovery
