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
  /// displacement says when the drive turns; where friction answers at other times beyond chance, those are the times.
  /// Those of the law that then leaves less.
  void settle_times() {
    const bool measured = source_ == LoadPointSource::displacement;
    RateStateData free = out_.data;
    for (VelocityStep& step : free.steps) {
      if (measured) step.slack = kSlackOfDisplacement * shorter_beside(step);
    }
    const std::size_t turns = free_turns(free).size();
    if (turns == 0) return;
    std::vector<RateStateData> moved(searched_.size(), free);
    std::vector<RateStateSolution> behind = searched_;
    std::vector<MovedSteps> moves(searched_.size());
    run_tasks(searched_.size(), options_.threads, [&](std::size_t i) {
      if (behind[i].found)
        moves[i] =
            refine_step_times(moved[i], options_.evolutions[i], out_.states, out_.detrend, out_.unknowns, behind[i]);
    });
    double least = std::numeric_limits<double>::infinity();  // of any law, its steps where they are said to be
    for (const RateStateSolution& one : searched_) {
      if (one.found) least = std::min(least, one.cost);
    }
    std::size_t best = searched_.size();
    for (std::size_t i = 0; i < searched_.size(); ++i) {
      if (!behind[i].found || !(behind[i].cost < std::min(least, searched_[i].cost))) continue;
      least = behind[i].cost;
      best = i;
    }
    if (best == searched_.size()) return;
    if (measured && !is_beyond_chance(moved[best], options_.evolutions[best], searched_[best], behind[best], turns))
      return;
    out_.data = std::move(moved[best]);
    out_.unknowns.starts.insert(out_.unknowns.starts.begin(), behind[best].p);
    searched_.clear();
    say_moved(moves[best], measured);
  }

  void say_moved(const MovedSteps& moves, bool measured) {
    constexpr std::array<const char*, 3> kKnown = {"those stated", "the recorded speed shows",
                                                   "those at which the recorded displacement turns"};
    if (measured || moves.largest > out_.data.steps.front().interval)
      out_.messages.push_back(
          fmt::format("friction answers the steps at other times than {}: they were moved by up to {:.3g} s",
                      kKnown.at(static_cast<std::size_t>(source_)), moves.largest));
    out_.at_limit = moves.at_limit;
    if (moves.at_limit.empty()) return;
    out_.messages.push_back(fmt::format(
        "the step at {:.6g} s was moved as far as its time may be wrong, and friction may answer it later or "
        "earlier still: the values are not to be trusted; check the column or the times of the load point",
        out_.data.steps[moves.at_limit.front()].time));
  }

  bool is_beyond_chance(const RateStateData& moved, StateEvolution evolution, const RateStateSolution& before,
                        const RateStateSolution& behind, std::size_t free) const {
    if (!behind.found) return false;
    const RateStateProblem fewer(out_.data, evolution, out_.states, out_.detrend, out_.all());
    const RateStateProblem more = fewer.with_data(moved);
    const RateStateFit fit = fit_from(more, out_.unknowns, behind);
    return fit.converged && p_value_of_more(fewer, before, more, behind, fit, free) < kChanceOfMovedStep;
  }

  void fit_laws() {
    out_.laws.resize(options_.evolutions.size());
    run_tasks(out_.laws.size(), options_.threads, [&](std::size_t i) {
      LawFit& law = out_.laws[i];
      law.evolution = options_.evolutions[i];
      law.solution = searched_.empty() ? searched(law.evolution, out_.detrend) : searched_[i];
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
