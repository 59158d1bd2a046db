#include "base_law.hpp"

#include <algorithm>

namespace tribofit::diagnosis {

namespace {

/// Friction falls with speed, or its rise levels off within the data: a straight rise is what a viscous part says.
bool bends(const DiagnosisContext& context, const Trial& trial) {
  const bool falls = trial.p[0] > trial.p[1];
  return falls || stribeck_shape(trial.model.law(), trial.p[2] * context.fine.observations.fastest) < limits::kStraight;
}

}  // namespace

std::vector<BaseLaw> base_laws(std::span<const Record> records, std::vector<BaseLaw> given) {
  const bool sticks = std::any_of(records.begin(), records.end(), [](const Record& record) {
    return record.segmentation->kind != MotionKind::always_slipping;
  });
  const bool present = std::find(given.begin(), given.end(), BaseLaw::coulomb) != given.end();
  if (given.size() > 1 && !sticks && !present) given.push_back(BaseLaw::coulomb);
  return given;
}

std::size_t reported_ladder(const DiagnosisContext& context, const std::vector<Ladder>& ladders) {
  const auto coulomb =
      std::find_if(ladders.begin(), ladders.end(), [](const Ladder& l) { return l.law == BaseLaw::coulomb; });
  if (coulomb == ladders.end() || !coulomb->top().usable) return better_ladder(context, ladders);
  std::vector<Ladder> worthy = {*coulomb};
  std::vector<std::size_t> index = {static_cast<std::size_t>(coulomb - ladders.begin())};
  for (std::size_t k = 0; k < ladders.size(); ++k) {
    const Trial& top = ladders[k].top();
    if (k == index[0] || !top.usable || !bends(context, top)) continue;
    worthy.push_back(ladders[k]);
    index.push_back(k);
  }
  return index[better_ladder(context, worthy)];
}

}  // namespace tribofit::diagnosis
