#include "base_law.hpp"

#include <algorithm>

namespace tribofit::diagnosis {

namespace {

/// Friction falls with speed, or its rise levels off within the data: a straight rise is what a viscous part says.
bool falls_or_levels_off(const DiagnosisContext& context, const Trial& trial) {
  const Law& law = trial.model.law();
  const double fastest = context.fine.observations.fastest;
  const bool falls = friction_at_rest(law, trial.p) > kinetic_friction(law, trial.p, fastest);
  return falls || remaining_fall(law, trial.p, fastest).value_or(0) < limits::kStraight;
}

}  // namespace

CompetingLaws base_laws(std::span<const Record> records, std::vector<Law> given, std::span<const Effect> effects) {
  CompetingLaws out;
  const bool is_given = given.size() == 1;
  const bool sticks = std::any_of(records.begin(), records.end(), [](const Record& record) {
    return record.segmentation->kind != MotionKind::always_slipping;
  });
  const bool possible = std::all_of(effects.begin(), effects.end(),
                                    [](const Effect& effect) { return obstacle_on(CoulombLaw{}, effect).empty(); });
  for (const Law& law : law_catalogue()) {
    const bool known = std::find(given.begin(), given.end(), law) != given.end();
    if (is_given || known || (constant_in_slip(law) && !possible)) continue;
    (constant_in_slip(law) && !sticks ? given : out.others).push_back(law);
  }
  out.first = std::move(given);
  return out;
}

std::size_t reported_ladder(const DiagnosisContext& context, const std::vector<Ladder>& ladders) {
  const auto coulomb =
      std::find_if(ladders.begin(), ladders.end(), [](const Ladder& l) { return constant_in_slip(l.law); });
  if (coulomb == ladders.end() || !coulomb->top().usable) return better_ladder(context, ladders);
  std::vector<Ladder> worthy = {*coulomb};
  std::vector<std::size_t> index = {static_cast<std::size_t>(coulomb - ladders.begin())};
  for (std::size_t k = 0; k < ladders.size(); ++k) {
    const Trial& top = ladders[k].top();
    if (k == index[0] || !top.usable || !falls_or_levels_off(context, top)) continue;
    worthy.push_back(ladders[k]);
    index.push_back(k);
  }
  return index[better_ladder(context, worthy)];
}

}  // namespace tribofit::diagnosis
