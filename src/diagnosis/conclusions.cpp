#include "conclusions.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "fit/assessment.hpp"
#include "limits.hpp"

namespace tribofit {
namespace {

bool is_named(const Share& s) {
  return s.share >= diagnosis::limits::kShareWorthNaming && !(s.p_value > diagnosis::limits::kChanceOfPossible);
}

}  // namespace

std::vector<Rung> found_effects(const Diagnosis& d) {
  std::vector<Rung> found(d.ladder.begin() + (d.ladder.empty() ? 0 : 1), d.ladder.end());
  const std::size_t rungs = found.size();
  const auto mentioned = [&](const std::string& key) {
    return std::any_of(found.begin(), found.end(), [&](const Rung& r) {
      return r.added == key || std::find(r.equivalent.begin(), r.equivalent.end(), key) != r.equivalent.end();
    });
  };
  // What the user put into the model was not found.
  const auto given = [&](const std::string& key) {
    return std::any_of(d.from_the_start.begin(), d.from_the_start.end(),
                       [&](const std::string& name) { return name.substr(0, name.find(':')) == key; });
  };
  for (const EffectFinding& e : d.effects) {
    if (given(e.key)) continue;
    if (e.status == EffectStatus::found && !mentioned(e.key)) found.push_back({e.key, e.held_out_rmse, 0, 0, {}});
  }
  if (found.size() == rungs) return found;
  for (const EffectFinding& e : d.effects) {
    if (e.status == EffectStatus::equivalent && !mentioned(e.key)) found.back().equivalent.push_back(e.key);
  }
  return found;
}

std::vector<Share> worth_naming(const std::vector<Share>& shares) {
  std::vector<Share> kept;
  std::copy_if(shares.begin(), shares.end(), std::back_inserter(kept), is_named);
  return kept;
}

const Share* largest_share(const std::vector<Share>& shares) {
  const Share* largest = nullptr;
  for (const Share& s : shares) {
    if (is_named(s) && (largest == nullptr || s.share > largest->share)) largest = &s;
  }
  return largest;
}

bool is_most(const Share& share) {
  return share.share >= diagnosis::limits::kMostOfTheError;
}

const EffectFinding* finding_of(const Diagnosis& diagnosis, std::string_view key) {
  const auto at = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                               [&](const EffectFinding& e) { return e.key == key; });
  return at == diagnosis.effects.end() ? nullptr : &*at;
}

FloorComparison against_floor(double held_out_rmse, double floor_rmse) {
  const double ratio = held_out_rmse / floor_rmse;
  if (!std::isfinite(ratio)) return FloorComparison::unknown;
  if (ratio < 1 / kAtFloor) return FloorComparison::below;
  return ratio <= kAtFloor ? FloorComparison::at : FloorComparison::above;
}

double removed_at(const Diagnosis& d, std::size_t rung) {
  const double floor = d.floor_rmse * d.floor_rmse;
  const auto squares = [&](std::size_t k) { return d.ladder[k].held_out_rmse * d.ladder[k].held_out_rmse - floor; };
  return squares(0) > 0 ? std::clamp(1 - squares(rung) / squares(0), -9.99, 1.0) : std::nan("");
}

double error_of_share(double share, double held_out_rmse, double floor_rmse) {
  const double above = held_out_rmse * held_out_rmse - floor_rmse * floor_rmse;
  return above > 0 ? std::sqrt(std::clamp(share, 0.0, 1.0) * above) : 0;
}

bool is_confirmed(const Confirmation& c) {
  return c.p_value < diagnosis::limits::kChanceOfPossible && c.final_rmse < c.base_rmse;
}

bool contradicts_law(const Confirmation& c) {
  return c.final_rmse > kClearlyAbove * c.floor_rmse;
}

}  // namespace tribofit
