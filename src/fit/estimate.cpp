#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "observing.hpp"
#include "spectral_lines.hpp"
#include "tribofit/execution/parallel.hpp"

namespace tribofit {

namespace {

/// The last digits, which its last steps take (SolverOptions::careful); along a flat valley nothing is gained by going
/// on, and this part of the cost is less than a hundredth of a standard error of any record.
constexpr SolverOptions kCarefulSearch{.relative_cost = 1e-10};

/// Values on which starts are compared; of means half as many slips do.
constexpr std::size_t kValuesToCompare = 4000;

const SolverOptions& search_of(const FitContext& context) {
  return context.is_look() ? kShortSearch : kQuickSearch;
}

/// A start at a line with the phase, of a few, that leaves least: only a line that is in phase draws a search.
std::vector<double> start_at_line(const ModelResiduals& residuals, std::vector<double> start, std::size_t phase) {
  constexpr int kPhases = 4;
  std::vector<double> nearest = start;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kPhases; ++k) {
    start[phase] = 2 * std::numbers::pi * k / kPhases - std::numbers::pi;
    const double squares = residuals.white_squares(start.data());
    if (!(squares < least)) continue;
    least = squares;
    nearest = start;
  }
  return nearest;
}

SpectralLines lines_about_mean_curve(const FitContext& context, double lowest, double highest) {
  const Observations& observations = context.observations;
  const std::shared_ptr<LinesOfRecord> known = observations.noise.empty() ? nullptr : observations.noise[0].lines;
  const std::shared_ptr<LinesOfRecord> lines = known ? known : std::make_shared<LinesOfRecord>();
  return lines->find(context.records[0], observations, lowest, highest, context.evaluation.threads);
}

/// A spectral line is narrower than any random start would find: the strongest lines about the mean friction over
/// speed are starts too.
void add_starts_at_lines(const FitContext& context, std::vector<std::vector<double>>& starts) {
  const auto parameters = context.model.parameters();
  const std::vector<double> from_data = starts[0];
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (parameters[k].parameter.search != ParameterSearch::steady_line) continue;
    const auto phase = std::find_if(parameters.begin(), parameters.end(), [&](const FrictionModel::Slot& slot) {
      return slot.effect == parameters[k].effect && slot.parameter.periodic;
    });
    const SpectralLines lines = lines_about_mean_curve(context, context.bounds.lower[k], context.bounds.upper[k]);
    const std::vector<std::size_t> some = some_slips(context.observations, kValuesToCompare);
    const std::size_t before = starts.size(), count = lines.frequencies.size();
    starts.resize(before + count, from_data);
    run_tasks(count, context.evaluation.threads, [&](std::size_t line) {
      std::vector<double>& start = starts[before + line];
      start[k] = lines.frequencies[line];
      if (phase == parameters.end()) return;
      const ModelResiduals residuals = context.residuals(some);  // its formulas must not be shared between threads
      start = start_at_line(residuals, start, static_cast<std::size_t>(phase - parameters.begin()));
    });
  }
}

/// Where the search begins: the starts of the data or of the user, each once.
std::vector<std::vector<double>> different_starts(const FitContext& context) {
  std::vector<std::vector<double>> starts = {context.options.start};
  if (context.options.start.empty()) {
    starts =
        make_starts(context.model, context.observations, context.bounds, context.options.starts, context.options.seed);
    add_starts_at_lines(context, starts);
  }
  for (auto& start : starts) apply_given(context.model, context.options.given, context.bounds, start);
  for (std::size_t k = 1; k < starts.size();) {  // where all is given, all starts are one
    const auto here = starts.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::find(starts.begin(), here, *here) == here) {
      ++k;
    } else {
      starts.erase(here);
    }
  }
  return starts;
}

/// Searches from each start. A look soon gives up all but the two that are ahead.
std::vector<Solution> searches_from(const FitContext& context, const std::vector<std::vector<double>>& starts,
                                    const std::vector<std::size_t>& part) {
  constexpr std::size_t kAhead = 2;
  const bool gives_up = context.is_look() && starts.size() > kAhead;
  SolverOptions first = search_of(context);
  if (gives_up) first.max_iterations = kIterationsToCompare;
  std::vector<Solution> tries(starts.size());
  run_tasks(starts.size(), context.evaluation.threads,
            [&](std::size_t k) { tries[k] = context.solve(part, starts[k], first); });
  if (!gives_up) return tries;
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return tries[a].cost < tries[b].cost; });
  run_tasks(kAhead, context.evaluation.threads, [&](std::size_t k) {
    Solution& own = tries[order[k]];
    if (!own.converged) own = context.solve(part, own.p, search_of(context));
  });
  return tries;
}

/// Where the best of several starts leads, compared on slips with about so many values.
std::vector<double> best_of_starts(const FitContext& context, const std::vector<std::vector<double>>& starts,
                                   std::size_t values, Fit& fit) {
  const std::vector<Solution> tries = searches_from(context, starts, some_slips(context.observations, values));
  std::size_t best = 0;
  for (std::size_t k = 1; k < tries.size(); ++k) {
    if (tries[k].cost < tries[best].cost * (1 - std::max(1e-6, search_of(context).relative_cost))) best = k;
  }
  if (best != 0)
    fit.messages.push_back("the best fit was found from a random start, not from the one the data suggest");
  return tries[best].p;
}

/// Passes over these slips from p, each with the scatter of break-away as the one before it leaves it, until two are
/// alike; for a look one, whose end is as far as it goes. Sets the whitening; where a change point ends is held in
/// `held`.
void settle(FitContext& context, const std::vector<std::size_t>& slips, const std::optional<ChangePoint>& change,
            Bounds& held, std::vector<double>& p) {
  const std::vector<std::size_t> all = all_slips(context.observations);
  // The direction in which a slip scatters is that of the law, known better once it has been taken out.
  const ModelResiduals plain(context.model, context.observations, all, context.evaluation);
  bool is_settled = false;
  for (int pass = 0; pass < kMostPasses && !is_settled; ++pass) {
    context.whiten_at(plain, p);
    if (change) find_change(context, *change, held, p);
    if (pass + 1 == kMostPasses) break;
    std::vector<double> next = context.solve(slips, p, search_of(context), held).p;
    if (context.is_look()) {
      p = std::move(next);
      break;
    }
    is_settled = pass + 2 >= kFewestPasses && are_alike(p, next);
    p = std::move(next);
  }
  if (is_settled) context.whiten_at(plain, p);
}

/// The search on fewer values, or on some of the slips: where passes from the best of several starts end.
std::vector<double> search_on(const Observations& few, const std::vector<std::size_t>& slips, const FitContext& context,
                              const std::vector<std::vector<double>>& starts, const std::optional<ChangePoint>& change,
                              Fit& fit) {
  FitContext coarse{context.model, context.records, few, context.instruments, context.options};
  coarse.given = context.given;
  coarse.bounds = context.bounds;
  coarse.evaluation = context.evaluation;
  std::vector<double> p = best_of_starts(coarse, starts, kValuesToCompare / 2, fit);
  if (!context.is_look() || !change) p = coarse.solve(slips, p, search_of(context)).p;
  if (context.is_look() && !change) return p;  // the scatter is taken out by the step over all values
  Bounds held = coarse.bounds;
  settle(coarse, slips, change, held, p);
  return p;
}

/// Best of several starts; then all slips, first by plain least squares to see the scatter of break-away, then with
/// that scatter taken out. Where there are many values the search runs on means of them, or on some of the slips where
/// every value counts, and what it finds is taken to where all of them lead. A look stays there where it cannot be:
/// along a flat valley.
void joint_estimate(FitContext& context, Fit& fit) {
  const bool look = context.is_look();
  const std::vector<std::vector<double>> starts = different_starts(context);
  context.first_start = starts[0];
  const std::optional<ChangePoint> change = change_point_of(context.model);
  const std::vector<std::size_t> all = all_slips(context.observations);
  const std::optional<Observations> means =
      reduced_for_search(context.model, context.observations, look ? kValuesOfSearch / 2 : kValuesOfSearch);
  const Observations& few = means ? *means : context.observations;
  const std::vector<std::size_t> slips = means ? all : some_slips(few, look ? kWholeSlipsOfLook : kWholeSlips);
  Bounds held = context.bounds;
  const bool is_short = !means && slips.size() == all.size();
  std::vector<double>& p = context.minimum.p;
  if (is_short) {
    p = context.solve(all, best_of_starts(context, starts, kValuesToCompare, fit), search_of(context)).p;
    if (change && look) settle(context, all, change, held, p);
  } else {
    p = search_on(few, slips, context, starts, change, fit);
  }
  context.minimum.converged = look || !is_short;
  if (look) {
    context.at_minimum.emplace(refine_look(context, change, held, p));
    return;
  }
  if (!is_short) {
    if (refine(context, change, held, p)) return;
    held = context.bounds;
  }
  settle(context, all, change, held, p);
  context.minimum = context.solve(all, p, kCarefulSearch, held);
}

/// [D] 3.2: levels from extremes, then the decay factor alone.
bool estimate_by_extremes(FitContext& context, Fit& fit) {
  context.extremes = extremes_of(context.observations, context.records);
  context.first_start = start_from_data(context.model, context.observations, context.bounds);
  apply_given(context.model, context.options.given, context.bounds, context.first_start);
  const std::array<double, 2> levels = context.extremes.means();
  if (!std::isfinite(levels[0]) || !std::isfinite(levels[1])) {
    context.minimum.message = "the per-cycle extremes need at least three cycles that stick and slip";
    return false;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    context.first_start[k] = context.bounds.lower[k] = context.bounds.upper[k] = levels[k];
  }
  for (const GivenParameter& given : context.options.given) {
    if (given.name != static_level_name && given.name != kinetic_level_name) continue;
    fit.messages.push_back(given.name + " is set by the per-cycle extremes; the value given for it is not used");
  }
  const std::vector<std::size_t> all = all_slips(context.observations),
                                 some = some_slips(context.observations, kWholeSlips);
  const bool is_long = some.size() < all.size();  // the search leaves a step or two over all slips
  const std::vector<double> p =
      is_long ? context.solve(some, context.first_start, kQuickSearch).p : context.first_start;
  SolverOptions last;  // a tolerance of the cost ends it before its step, so that of the parameters has to
  if (is_long) last.relative_cost = 1e-13, last.relative_step = 1e-9, last.careful = false;
  context.minimum = context.solve(all, p, last);
  return true;
}

}  // namespace

bool are_alike(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
    return std::abs(x - y) <= 10 * kQuickSearch.relative_step * std::max(std::abs(x), std::abs(y));
  });
}

std::vector<std::size_t> some_slips(const Observations& observations, std::size_t values) {
  const std::size_t every = (observations.size() / values) | 1U;
  std::vector<std::size_t> slips;
  for (std::size_t k = 0; k < observations.slips.size(); k += every) slips.push_back(k);
  return slips;
}

bool estimate(FitContext& context, Fit& fit) {
  bool has_levels = true;
  if (context.by_extremes()) {
    has_levels = estimate_by_extremes(context, fit);
  } else {
    joint_estimate(context, fit);
  }
  fit.converged = context.minimum.converged;
  if (!fit.converged) fit.messages.push_back(context.minimum.message);
  return has_levels;
}

}  // namespace tribofit
