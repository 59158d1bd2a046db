#include "rate_state_together.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "limits.hpp"
#include "rate_state_errors.hpp"
#include "rate_state_times.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/parallel.hpp"

namespace tribofit::fit {
namespace {

class Together {
 public:
  Together(const RateStateData& data, LoadPointSource source, const RateStateOptions& options, std::size_t states)
      : source_(source), options_(options) {
    out_.states = states;
    out_.data = data;
    out_.unknowns = unknowns_of(data, states, options.given);
    out_.detrend = options.detrend;
  }

  StepsTogether run() {
    search_lines();
    settle_times();
    fit_laws();
    return std::move(out_);
  }

 private:
  RateStateSolution searched(StateEvolution evolution, Detrend detrend) const {
    return search_together(out_.data, evolution, out_.states, detrend, out_.all(), out_.unknowns);
  }

  /// The line is one over what leaves less; over the displacement where both leave the same. The law is not known yet:
  /// one that is wrong would choose the line that hides most of its own error.
  void search_lines() {
    const std::vector<Detrend> lines = options_.detrend == Detrend::automatic
                                           ? std::vector{Detrend::displacement, Detrend::time}
                                           : std::vector{options_.detrend};
    const std::size_t laws = options_.evolutions.size();
    std::vector<RateStateSolution> found(lines.size() * laws);
    run_tasks(found.size(), options_.threads,
              [&](std::size_t i) { found[i] = searched(options_.evolutions[i % laws], lines[i / laws]); });
    std::size_t chosen = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].found && found[i].cost < least) least = found[i].cost, chosen = i / laws;
    }
    out_.detrend = lines[chosen];
    const auto first = found.begin() + static_cast<std::ptrdiff_t>(chosen * laws);
    searched_.assign(first, first + static_cast<std::ptrdiff_t>(laws));
  }

  /// Steps whose times are known to a sample or a second are moved to where the response fits best. A recorded
  /// displacement says when the drive turns; where friction answers at another time beyond chance, that is when.
  void settle_times() {
    std::size_t law = searched_.size();
    for (std::size_t i = 0; i < searched_.size(); ++i) {
      if (searched_[i].found && (law == searched_.size() || searched_[i].cost < searched_[law].cost)) law = i;
    }
    if (law == searched_.size()) return;
    const bool measured = source_ == LoadPointSource::displacement;
    RateStateData moved = out_.data;
    for (VelocityStep& step : moved.steps) {
      if (measured)
        step.slack = kSlackOfDisplacement * std::min(step.time - step.from, step.to - step.time - step.hold);
    }
    const std::size_t free = free_turns(moved).size();
    if (free == 0) return;
    const StateEvolution evolution = options_.evolutions[law];
    RateStateSolution solution = searched_[law];
    const double most = refine_step_times(moved, evolution, out_.states, out_.detrend, out_.unknowns, solution);
    if (measured && !is_beyond_chance(moved, evolution, searched_[law], solution, free)) return;
    out_.data = std::move(moved);
    searched_.clear();
    if (!measured && !(most > out_.data.steps.front().interval)) return;
    constexpr std::array<const char*, 3> kKnown = {
        "their times are known to a tenth of the sliding beside them, as stated",
        "their times are known to a sample of the recorded speed",
        "friction answers there, not where the recorded displacement turns"};
    out_.messages.push_back(fmt::format("steps were moved by up to {:.3g} s to where the response fits best: {}", most,
                                        kKnown.at(static_cast<std::size_t>(source_))));
  }

  bool is_beyond_chance(const RateStateData& moved, StateEvolution evolution, const RateStateSolution& before,
                        const RateStateSolution& behind, std::size_t free) const {
    if (!behind.found) return false;
    const RateStateProblem fewer(out_.data, evolution, out_.states, out_.detrend, out_.all());
    const RateStateProblem more = fewer.on(moved);
    const RateStateFit fit = fit_from(more, out_.unknowns, behind);
    return fit.converged && p_value_of_more(fewer, before, more, behind, fit, free) < kChanceOfMovedStep;
  }

  /// Two states are alike but for their names: D_c is the shorter distance, where the user gives neither values.
  void name_shorter_first(std::vector<double>& p) const {
    if (out_.states != 2 || p.size() < 5 || p[2] <= p[4]) return;
    const bool named = std::any_of(options_.given.begin(), options_.given.end(),
                                   [](const GivenParameter& g) { return g.name != "a" && g.name != "k"; });
    if (named) return;
    std::swap(p[1], p[3]);
    std::swap(p[2], p[4]);
  }

  void fit_laws() {
    out_.laws.resize(options_.evolutions.size());
    run_tasks(out_.laws.size(), options_.threads, [&](std::size_t i) {
      LawFit& law = out_.laws[i];
      law.evolution = options_.evolutions[i];
      law.solution = searched_.empty() ? searched(law.evolution, out_.detrend) : searched_[i];
      name_shorter_first(law.solution.p);
      law.fit = fit_from(out_.problem(i), out_.unknowns, law.solution);
      add_messages(law.fit);
    });
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < out_.laws.size(); ++i) {
      if (!out_.laws[i].fit.converged || !(out_.laws[i].solution.cost < least)) continue;
      least = out_.laws[i].solution.cost;
      out_.best = i;
    }
  }

  LoadPointSource source_;
  const RateStateOptions& options_;
  StepsTogether out_;
  std::vector<RateStateSolution> searched_;  ///< of the laws; empty: the steps were moved since
};

}  // namespace

std::vector<std::size_t> StepsTogether::all() const {
  std::vector<std::size_t> out(data.steps.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

StepsTogether fit_together(const RateStateData& data, LoadPointSource source, const RateStateOptions& options,
                           std::size_t states) {
  return Together(data, source, options, states).run();
}

double p_value_of_more(const RateStateProblem& fewer, const RateStateSolution& fewer_solution,
                       const RateStateProblem& more, const RateStateSolution& more_solution, const RateStateFit& fit,
                       std::size_t values) {
  const double below = log_likelihood_below(more, more_solution, fewer, fewer_solution, fit);
  if (!std::isfinite(below)) return std::nan("");
  const auto compared = static_cast<double>(values);
  return f_p_value(2 * std::max(0.0, below) / compared, compared, kLargeFreedom);
}

}  // namespace tribofit::fit
