#include "diagnose_traces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "conclusions.hpp"
#include "fit/assessment.hpp"
#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit::diagnosis {

namespace {

bool is_shown(const EffectFinding& finding) {
  return finding.status == EffectStatus::found || finding.status == EffectStatus::equivalent;
}

/// The runs with the most cycles, in their order.
std::vector<const PreparedTrace*> longest_runs(const std::vector<PreparedTrace>& traces) {
  std::vector<const PreparedTrace*> runs;
  for (const PreparedTrace& prepared : traces) runs.push_back(&prepared);
  const auto longer = [](const PreparedTrace* a, const PreparedTrace* b) {
    return a->trace.segmentation.cycles.size() > b->trace.segmentation.cycles.size();
  };
  std::ranges::stable_sort(runs, longer);
  runs.resize(std::min(runs.size(), limits::kMostSingleRuns));
  return runs;
}

/// The finding of every one of the longest runs by itself.
std::vector<Diagnosis> diagnose_each(const std::vector<PreparedTrace>& traces,
                                     const DiagnoseRecords& diagnose_records) {
  const std::vector<const PreparedTrace*> runs = longest_runs(traces);
  std::vector<Diagnosis> out;
  for (const PreparedTrace* run : runs) {
    const Record record = {&run->trace.motion, &run->trace.segmentation};
    out.push_back(diagnose_records({&record, 1}).diagnosis);
  }
  return out;
}

/// Effects that every run shows by itself.
std::vector<std::string> shown_by_all(const std::vector<Diagnosis>& single) {
  std::vector<std::string> keys;
  for (const EffectFinding& first : single.front().effects) {
    const bool all = std::ranges::all_of(single, [&](const Diagnosis& d) {
      const EffectFinding* finding = finding_of(d, first.key);
      return finding != nullptr && is_shown(*finding);
    });
    if (all && std::ranges::find(single.front().from_the_start, first.key) == single.front().from_the_start.end())
      keys.push_back(first.key);
  }
  return keys;
}

/// A run by itself can show the effect, and none does.
bool is_denied(const std::string& key, const std::vector<Diagnosis>& single) {
  return std::ranges::all_of(single, [&](const Diagnosis& d) {
    const EffectFinding* finding = finding_of(d, key);
    return finding != nullptr && !is_shown(*finding) && finding->status != EffectStatus::untestable &&
           finding->status != EffectStatus::possible;
  });
}

void withdraw_effects(const std::vector<Diagnosis>& single, Diagnosed& diagnosed) {
  Diagnosis& diagnosis = diagnosed.diagnosis;
  for (EffectFinding& effect : diagnosis.effects) {
    const bool follows = is_shown(effect) || effect.status == EffectStatus::possible;
    if (!follows || !is_denied(effect.key, single)) continue;
    effect.status = EffectStatus::not_supported;
    effect.reason = "no run shows it by itself: it follows what differs between the runs";
    effect.held_out_rmse = effect.error_reduction = effect.p_value = std::nan("");
    effect.parameters.clear();
  }
  const bool kept = std::all_of(diagnosis.ladder.begin() + 1, diagnosis.ladder.end(), [&](const Rung& rung) {
    const EffectFinding* finding = finding_of(diagnosis, rung.added);
    return finding != nullptr && finding->status != EffectStatus::not_supported;
  });
  if (kept) return;
  for (EffectFinding& effect : diagnosis.effects) {
    if (effect.status == EffectStatus::found || effect.status == EffectStatus::equivalent)
      effect.status = EffectStatus::possible;
  }
  diagnosed.fits.resize(1);
  diagnosis.ladder.resize(1);
  diagnosis.remaining = diagnosis.where;
  diagnosis.rival_laws.clear();
  diagnosis.formula.clear();
}

}  // namespace

void withhold_of_differing_runs(const std::vector<PreparedTrace>& traces, const DiagnoseRecords& diagnose_records,
                                Diagnosed& diagnosed) {
  Diagnosis& diagnosis = diagnosed.diagnosis;
  const bool ended = diagnosis.verdict == Verdict::effect_found || diagnosis.verdict == Verdict::unexplained ||
                     diagnosis.verdict == Verdict::sufficient;
  if (traces.size() < 2 || !ended || diagnosed.fits.empty()) return;
  const double left = diagnosed.fits.back().error.held_out_rmse;
  if (!(left > kWellAbove * diagnosis.floor_rmse)) return;
  const std::vector<Diagnosis> single = diagnose_each(traces, diagnose_records);
  const bool described = std::ranges::all_of(single, [](const Diagnosis& d) {
    const bool settled = d.verdict == Verdict::sufficient || d.verdict == Verdict::effect_found;
    return settled && !d.ladder.empty() && d.ladder.back().held_out_rmse < kWellAbove * d.floor_rmse;
  });
  if (!described) return;
  withdraw_effects(single, diagnosed);
  const std::vector<std::string> shown = shown_by_all(single);
  std::string differs = fmt::format(
      "the law differs from run to run: each {}by itself is described down to its noise floor{}, all together leave "
      "{} times theirs; no effect is named from differences between runs that no run shows",
      single.size() < traces.size() ? fmt::format("of the {} longest runs ", single.size()) : "run ",
      shown.empty() ? "" : " with " + listed(shown) + " in every one", fixed(left / diagnosis.floor_rmse, 1));
  if (diagnosis.verdict == Verdict::effect_found && diagnosis.ladder.size() > 1) {  // what was found stays found
    diagnosis.messages.push_back(std::move(differs));
    return;
  }
  diagnosis.verdict = Verdict::unexplained;
  diagnosis.runs_differ = true;
  diagnosis.messages = {std::move(differs)};
  diagnosis.next_experiment =
      "Diagnose each run by itself, and fit the folder as a campaign: its trends show what the parameters depend on.";
}

}  // namespace tribofit::diagnosis
