#include "ladder.hpp"

#include <algorithm>
#include <utility>

#include "fit/fit_laws.hpp"
#include "fit/limits.hpp"
#include "fit/starts.hpp"
#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"

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

namespace {

/// A law that ends on a bound has become another one.
bool is_law_of_its_own(const Fit& fit) {
  const auto own = fit.parameters.begin() + static_cast<std::ptrdiff_t>(fit.model.base_count());
  return std::none_of(fit.parameters.begin(), own, [](const FitParameter& p) { return p.at_bound; });
}

}  // namespace

Trial try_other_law(const DiagnosisContext& context, const Law& law, const Trial& known, std::size_t without) {
  std::vector<Effect> effects(known.model.effects().begin(), known.model.effects().end());
  if (without < effects.size()) effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(without));
  if (!std::all_of(effects.begin(), effects.end(), [&](const Effect& e) { return obstacle_on(law, e).empty(); }))
    return {};
  const FrictionModel model(law, std::move(effects), known.model.records());
  const Observations& observations = context.coarse.observations;
  std::vector<double> start = start_from_data(model, observations, context.coarse.bounds_of(model));
  for (std::size_t k = model.base_count(); k < start.size(); ++k) {
    for (std::size_t i = known.model.base_count(); i < known.p.size(); ++i) {
      const bool same = model.parameters()[k].full_name() == known.model.parameters()[i].full_name();
      if (same) start[k] = known.p[i];
    }
  }
  return try_model(context, context.coarse, model, std::move(start));
}

std::vector<Law> rival_laws(const DiagnosisContext& context, const std::vector<Law>& laws, const Trial& top,
                            const Fit& fitted, const Instruments& instruments, const FitOptions& options) {
  std::vector<unsigned char> is_rival(laws.size(), 0);
  // Every law of the list holds friction that is constant in slip as a special case.
  if (!top.usable || !fitted.converged || constant_in_slip(fitted.model.law())) return {};
  run_tasks(laws.size(), context.threads, [&](std::size_t k) {
    if (laws[k] == fitted.model.law()) return;
    const Trial other = try_other_law(context, laws[k], top);
    if (!other.usable) return;
    const double behind = other.held_out_squares - top.held_out_squares;
    if (behind > limits::kDistinguishable * noise_of(context.coarse, top)) return;
    FitOptions warm = options;
    if (!other.model.effects().empty()) warm.start = other.p;
    const Observations own = observations_for(other.model, context.records);
    const Fit rival = fit_model(other.model, context.records, own, instruments, warm);
    if (!rival.converged || !is_law_of_its_own(rival)) return;
    const Comparison comparison = compare_held_out(fitted, rival);
    is_rival[k] = !comparison.first_better || comparison.p_value >= kClearlyBetter ? 1 : 0;
  });
  std::vector<Law> rivals;
  for (std::size_t k = 0; k < laws.size(); ++k) {
    if (is_rival[k] != 0) rivals.push_back(laws[k]);
  }
  return rivals;
}

}  // namespace tribofit::diagnosis
